# Writes OUTPUT, a C++ file that defines sipplab::SYMBOL(), which HEADER declares: a std::string_view of the text
# of INPUT. Run by the build with cmake -P.
file(READ ${INPUT} text)
# Compilers limit the length of one literal; pieces at ends of paragraphs join up again.
string(REPLACE "\n\n" "\n\n)text\"\nR\"text(" text "${text}")
file(WRITE ${OUTPUT} "// Made from ${NAME} by db/cmake/embed_text.cmake.
#include \"${HEADER}\"

std::string_view sipplab::${SYMBOL}() {
  static constexpr std::string_view text{R\"text(${text})text\"};
  return text;
}
")
