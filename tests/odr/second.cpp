#include <cstring>

#include "world.hpp"

const char* version_seen_by_first();
double fallen_in_first();

int main() {
  const bool same = fallen_in_first() == fallen() && fallen() < 0.0;
  return same ? std::strcmp(version_seen_by_first(), DEM_VERSION_STRING) : 1;
}
