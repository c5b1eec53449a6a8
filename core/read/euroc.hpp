#pragma once
/// The IMU of a sequence in the EuRoC layout, `mav0/imu0/data.csv`, as a folder. Internal to core/read.
#include "core/read/format.hpp"

#include <filesystem>
#include <optional>

namespace driftlab {

/// The IMU table of a folder that holds `mav0`, is it, or is its `imu0`; nothing where there is none in this layout.
[[nodiscard]] std::optional<std::filesystem::path> find_euroc_table(const std::filesystem::path& folder);

/// The table as a recording. Errors: those of the file.
[[nodiscard]] Status decode_euroc_table(const std::filesystem::path& table, const DecodeLimits& limits,
                                        ColumnSink& sink, const RunControl& control);

}  // namespace driftlab
