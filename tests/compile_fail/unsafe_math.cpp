// expect: compile without -funsafe-math-optimizations, -fassociative-math
// options: -funsafe-math-optimizations
#include <dem/core/error.hpp>

int main() {}
