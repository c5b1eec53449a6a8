#include "server/store/told_error.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace driftlab::server {
namespace {

/// What paths of the API begin with (server/api/routes.cpp): they are no files.
constexpr std::array<std::string_view, 8> kOfTheApi{"/v1",       "/docs",    "/problems", "/schemas",
                                                    "/openapi.", "/healthz", "/readyz",   "/metrics"};

void replace_all(std::string& text, std::string_view what) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + kNamedInTheLog.size())) {
    text.replace(at, what.size(), kNamedInTheLog);
  }
}

bool ends_path(char c) { return c == ' ' || c == '\n' || c == '"' || c == '\'' || c == ')' || c == ']' || c == ','; }

/// Every path that begins a word.
void replace_paths(std::string& text) {
  for (std::size_t at = text.find('/'); at != std::string::npos; at = text.find('/', at)) {
    const std::string_view rest = std::string_view(text).substr(at);
    const bool begins_word = at == 0 || ends_path(text[at - 1]) || text[at - 1] == '(' || text[at - 1] == '[';
    const bool of_api = std::any_of(kOfTheApi.begin(), kOfTheApi.end(),
                                    [rest](std::string_view prefix) { return rest.starts_with(prefix); });
    const auto* const stop = std::find_if(rest.begin(), rest.end(), ends_path);
    auto length = static_cast<std::size_t>(stop - rest.begin());
    while (length > 1 && (rest[length - 1] == '.' || rest[length - 1] == ':' || rest[length - 1] == ';')) {
      --length;  // the sentence goes on or ends here
    }
    if (!begins_word || of_api || length < 2) {
      at += std::max<std::size_t>(length, 1);
      continue;
    }
    text.replace(at, length, kNamedInTheLog);
    at += kNamedInTheLog.size();
  }
}

/// A file, not a place in a document that was sent: those are names of fields.
bool is_path(const ErrorField& field) {
  return field.name == "path" || (!field.name.starts_with('/') && field.value.starts_with('/') &&
                                  field.value.find('/', 1) != std::string::npos);
}

}  // namespace

Error without_paths(const Error& error) {
  Error told = error;
  std::vector<std::string> paths;
  for (const ErrorField& field : error.fields) {
    if (is_path(field) && field.value.starts_with('/')) {
      paths.push_back(field.value);
    }
  }
  std::erase_if(told.fields, is_path);
  const bool own =
      error.code == ErrorCode::Io || error.code == ErrorCode::DiskFull || error.code == ErrorCode::Internal;
  const auto strip = [&](std::string& text) {
    for (const std::string& path : paths) {
      replace_all(text, path);
    }
    if (own) {
      replace_paths(text);
    }
  };
  strip(told.message);
  for (ErrorField& field : told.fields) {
    strip(field.value);
  }
  return told;
}

}  // namespace driftlab::server
