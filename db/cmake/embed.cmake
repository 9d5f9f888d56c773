# Texts that a library carries with it. sipplab_embed(SOURCES SYMBOL HEADER FILES...) adds to the list SOURCES a
# C++ file that defines sipplab::SYMBOL(), which HEADER declares: a span of db::EmbeddedText, one for each file in
# the order given. The build makes it by running this file with cmake -P.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(SIPPLAB_EMBED ${CMAKE_CURRENT_LIST_FILE})
  function(sipplab_embed sources symbol header)
    string(MAKE_C_IDENTIFIER ${symbol} name)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
    add_custom_command(
      OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DSYMBOL=${symbol} -DHEADER=${header} "-DFILES=${ARGN}" -P ${SIPPLAB_EMBED}
      DEPENDS ${ARGN} ${SIPPLAB_EMBED}
      COMMENT "Embedding ${symbol}"
      VERBATIM)
    set(${sources} ${${sources}} ${output} PARENT_SCOPE)
  endfunction()
  return()
endif()

set(entries "")
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND entries "      {\"${name}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by db/cmake/embed.cmake.
#include \"${HEADER}\"

std::span<const sipplab::db::EmbeddedText> sipplab::${SYMBOL}() {
  static const db::EmbeddedText texts[] = {
${entries}  };
  return texts;
}
")
