// expect: numbers that are not finite, which -ffast-math
// options: -ffast-math
#include <dem/core/error.hpp>

int main() {}
