# The kinds of test that dem has. tests/CMakeLists.txt reads as the list of them.

set(DEM_SCRIPTS "${CMAKE_CURRENT_LIST_DIR}")

if(TARGET Catch2::Catch2WithMain) # Catch2 version 3, and version 2 as Debian has it
  add_library(test_main INTERFACE)
  target_link_libraries(test_main INTERFACE Catch2::Catch2WithMain)
else()
  add_library(test_main STATIC "${CMAKE_CURRENT_SOURCE_DIR}/main.cpp")
  target_link_libraries(test_main PUBLIC Catch2::Catch2)
endif()

# Sources of tests are compiled together: names of one may hide another's. Linked after dem_warnings, so it comes last.
target_compile_options(test_main INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang,AppleClang>:-Wno-shadow>)

# How many sources of a program are compiled at a time: what they share, the library's code above all, is compiled once for
# all of them. All of a room take g++ up to 3 GB at -Og. A world is dearer than a source of tests.
set(DEM_TESTS_AT_ONCE "" CACHE STRING "Sources of a test program that are compiled at a time; 0: all; empty: by the memory")
set(tests_at_once "${DEM_TESTS_AT_ONCE}")
if(tests_at_once STREQUAL "" AND DEM_MUCH_MEMORY)
  set(tests_at_once 0)
elseif(tests_at_once STREQUAL "")
  set(tests_at_once 16)
endif()
set(worlds_at_once ${tests_at_once})
if(worlds_at_once GREATER 8)
  set(worlds_at_once 8)
endif()

# What nearly every test includes, compiled once for all. Whether a header stands alone is another check's business.
file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/precompiled.cpp" CONTENT "// Stands for its precompiled headers.\n")
add_library(test_headers OBJECT "${CMAKE_CURRENT_BINARY_DIR}/precompiled.cpp")
dem_program(test_headers)
target_link_libraries(test_headers PRIVATE test_main)
target_precompile_headers(test_headers PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/catch.hpp"
                                               "${CMAKE_CURRENT_SOURCE_DIR}/worlds.hpp")

