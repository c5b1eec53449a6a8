#pragma once
/// Where the next page of a list begins, as a text that clients hand back as they got it.
///
/// It is the id of the last row; in a list by name the row's name stands behind it, two hexadecimal digits a byte, so
/// that it needs no escapes wherever it stands: `dev_01…` or `dev_01….70686f6e65`.
#include "server/store/store.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace driftlab::server {

struct Cursor {
  std::string id;
  std::string name;  ///< of a list by name; may be any bytes
};

/// Nothing for a text that no list in this order gave.
[[nodiscard]] std::optional<Cursor> read_cursor(std::string_view text, PageOrder order);

/// The text of a row; empty without one.
[[nodiscard]] std::string cursor_at(PageOrder order, const std::string& id, const std::string& name);

}  // namespace driftlab::server
