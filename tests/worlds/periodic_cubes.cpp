#include "worlds.hpp"

TEST_WORLD(, models::PeriodicCubes)
