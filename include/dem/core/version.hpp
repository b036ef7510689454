#pragma once

/// The library's version. The build system reads it from here, so it is written in one place only.
#define DEM_VERSION_MAJOR 0
#define DEM_VERSION_MINOR 1
#define DEM_VERSION_PATCH 0
#define DEM_VERSION_STRING "0.1.0"
