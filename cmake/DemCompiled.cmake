# dem::compiled: what no model changes, compiled once for all programs that link it, in place of dem::dem. They see
# declarations alone of it, so a program with a machine takes the compiler two fifths of the time. dem::compiled_native is the same
# with the options of dem::native, which those that link it have as well. Either is built by the project that uses dem,
# with the compiler and the options that hold where dem is found or added, and only where something links it. They are
# for programs and for libraries that are not exported.

if(TARGET dem_compiled)
  return()
endif()
foreach(way compiled compiled_native)
  add_library(dem_${way} STATIC EXCLUDE_FROM_ALL)
  add_library(dem::${way} ALIAS dem_${way})
  target_compile_definitions(dem_${way} PUBLIC DEM_COMPILED)
  set_target_properties(dem_${way} PROPERTIES POSITION_INDEPENDENT_CODE ON) # for users' shared libraries
  target_link_libraries(dem_${way} PUBLIC dem::dem)
endforeach()
target_link_libraries(dem_compiled_native PUBLIC dem::native)

# Beside the headers, wherever these are.
get_target_property(dem_include dem::dem INTERFACE_INCLUDE_DIRECTORIES)
string(REGEX REPLACE "\\$<BUILD_INTERFACE:([^>]*)>.*" "\\1" dem_include "${dem_include}")
list(GET dem_include 0 dem_include)
target_sources(dem_compiled PRIVATE "${dem_include}/dem/compiled.cpp")
target_sources(dem_compiled_native PRIVATE "${dem_include}/dem/compiled.cpp")

# dem_compile_fast(<target> [PORTABLE] [SHARE <other>]): all that makes the compiler's work short each time that sources
# of a program change. It links dem::compiled_native (PORTABLE: dem::compiled), has <dem/dem.hpp> precompiled, which
# takes some 10 s once, and lets g++ take more memory before it looks for some that it no longer needs. SHARE takes the
# precompiled header of another program of the same options for which this was called.
function(dem_compile_fast target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "PORTABLE" "SHARE" "")
  if(arg_UNPARSED_ARGUMENTS OR arg_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "dem_compile_fast(${target} ${ARGN}): may have PORTABLE, and SHARE with another program's name")
  endif()
  if(arg_PORTABLE)
    target_link_libraries(${target} PRIVATE dem::compiled)
  else()
    target_link_libraries(${target} PRIVATE dem::compiled_native)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:SHELL:--param ggc-min-heapsize=1000000>")
  endif()
  if(arg_SHARE)
    target_precompile_headers(${target} REUSE_FROM ${arg_SHARE})
  else()
    target_precompile_headers(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:<dem/dem.hpp$<ANGLE-R>>")
  endif()
endfunction()
