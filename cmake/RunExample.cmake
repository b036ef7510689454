# cmake -DOUTPUT=<folder> [-DFILES=<file>;...] [-DEXPECT=<regex>;...] -P RunExample.cmake -- <program> <arg>...
#
# Runs the program with `--output <folder>`; fails unless it succeeds, leaves every file (not empty) in the folder, and
# prints something that matches every regex.

include("${CMAKE_CURRENT_LIST_DIR}/ScriptArguments.cmake")

file(REMOVE_RECURSE "${OUTPUT}")
execute_process(COMMAND ${command} --output "${OUTPUT}" RESULT_VARIABLE status OUTPUT_VARIABLE output
                ERROR_VARIABLE output ECHO_OUTPUT_VARIABLE ECHO_ERROR_VARIABLE)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "The program ended with ${status}")
endif()

foreach(name IN LISTS FILES)
  set(size 0)
  if(EXISTS "${OUTPUT}/${name}")
    file(SIZE "${OUTPUT}/${name}" size)
  endif()
  if(size EQUAL 0)
    message(SEND_ERROR "${OUTPUT}/${name} is missing or empty")
  endif()
endforeach()

foreach(regex IN LISTS EXPECT)
  if(NOT output MATCHES "${regex}")
    message(SEND_ERROR "The output does not match `${regex}`")
  endif()
endforeach()
