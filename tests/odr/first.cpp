#include "world.hpp"

const char* version_seen_by_first() { return DEM_VERSION_STRING; }
double fallen_in_first() { return fallen(); }
