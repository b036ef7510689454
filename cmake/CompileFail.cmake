# cmake -DSOURCE=<file> -P CompileFail.cmake -- <compiler> <option>...
#
# The source must be refused, and the compiler's words must match the regex of its line `// expect: <regex>`. A line
# `// options: <option>...` adds options of the compiler. A source
# that says `// expect-success` must be accepted instead: it shows that its neighbours fail for their own reason and
# not because of the options.

include("${CMAKE_CURRENT_LIST_DIR}/ScriptArguments.cmake")

file(READ "${SOURCE}" text)
if(NOT text MATCHES "// expect(-success|: ([^\n]+))")
  message(FATAL_ERROR "${SOURCE} has neither a line `// expect: <regex>` nor `// expect-success`")
endif()
set(expected "${CMAKE_MATCH_2}")

if(text MATCHES "// options: ([^\n]+)")
  separate_arguments(options UNIX_COMMAND "${CMAKE_MATCH_1}")
  list(APPEND command ${options})
endif()

# In the C locale the compiler quotes with plain ASCII, everywhere.
set(ENV{LC_ALL} C)
execute_process(COMMAND ${command} "${SOURCE}" RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)

if(expected STREQUAL "")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${SOURCE} should compile:\n${output}")
  endif()
elseif(status EQUAL 0)
  message(FATAL_ERROR "${SOURCE} should be refused with `${expected}`, but it compiles")
elseif(NOT output MATCHES "${expected}")
  message(FATAL_ERROR "${SOURCE} is refused, but not with `${expected}`:\n${output}")
endif()
