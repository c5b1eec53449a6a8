#include "clients/cli/json_file.hpp"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

namespace driftlab::cli {

Result<Json> read_json_file(const std::filesystem::path& path, const std::string& wanted) {
  errno = 0;
  const std::ifstream stream(path, std::ios::binary);
  std::error_code unknown;
  if (!stream || std::filesystem::is_directory(path, unknown)) {
    const std::string why = errno != 0 ? ": " + std::generic_category().message(errno) : " as a file";
    return fail(ErrorCode::NotFound, path.string() + " cannot be opened" + why + "; wanted is " + wanted + ".",
                {{"path", path.string()}});
  }
  std::ostringstream text;
  text << stream.rdbuf();
  const std::string content = text.str();
  const std::size_t first = content.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || (content[first] != '{' && content[first] != '[')) {
    return fail(ErrorCode::ParseError,
                path.string() + (first == std::string::npos ? " is empty" : " is no JSON document") + "; wanted is " +
                    wanted + ".",
                {{"path", path.string()}});
  }
  auto document = parse_json(content);
  return document ? document : fail(in_file(path, document.error()));
}

Error in_file(const std::filesystem::path& path, const Error& error) {
  std::string where = path.string();
  if (!error.fields.empty() && error.fields.front().name.starts_with('/')) {
    where += ", " + error.fields.front().name;
  }
  return {error.code, where + ": " + error.message, error.fields};
}

}  // namespace driftlab::cli
