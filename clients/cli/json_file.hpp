#pragma once
/// JSON documents from files.
#include "schema/json/json.hpp"

#include <filesystem>
#include <string>

namespace driftlab::cli {

/// The document in a file. `wanted`: what the file should be, for the sentences ("a study"). Errors, each naming the
/// file: NotFound; ParseError, which for a file that is no JSON at all (a table, a picture) says what is wanted
/// instead.
[[nodiscard]] Result<Json> read_json_file(const std::filesystem::path& path, const std::string& wanted);

/// The same error with the file in front, and the place in its document.
[[nodiscard]] Error in_file(const std::filesystem::path& path, const Error& error);

/// What most commands that do not take recordings take.
inline constexpr const char* kWrittenByJson = "a document that a command of driftlab wrote with --json";

}  // namespace driftlab::cli
