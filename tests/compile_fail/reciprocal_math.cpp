// expect: compile without -funsafe-math-optimizations, -fassociative-math and -freciprocal-math
// options: -freciprocal-math
#include <dem/core/error.hpp>

int main() {}
