# What dem's own programs (tests, examples, benchmarks) share. Nothing here reaches a user of the library.

# dem's headers are compiled with these as well: dem::dem is not a system target inside this project.
set(DEM_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # g++ 12 warns of its own AVX-512 intrinsics (its bug 105593).
  list(APPEND DEM_WARNINGS -Wno-maybe-uninitialized -Wno-uninitialized)
endif()
add_library(dem_warnings INTERFACE)
target_compile_options(dem_warnings
                       INTERFACE "$<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang,AppleClang>:${DEM_WARNINGS}>")

# g++ looks for memory that it no longer needs whenever what it has in use doubles, a tenth to a fifth of its time with
# dem's programs. Where each core has some 4 GB it need not, up to 2 GB; programs take 1 to 3 GB then.
cmake_host_system_information(RESULT memory QUERY TOTAL_PHYSICAL_MEMORY) # MiB, of the host where this is a container
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR memory_per_core "${memory} / ${cores}")
set(has_memory OFF)
if(memory_per_core GREATER_EQUAL 4000)
  set(has_memory ON)
endif()
option(DEM_MUCH_MEMORY "g++ may take 3 GB of memory, for the checks 5" ${has_memory})
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND DEM_MUCH_MEMORY)
  target_compile_options(dem_warnings INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:SHELL:--param ggc-min-heapsize=2000000>")
endif()

option(DEM_COMPILE_ONCE "dem's own programs share one compilation of what no model changes" ON)
if(PROJECT_IS_TOP_LEVEL)
  foreach(library dem_compiled dem_compiled_native)
    target_link_libraries(${library} PRIVATE dem_warnings)
  endforeach()
endif()

# dem_program(<target> [HEADERS_ALONE]): links what every program of dem links. HEADERS_ALONE: all is compiled in its own
# sources, for those whose options differ from the others'.
function(dem_program target)
  target_link_libraries(${target} PRIVATE dem::dem dem_warnings $<$<BOOL:${DEM_NATIVE}>:dem::native>
                                          $<TARGET_NAME_IF_EXISTS:dem::zlib>)
  if(DEM_COMPILE_ONCE AND NOT "HEADERS_ALONE" IN_LIST ARGN)
    target_link_libraries(${target} PRIVATE $<IF:$<BOOL:${DEM_NATIVE}>,dem::compiled_native,dem::compiled>)
  endif()
endfunction()

# dem_subfolders(<out> <pattern> [<folder>]): the names of the folders here, or in that folder, that hold a file that
# matches, in order.
function(dem_subfolders out pattern)
  set(base "${CMAKE_CURRENT_SOURCE_DIR}/${ARGN}")
  file(GLOB files CONFIGURE_DEPENDS RELATIVE "${base}" "${base}/*/${pattern}")
  list(TRANSFORM files REPLACE "/.*" "")
  list(REMOVE_DUPLICATES files)
  set(${out} ${files} PARENT_SCOPE)
endfunction()

# dem_includes(<out> <regex> <source>...): whether one of the sources includes a header that matches, as in
# `#include <header>` or `#include "header"`.
function(dem_includes out regex)
  set(${out} FALSE PARENT_SCOPE)
  foreach(source IN LISTS ARGN)
    file(STRINGS "${source}" lines REGEX "^#include [<\"](${regex})[>\"]")
    if(lines)
      set(${out} TRUE PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# dem_needs_cli11(<out> <source>...): whether one of the sources includes a header that needs CLI11.
function(dem_needs_cli11 out)
  dem_includes(needs "CLI/CLI\\.hpp|dem/rig/(command_line|program)\\.hpp" ${ARGN})
  set(${out} ${needs} PARENT_SCOPE)
endfunction()

# dem_needs_nlopt(<out> <source>...): whether one of the sources includes NLopt's header.
function(dem_needs_nlopt out)
  dem_includes(needs "nlopt\\.hpp" ${ARGN})
  set(${out} ${needs} PARENT_SCOPE)
endfunction()

# dem_is_rig(<out> <source>...): whether one of the sources makes a rig's program, which can go on after it was stopped
# where it links dem::hdf5.
function(dem_is_rig out)
  dem_includes(is_rig "dem/rig/program\\.hpp" ${ARGN})
  set(${out} ${is_rig} PARENT_SCOPE)
endfunction()

# dem_needs_hdf5(<out> <source>...): whether one of the sources includes a header that needs HDF5, of dem or of its tests.
function(dem_needs_hdf5 out)
  dem_includes(needs "hdf5\\.h|dem/io/checkpoint(/hdf5_file)?\\.hpp|dem/rig/hdf5_checkpoints\\.hpp|dem/soil/tile_file\\.hpp|(checkpoint/)?scenes_to_save\\.hpp|combinations\\.hpp|combinations/combinations\\.hpp" ${ARGN})
  set(${out} ${needs} PARENT_SCOPE)
endfunction()

# dem_needs_mpi(<out> <source>...): whether one of the sources includes a header that needs MPI.
function(dem_needs_mpi out)
  dem_includes(needs "mpi\\.h|dem/domain/(messages|periodic_ranks|ranks|session|sheared_ranks)\\.hpp" ${ARGN})
  set(${out} ${needs} PARENT_SCOPE)
endfunction()

# dem_with(<package> <purpose>): an optional package. Afterwards DEM_WITH_<PACKAGE> says whether it is used: the
# user did not switch it off, and it was found.
macro(dem_with package purpose)
  string(TOUPPER "${package}" dem_with_name)
  option(DEM_WITH_${dem_with_name} "Use ${package}: ${purpose}" ON)
  if(DEM_WITH_${dem_with_name})
    find_package(${package} QUIET)
    if(NOT ${package}_FOUND)
      message(STATUS "${package} not found, going without: ${purpose}")
      set(DEM_WITH_${dem_with_name} OFF)
    endif()
  endif()
endmacro()
