// expect: compile without -fno-exceptions
// options: -fno-exceptions
#include <dem/core/error.hpp>

int main() {}
