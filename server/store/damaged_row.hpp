#pragma once
/// A row of the store that is not what was written: a bit of it changed on its way to the disk, there, or back.
#include "core/signal/result.hpp"

#include <string>
#include <string_view>

namespace driftlab::server {

/// An error of code Io that names the row as `table/key`, in its field `damaged_row`.
[[nodiscard]] Error damaged_row(std::string_view table, std::string_view noun, std::string_view key);

/// The row that such an error names; empty for any other error.
[[nodiscard]] std::string damaged_row_of(const Error& error);

}  // namespace driftlab::server
