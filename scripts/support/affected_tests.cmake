# Prints the numbers of the tests whose programs, scripts or data changed after STAMP, for ctest -I.
#
#   cmake -DBUILD=build/debug -DSTAMP=FILE -P affected_tests.cmake
execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${BUILD} --show-only=json-v1
                OUTPUT_VARIABLE json COMMAND_ERROR_IS_FATAL ANY)
string(JSON tests GET "${json}" tests)
string(JSON count LENGTH "${tests}")
if(count EQUAL 0)
  return()
endif()
math(EXPR last "${count} - 1")
set(numbers "")
foreach(i RANGE ${last})
  # A list of hundreds is parsed anew for each question: one question a test.
  string(JSON test GET "${tests}" ${i})
  string(JSON words LENGTH "${test}" command)
  math(EXPR last_word "${words} - 1")
  foreach(word RANGE ${last_word})
    string(JSON file GET "${test}" command ${word})
    if(IS_ABSOLUTE "${file}" AND EXISTS "${file}" AND NOT IS_DIRECTORY "${file}" AND "${file}" IS_NEWER_THAN "${STAMP}")
      math(EXPR number "${i} + 1")
      string(APPEND numbers ",${number}")
      break()
    endif()
  endforeach()
endforeach()
execute_process(COMMAND ${CMAKE_COMMAND} -E echo "${numbers}")
