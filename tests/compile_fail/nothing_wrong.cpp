// expect-success: what the other files here are refused for is not the options they are compiled with.
#include <dem/dem.hpp>

int main() {}
