# Writes OUTPUT, a C++ file that defines sipplab::db::migrations() from the SQL files
# in FOLDER. Run by the build with cmake -P; needs nothing but CMake.
file(GLOB files ${FOLDER}/[0-9][0-9][0-9][0-9]_*.sql)
list(SORT files)
set(entries "")
set(expected "")
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME_WE)
  string(REGEX REPLACE "^0*([1-9][0-9]*)_.*$" "\\1" version ${name})
  if(expected AND NOT version EQUAL expected)
    message(FATAL_ERROR "${file}: version ${version}, expected ${expected}: migrations are numbered without gaps")
  endif()
  math(EXPR expected "${version} + 1")
  file(READ ${file} sql)
  # Compilers limit the length of one literal; pieces at ends of statements join up again.
  string(REPLACE ";\n" ";\n)sql\"\nR\"sql(" sql "${sql}")
  string(APPEND entries "    {${version}, \"${name}\", R\"sql(${sql})sql\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made from db/migrations by db/cmake/embed_migrations.cmake.
#include \"db/migrate.hpp\"

namespace sipplab::db {
namespace {
constexpr Migration kMigrations[] = {
${entries}};
}  // namespace

std::span<const Migration> migrations() { return kMigrations; }

}  // namespace sipplab::db
")
