#pragma once
/// The GPS/IMU unit of a KITTI raw drive: `oxts/timestamps.txt` with a date a line, and `oxts/data/0000000000.txt`, ...
/// with the thirty numbers of one moment each, as a ZIP archive or as a folder. Internal to core/read.
///
/// Source: A. Geiger et al., "Vision meets robotics: the KITTI dataset", IJRR 32 (2013), and the `dataformat.txt`
/// beside the data. Rates and forces are those about the axes of the unit: forward, left, up. Position and velocity are
/// the unit's own solution. Dates say no zone and become seconds since 1970 as they are written.
///
/// A moment whose file is missing or empty is left out and counted. Memory: 248 bytes a moment.
#include "core/read/format.hpp"

#include <filesystem>

namespace driftlab {

/// True for a folder that holds `oxts`, or is it, and for that of a date, whose folders hold it.
[[nodiscard]] bool is_kitti_folder(const std::filesystem::path& folder);

/// The drive of such a folder. Errors: those of its files; NoSamples, NotFound, Io; UnsupportedFormat for a date of
/// several drives.
[[nodiscard]] Status decode_kitti_folder(const std::filesystem::path& folder, const DecodeLimits& limits,
                                         ColumnSink& sink, const RunControl& control);

}  // namespace driftlab
