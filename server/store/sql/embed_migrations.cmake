# Writes OUTPUT, a C++ file that holds every FOLDER/NNNN_name.sql as text: what FUNCTION, declared in HEADER, returns. Run by the
# build when a migration changes. MORE: further texts behind them, as a later release would have, for tests; @BEFORE@ in one is the number
# before its own.
file(GLOB migrations ${FOLDER}/*.sql)
list(SORT migrations)
set(entries "")
set(expected 1)
foreach(path ${migrations})
  get_filename_component(file ${path} NAME_WE)
  if(NOT file MATCHES "^([0-9][0-9][0-9][0-9])_([a-z0-9_]+)$")
    message(FATAL_ERROR "${path}: a migration is called NNNN_name.sql")
  endif()
  set(digits ${CMAKE_MATCH_1})
  set(name ${CMAKE_MATCH_2})
  string(REGEX REPLACE "^0+" "" number ${digits})
  if(NOT number EQUAL expected)
    message(FATAL_ERROR "${path}: migration ${expected} is missing")
  endif()
  math(EXPR expected "${expected} + 1")
  file(READ ${path} text)
  # Square brackets and semicolons mean something to CMake lists, so the text is appended and never listed.
  string(APPEND entries "    {${number}, \"${name}\", R\"driftlab_sql(${text})driftlab_sql\"},\n")
endforeach()
foreach(path ${MORE})
  get_filename_component(name ${path} NAME_WE)
  math(EXPR before "${expected} - 1")
  file(READ ${path} text)
  string(REPLACE "@BEFORE@" ${before} text "${text}")
  string(APPEND entries "    {${expected}, \"${name}\", R\"driftlab_sql(${text})driftlab_sql\"},\n")
  math(EXPR expected "${expected} + 1")
endforeach()
file(WRITE ${OUTPUT} "// Made by server/store/sql/embed_migrations.cmake.
#include \"${HEADER}\"

namespace driftlab::server {

const std::vector<Migration>& ${FUNCTION}() {
  static const std::vector<Migration> kMigrations = {
${entries}  };
  return kMigrations;
}

}  // namespace driftlab::server
")
