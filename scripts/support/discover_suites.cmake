# Writes a file for ctest: one test for each suite of a program of GoogleTest. A program with sanitizers takes a
# fifth of a second to start, which is more than most single tests take.
#
#   cmake -DPROGRAM=PATH -DRUNNER=LIST -DPREFIX=unit. -DPROPERTIES=LIST -DOUTPUT=FILE -P discover_suites.cmake
unset(ENV{GTEST_FILTER})
execute_process(COMMAND ${RUNNER} ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed TIMEOUT 60
                COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\.(\n|  #)" lines "${listed}")
if(NOT lines)
  message(FATAL_ERROR "${PROGRAM}: no suites, expected some")
endif()
# A suite that ran nothing is skipped; one of which something failed has more lines at its end.
set(skipped "PASSED  \\] 0 tests\\.[\r\n]+(\\[  SKIPPED [^\r\n]*[\r\n]*)+$")
set(tests "")
foreach(line IN LISTS lines)
  string(REGEX REPLACE "^\n?([^.]+)\\..*" "\\1" suite "${line}")
  string(APPEND tests "add_test([==[${PREFIX}${suite}]==]")
  foreach(word IN LISTS RUNNER ITEMS "${PROGRAM}" "--gtest_filter=${suite}.*")
    string(APPEND tests " [==[${word}]==]")
  endforeach()
  list(JOIN PROPERTIES " " properties)
  string(APPEND tests ")\nset_tests_properties([==[${PREFIX}${suite}]==] PROPERTIES ${properties}"
                      " SKIP_REGULAR_EXPRESSION [==[${skipped}]==])\n")
endforeach()
file(WRITE ${OUTPUT} "${tests}")
