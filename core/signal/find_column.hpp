#pragma once
/// Finds a column of a file by the name that a study or a drive document gives for it.
#include "core/signal/recording.hpp"

#include <cstddef>
#include <string>

namespace driftlab {

/// The place of the column called `column`: by its name, else by its number from 0. Error: UnknownColumn, with the
/// first names of the file.
[[nodiscard]] Result<std::size_t> find_column(const ColumnNames& names, const std::string& column);

}  // namespace driftlab
