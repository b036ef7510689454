// The test runner for Catch2 version 2; version 3 comes with its own.
#define CATCH_CONFIG_MAIN
#include "catch.hpp"
