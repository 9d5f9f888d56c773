# The toolchain of the presets that build with Clang: whichever version is installed.
execute_process(COMMAND ${CMAKE_CURRENT_LIST_DIR}/clang
                OUTPUT_VARIABLE compiler OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "no clang++ from version 14 on with its sanitizers and LLVM tools; scripts/setup installs one")
endif()
set(CMAKE_CXX_COMPILER ${compiler})
execute_process(COMMAND ${CMAKE_CURRENT_LIST_DIR}/clang llvm-symbolizer
                OUTPUT_VARIABLE SIPPLAB_SYMBOLIZER OUTPUT_STRIP_TRAILING_WHITESPACE)
