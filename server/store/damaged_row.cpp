#include "server/store/damaged_row.hpp"

namespace driftlab::server {
namespace {

constexpr std::string_view kField = "damaged_row";

}  // namespace

Error damaged_row(std::string_view table, std::string_view noun, std::string_view key) {
  const std::string row = std::string(table) + "/" + std::string(key);
  return {ErrorCode::Io,
          "The stored " + std::string(noun) + " \"" + std::string(key) +
              "\" is damaged: its row is not what was written. Take it from a backup, or make it anew.",
          {{std::string(kField), row}}};
}

std::string damaged_row_of(const Error& error) {
  for (const ErrorField& field : error.fields) {
    if (error.code == ErrorCode::Io && field.name == kField) {
      return field.value;
    }
  }
  return {};
}

}  // namespace driftlab::server