# The worlds that tests share. A program links those that it names.
file(GLOB sources CONFIGURE_DEPENDS worlds/*.cpp)
add_library(test_worlds STATIC ${sources})
target_include_directories(test_worlds PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}")
dem_program(test_worlds)
target_link_libraries(test_worlds PRIVATE test_main)
# Most of what tests run is in these, so more optimisation than elsewhere pays; g++ fuses no products and sums by either.
# Precompiled headers would bring their own along.
if(CMAKE_CXX_FLAGS_DEBUG MATCHES "-Og")
  target_compile_options(test_worlds PRIVATE $<$<CONFIG:Debug>:-O1>)
else()
  target_precompile_headers(test_worlds REUSE_FROM test_headers)
endif()
set_target_properties(test_worlds PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${worlds_at_once})

# dem_add_catch_tests(<name> <label> <source>...): the program test_<name>, and a test per TEST_CASE in it. Those tagged
# [long], which take five seconds and more, are checks (and no test of the sanitizers, under which they take minutes). Those
# tagged [slow] take five seconds and more under the address sanitizer: their label is <label>.slow. Sources are
# compiled together, as most of the work is what they share. One whose names meet another's stands in a namespace.
function(dem_add_catch_tests name label)
  add_executable(test_${name} ${ARGN})
  target_include_directories(test_${name} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/unit")
  dem_program(test_${name})
  target_link_libraries(test_${name} PRIVATE test_worlds test_main)
  set_target_properties(test_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${tests_at_once})
  target_precompile_headers(test_${name} REUSE_FROM test_headers)
  set(rest "")
  foreach(tag long slow)
    set(label_long checks)
    set(label_slow "${label}.slow")
    set(tagged FALSE)
    foreach(source IN LISTS ARGN)
      file(STRINGS "${source}" lines REGEX "\"(\\[[a-z]+\\])*\\[${tag}\\](\\[[a-z]+\\])*\"")
      if(lines)
        set(tagged TRUE)
      endif()
    endforeach()
    if(tagged)
      catch_discover_tests(test_${name} TEST_SPEC "[${tag}]${rest}" TEST_PREFIX "${name}." PROPERTIES LABELS ${label_${tag}})
      string(APPEND rest "~[${tag}]")
    endif()
  endforeach()
  if(rest)
    set(rest TEST_SPEC "${rest}")
  endif()
  catch_discover_tests(test_${name} ${rest} TEST_PREFIX "${name}." PROPERTIES LABELS ${label})
endfunction()

# dem_drop(<package> <list>): takes those sources or headers out of the list that need the package.
function(dem_drop package list)
  string(TOLOWER "${package}" lower)
  foreach(source IN LISTS ${list})
    cmake_language(CALL dem_needs_${lower} needs_it "${source}")
    if(needs_it)
      message(STATUS "${package} not found, going without: ${source}")
      list(REMOVE_ITEM ${list} "${source}")
    endif()
  endforeach()
  set(${list} ${${list}} PARENT_SCOPE)
endfunction()

# dem_add_state_hash_test(<name> <label> [COMPILED] <option>...): the program test_<name> runs equivalence/state_hash_test.cpp,
# compiled with these options; COMPILED: what no model changes is a source of its own. It shares nothing with other tests: whether
# products and sums are fused is left to no compiler here.
function(dem_add_state_hash_test name label)
  add_executable(test_${name} equivalence/state_hash_test.cpp)
  target_include_directories(test_${name} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}")
  dem_program(test_${name} HEADERS_ALONE)
  if("COMPILED" IN_LIST ARGN)
    list(REMOVE_ITEM ARGN COMPILED)
    target_sources(test_${name} PRIVATE "${PROJECT_SOURCE_DIR}/include/dem/compiled.cpp")
    target_compile_definitions(test_${name} PRIVATE DEM_COMPILED)
  endif()
  target_link_libraries(test_${name} PRIVATE test_main)
  target_compile_options(test_${name} PRIVATE -ffp-contract=off ${ARGN})
  catch_discover_tests(test_${name} TEST_PREFIX "${name}." PROPERTIES LABELS ${label})
endfunction()

# dem_add_width_1_test(<source>...): the program test_width_1 runs these sources where a pack is a single double, as it is
# with compilers and on devices without vector extensions. It shares nothing with tests whose packs are wider.
function(dem_add_width_1_test)
  add_executable(test_width_1 ${ARGN})
  target_include_directories(test_width_1 PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/unit")
  dem_program(test_width_1 HEADERS_ALONE)
  target_link_libraries(test_width_1 PRIVATE test_main)
  target_compile_definitions(test_width_1 PRIVATE DEM_NO_SIMD)
  set_target_properties(test_width_1 PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${worlds_at_once})
  catch_discover_tests(test_width_1 TEST_PREFIX width_1. PROPERTIES LABELS unit)
endfunction()

# Include options for a compiler that is called by hand. It knows /usr/include itself, and must find it last.
string(CONCAT packages "$<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>$<SEMICOLON>"
                       "$<TARGET_PROPERTY:fmt::fmt,INTERFACE_INCLUDE_DIRECTORIES>")
set(packages "$<FILTER:${packages},EXCLUDE,^/usr/include$>")
set(system "-isystem$<SEMICOLON>")
set(DEM_INCLUDES "-I${PROJECT_SOURCE_DIR}/include" "${system}$<JOIN:${packages},$<SEMICOLON>${system}>")

# What is only looked at is compiled without the code behind it, by this.
set(DEM_LOOK ${CMAKE_CXX_COMPILER} -std=c++20 -fopenmp -DDEM_CHECK_TEXTS ${DEM_WARNINGS} ${DEM_INCLUDES} -fsyntax-only)

# Headers that many others stand on, the heaviest first: a source that includes one of them anyway may be given it
# precompiled, which changes nothing but the time that it takes. g++ alone does it by -include.
set(DEM_PRECOMPILED)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(DEM_PRECOMPILED dem/world/world.hpp dem/world/model.hpp dem/mbd/solver/mechanism.hpp dem/math/vector.hpp)
endif()
set(outputs)
foreach(header IN LISTS DEM_PRECOMPILED)
  set(copy "${CMAKE_CURRENT_BINARY_DIR}/precompiled/${header}")
  file(CONFIGURE OUTPUT "${copy}" CONTENT "#include <${header}>\n")
  add_custom_command(
    OUTPUT "${copy}.gch"
    COMMAND ${CMAKE_CXX_COMPILER} -std=c++20 -fopenmp -DDEM_CHECK_TEXTS ${DEM_WARNINGS} ${DEM_INCLUDES} -x c++-header "${copy}" -o
            "${copy}.gch" -MD -MF "${copy}.d" -MT "${copy}.gch"
    DEPFILE "${copy}.d"
    COMMENT "Precompiling ${header}"
    COMMAND_EXPAND_LISTS VERBATIM)
  list(APPEND outputs "${copy}.gch")
endforeach()
add_custom_target(precompiled_headers ALL DEPENDS ${outputs})

# dem_includes_of(<out> <file>): what it includes in angle brackets.
function(dem_includes_of out file)
  file(STRINGS "${file}" lines REGEX "^#include <.*>")
  list(TRANSFORM lines REPLACE "^#include <(.*)>.*$" "\\1")
  set(${out} ${lines} PARENT_SCOPE)
endfunction()

# dem_standing_on(<out> <header>): the headers that include this one, themselves or by others. Reads includes_of_<header>
# of all `headers`.
function(dem_standing_on out header)
  set(found "${header}")
  set(rest ${headers})
  list(REMOVE_ITEM rest "${header}")
  set(last "")
  while(NOT found STREQUAL last)
    set(last "${found}")
    foreach(other IN LISTS rest)
      foreach(included IN LISTS "includes_of_${other}")
        if(included IN_LIST found)
          list(APPEND found "${other}")
          list(REMOVE_ITEM rest "${other}")
          break()
        endif()
      endforeach()
    endforeach()
  endwhile()
  list(REMOVE_ITEM found "${header}")
  set(${out} ${found} PARENT_SCOPE)
endfunction()

# dem_add_header_checks(<include dir>): every header compiles when it is the first and only one, and is guarded. A header
# that another one includes before anything else is compiled first there, so only the others are compiled for
# themselves. All of them also compile together. Built as part of `all`; CUDA headers (*.cuh) are left to nvcc.
function(dem_add_header_checks include_dir)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS "${include_dir}/*.hpp")
  find_package(CLI11 QUIET)
  if(NOT CLI11_FOUND)
    dem_drop(CLI11 headers)
  endif()
  if(NOT DEM_WITH_HDF5)
    dem_drop(HDF5 headers)
  endif()
  if(NOT DEM_WITH_MPI)
    dem_drop(MPI headers)
  endif()
  list(TRANSFORM headers REPLACE "^${include_dir}/" "")
  set(tried_in_others "")
  foreach(header IN LISTS headers)
    # What it includes may change.
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${include_dir}/${header}")
    file(STRINGS "${include_dir}/${header}" directives REGEX "^[ \t]*#" LIMIT_COUNT 2)
    list(POP_FRONT directives guard first)
    if(NOT guard STREQUAL "#pragma once")
      message(FATAL_ERROR "${include_dir}/${header} does not begin with #pragma once, which keeps it from being read twice")
    endif()
    if(first MATCHES "^#include <(dem/.*)>$")
      list(APPEND tried_in_others "${CMAKE_MATCH_1}")
    endif()
    dem_includes_of("includes_of_${header}" "${include_dir}/${header}")
  endforeach()
  foreach(precompiled IN LISTS DEM_PRECOMPILED)
    dem_standing_on("on_${precompiled}" "${precompiled}")
  endforeach()

  set(cli11)
  if(CLI11_FOUND)
    set(cli11 "$<FILTER:$<TARGET_PROPERTY:CLI11::CLI11,INTERFACE_INCLUDE_DIRECTORIES>,EXCLUDE,^/usr/include$>")
    set(cli11 "$<$<BOOL:${cli11}>:-isystem$<SEMICOLON>$<JOIN:${cli11},$<SEMICOLON>-isystem$<SEMICOLON>>>")
  endif()
  set(hdf5)
  if(DEM_WITH_HDF5)
    list(TRANSFORM HDF5_C_INCLUDE_DIRS PREPEND -isystem OUTPUT_VARIABLE hdf5)
  endif()
  set(mpi)
  if(DEM_WITH_MPI)
    list(TRANSFORM MPI_CXX_INCLUDE_DIRS PREPEND -isystem OUTPUT_VARIABLE mpi)
  endif()
  set(all_headers ${headers})
  list(REMOVE_ITEM headers ${tried_in_others})
  set(stamps)
  foreach(header IN LISTS headers)
    set(given)
    set(depends)
    foreach(precompiled IN LISTS DEM_PRECOMPILED)
      if(header IN_LIST "on_${precompiled}")
        set(given -include "${CMAKE_CURRENT_BINARY_DIR}/precompiled/${precompiled}")
        set(depends "${CMAKE_CURRENT_BINARY_DIR}/precompiled/${precompiled}.gch")
        break()
      endif()
    endforeach()
    set(stamp "${CMAKE_CURRENT_BINARY_DIR}/header_self_containment/${header}.ok")
    cmake_path(GET stamp PARENT_PATH folder)
    file(MAKE_DIRECTORY "${folder}")
    add_custom_command(
      OUTPUT "${stamp}"
      COMMAND ${DEM_LOOK} $<$<BOOL:${CMAKE_COMPILE_WARNING_AS_ERROR}>:-Werror> ${cli11} ${hdf5} ${mpi} ${given}
              -include "${include_dir}/${header}" -x c++ /dev/null -MD -MF "${stamp}.d" -MT "${stamp}"
      COMMAND ${CMAKE_COMMAND} -E touch "${stamp}"
      DEPENDS "${include_dir}/${header}" ${depends}
      DEPFILE "${stamp}.d"
      COMMENT "Header ${header}"
      COMMAND_EXPAND_LISTS VERBATIM)
    list(APPEND stamps "${stamp}")
  endforeach()
  # And all of them together, in one source.
  list(TRANSFORM all_headers REPLACE "(.+)" "#include <\\1>\n")
  list(JOIN all_headers "" together)
  set(together_source "${CMAKE_CURRENT_BINARY_DIR}/header_self_containment/together.cpp")
  file(CONFIGURE OUTPUT "${together_source}" CONTENT "${together}" @ONLY)
  set(stamp "${together_source}.ok")
  add_custom_command(
    OUTPUT "${stamp}"
    COMMAND ${DEM_LOOK} ${cli11} ${hdf5} ${mpi} "${together_source}" -MD -MF "${stamp}.d" -MT "${stamp}"
    COMMAND ${CMAKE_COMMAND} -E touch "${stamp}"
    DEPENDS "${together_source}"
    DEPFILE "${stamp}.d"
    COMMENT "All headers together"
    COMMAND_EXPAND_LISTS VERBATIM)
  list(APPEND stamps "${stamp}")
  add_custom_target(header_self_containment ALL DEPENDS ${stamps})
endfunction()

# dem_precompiled_of(<out> <source>): options that give the source the first of the precompiled headers that it includes.
function(dem_precompiled_of out source)
  dem_includes_of(includes "${source}")
  set(${out} PARENT_SCOPE)
  foreach(precompiled IN LISTS DEM_PRECOMPILED)
    if(precompiled IN_LIST includes)
      set(${out} -include "${CMAKE_CURRENT_BINARY_DIR}/precompiled/${precompiled}" PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# dem_add_compile_fail_test(<source>): the source is refused, in the words of its line `// expect: <regex>`.
function(dem_add_compile_fail_test source)
  cmake_path(GET source STEM name)
  dem_precompiled_of(given "${source}")
  add_test(
    NAME compile_fail.${name}
    COMMAND ${CMAKE_COMMAND} "-DSOURCE=${source}" -P "${DEM_SCRIPTS}/CompileFail.cmake" -- ${DEM_LOOK} ${given}
    COMMAND_EXPAND_LISTS)
  set_tests_properties(compile_fail.${name} PROPERTIES LABELS checks)
endfunction()

# dem_add_benchmark_compile_test(<benchmark>): its sources are valid C++, where benchmarks are not built. Without the code
# behind it that takes a third of the time that building takes.
function(dem_add_benchmark_compile_test benchmark)
  if(DEM_BUILD_BENCHMARKS)
    return()
  endif()
  find_package(benchmark QUIET)
  find_package(CLI11 QUIET)
  if(NOT benchmark_FOUND OR NOT CLI11_FOUND)
    message(STATUS "Google Benchmark or CLI11 not found, going without: the tests benchmark_compile.${benchmark}.*")
    return()
  endif()
  set(includes "$<TARGET_PROPERTY:benchmark::benchmark,INTERFACE_INCLUDE_DIRECTORIES>$<SEMICOLON>"
               "$<TARGET_PROPERTY:CLI11::CLI11,INTERFACE_INCLUDE_DIRECTORIES>")
  string(CONCAT includes ${includes})
  set(includes "$<FILTER:${includes},EXCLUDE,^/usr/include$>")
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/benchmarks/${benchmark}/*.cpp")
  foreach(source IN LISTS sources)
    cmake_path(GET source STEM name)
    dem_precompiled_of(given "${source}")
    add_test(
      NAME benchmark_compile.${benchmark}.${name}
      COMMAND ${DEM_LOOK} ${given}
              "$<$<BOOL:${includes}>:${system}$<JOIN:${includes},$<SEMICOLON>${system}>>"
              "-I${PROJECT_SOURCE_DIR}/benchmarks" "${source}"
      COMMAND_EXPAND_LISTS)
    set_tests_properties(benchmark_compile.${benchmark}.${name} PROPERTIES LABELS checks)
  endforeach()
endfunction()

# dem_add_ranks_compile_test(<rig> <source>): a source of an example is valid C++ where processes share its world.
function(dem_add_ranks_compile_test rig source)
  set(of "TARGET_PROPERTY:${rig}_on_ranks")
  add_test(
    NAME ranks_compile.${rig}
    COMMAND ${DEM_LOOK} "$<$<BOOL:$<${of},COMPILE_DEFINITIONS>>:-D$<JOIN:$<${of},COMPILE_DEFINITIONS>,$<SEMICOLON>-D>>"
            "-I$<JOIN:$<FILTER:$<${of},INCLUDE_DIRECTORIES>,EXCLUDE,^/usr/include$>,$<SEMICOLON>-I>"
            "${PROJECT_SOURCE_DIR}/examples/${source}"
    COMMAND_EXPAND_LISTS)
  set_tests_properties(ranks_compile.${rig} PROPERTIES LABELS checks)
endfunction()

# dem_add_cuda_compile_test(<source>): nvcc accepts the source, and no kernel calls a function of the host. Compiling is
# all: it needs no GPU. Warning 20012 is Eigen's own.
function(dem_add_cuda_compile_test source)
  cmake_path(GET source STEM name)
  if(NOT DEM_NVCC)
    message(STATUS "nvcc not found, going without: the test cuda_compile.${name}")
    return()
  endif()
  execute_process(COMMAND ${DEM_NVCC} --version OUTPUT_VARIABLE version ERROR_QUIET)
  if(NOT version MATCHES "release ([0-9]+)" OR CMAKE_MATCH_1 LESS 12)
    message(STATUS "${DEM_NVCC} is older than CUDA 12, the first with C++20, going without: the test cuda_compile.${name}")
    return()
  endif()
  add_test(
    NAME cuda_compile.${name}
    COMMAND ${DEM_NVCC} -std=c++20 -arch=sm_75 --expt-relaxed-constexpr -Werror cross-execution-space-call -diag-suppress
            20012 -ccbin ${CMAKE_CXX_COMPILER} ${DEM_INCLUDES} -c "${source}" -o "${CMAKE_CURRENT_BINARY_DIR}/${name}.cu.o"
    COMMAND_EXPAND_LISTS)
  set_tests_properties(cuda_compile.${name} PROPERTIES LABELS checks)
endfunction()

# dem_add_clang_test(<source>...): these unit tests pass when clang has compiled them for this machine as well, without
# OpenMP, whose library clang may lack; and clang accepts whole worlds without a warning, with OpenMP where it is there.
function(dem_add_clang_test)
  find_program(DEM_CLANG NAMES clang++ clang++-14 DOC "Compiler that some tests are compiled with besides, if found")
  if(NOT DEM_CLANG OR NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Seen in the list of tests as not run, not passed over in silence.
    add_test(NAME clang COMMAND ${CMAKE_COMMAND} -E echo "no clang++ besides g++")
    set_tests_properties(clang PROPERTIES LABELS checks SKIP_REGULAR_EXPRESSION "no clang")
    return()
  endif()
  execute_process(COMMAND ${DEM_CLANG} -fopenmp -include omp.h -fsyntax-only -x c++ /dev/null
                  RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
  set(openmp)
  if(status EQUAL 0)
    set(openmp -fopenmp)
  else()
    message(STATUS "${DEM_CLANG} has no omp.h: the test clang.world goes without OpenMP")
  endif()
  add_test(
    NAME clang.world
    COMMAND ${DEM_CLANG} -std=c++20 -march=native ${openmp} -fsyntax-only -Wall -Wextra -Wpedantic -Werror
            ${DEM_INCLUDES} "${CMAKE_CURRENT_SOURCE_DIR}/clang/worlds.cpp"
    COMMAND_EXPAND_LISTS)
  set_tests_properties(clang.world PROPERTIES LABELS checks)

  if(Catch2_VERSION VERSION_GREATER_EQUAL 3)  # has no main function that a compiler's command line could name
    message(STATUS "Catch2 3: going without the tests clang.build and clang.run")
    return()
  endif()
  set(program "${CMAKE_CURRENT_BINARY_DIR}/test_clang")
  list(TRANSFORM ARGN PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  add_test(
    NAME clang.build
    COMMAND ${DEM_CLANG} -std=c++20 -O1 -march=native -fno-math-errno -fno-trapping-math -w ${DEM_INCLUDES}
            "-I${CMAKE_CURRENT_SOURCE_DIR}" "-I${CMAKE_CURRENT_SOURCE_DIR}/unit" ${ARGN}
            "${CMAKE_CURRENT_SOURCE_DIR}/main.cpp" -o ${program} $<TARGET_FILE:fmt::fmt>
    COMMAND_EXPAND_LISTS)
  add_test(NAME clang.run COMMAND ${program})
  set_tests_properties(clang.build PROPERTIES FIXTURES_SETUP clang LABELS checks)
  set_tests_properties(clang.run PROPERTIES FIXTURES_REQUIRED clang LABELS checks)
endfunction()

# dem_add_ranks_test(<name> <ranks> <arg>...): the program test_ranks runs on so many processes, all on this machine, by
# whoever it is.
function(dem_add_ranks_test name ranks)
  add_test(NAME mpi.${name} COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} $<TARGET_FILE:test_ranks> ${ARGN})
  set_tests_properties(
    mpi.${name}
    PROPERTIES LABELS mpi TIMEOUT 600 PROCESSORS ${ranks}
               ENVIRONMENT "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMPI_MCA_rmaps_base_oversubscribe=1")
endfunction()

# dem_add_consumer_test(<way> <option>...): configures, builds and runs the project consumers/<way>.
function(dem_add_consumer_test way)
  add_test(
    NAME consumer.${way}
    COMMAND
      ${CMAKE_CTEST_COMMAND} --build-and-test "${CMAKE_CURRENT_SOURCE_DIR}/consumers/${way}"
      "${CMAKE_CURRENT_BINARY_DIR}/consumers/${way}" --build-generator "${CMAKE_GENERATOR}" --build-project consumer
      --build-options "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}" -DCMAKE_BUILD_TYPE=Debug ${ARGN} --test-command
      consumer ${PROJECT_VERSION})
  set_tests_properties(consumer.${way} PROPERTIES LABELS checks)
endfunction()

# dem_add_example_test(<example> [NAME <name>] [ARGS <arg>...] [FILES <file>...] [EXPECT <regex>...]): the example runs
# with these arguments and `--output <folder>`, leaves these files there, and its output matches every regex. Test and
# folder are called as the example, unless it has several tests with names of their own.
function(dem_add_example_test example)
  cmake_parse_arguments(arg "" "NAME;LABEL" "ARGS;FILES;EXPECT" ${ARGN})
  if(NOT arg_NAME)
    set(arg_NAME ${example})
  endif()
  if(NOT arg_LABEL)
    set(arg_LABEL example)
  endif()
  if(NOT TARGET ${example})
    message(STATUS "${example} is not built, going without: the test example.${arg_NAME}")
    return()
  endif()
  add_test(
    NAME example.${arg_NAME}
    COMMAND ${CMAKE_COMMAND} "-DOUTPUT=${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME}" "-DFILES=${arg_FILES}"
            "-DEXPECT=${arg_EXPECT}" -P "${DEM_SCRIPTS}/RunExample.cmake" -- $<TARGET_FILE:${example}> ${arg_ARGS})
  set_tests_properties(example.${arg_NAME} PROPERTIES LABELS ${arg_LABEL} TIMEOUT 900)  # of minutes on a busy machine
  if(NOT arg_LABEL STREQUAL "checks")
    add_dependencies(fast_tests ${example})
  endif()
endfunction()
