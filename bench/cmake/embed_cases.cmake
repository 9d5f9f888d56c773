# Writes OUTPUT, a C++ file that defines sipplab::bench::adversarial_cases() from the .case
# files in FOLDER. Run by the build with cmake -P; needs nothing but CMake.
file(GLOB files ${FOLDER}/*.case)
list(SORT files)
set(entries "")
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND entries "    {\"${name}\", R\"case(${text})case\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made from bench/adversarial by bench/cmake/embed_cases.cmake.
#include \"bench/sweep/adversarial.hpp\"

namespace sipplab::bench {
namespace {
constexpr AdversarialCase kCases[] = {
${entries}};
}  // namespace

std::span<const AdversarialCase> adversarial_cases() { return kCases; }

}  // namespace sipplab::bench
")
