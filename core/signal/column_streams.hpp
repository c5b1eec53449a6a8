#pragma once
/// Tables with the sensors of several units, told apart by the beginnings of their columns' names: `imu2_gyro_x
/// (rad/s)` of a flight log, `imu1.wb_x` of a struct, `front/acc_x` of a group.
///
/// The `stream` of a recording is such a beginning; it makes the unit's columns those of the recording. Without one a
/// table that has a time and a sensor in columns `time (s)`, `gyro_x`, ... is that unit's, and the units beside it that
/// have a time of their own, `imu2_time (s)`, as logs of several inertial streams are read
/// (core/read/inertial_streams.hpp), are passed over.
#include "core/signal/recording.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace driftlab {

/// What `name` is called within `stream`: what follows it and a mark (_ . / : or a blank). Nothing for another column.
[[nodiscard]] std::optional<std::string_view> name_within(std::string_view stream, std::string_view name);

/// For each column, whether it is another unit's than the recording's.
[[nodiscard]] std::vector<bool> of_other_streams(const RecordingSpec& spec, const ColumnNames& names);

/// Errors: InvalidArgument (columns beside the time are stated as well), UnknownColumn (no column begins so); both name
/// the parameter `stream`.
[[nodiscard]] Status check_stream(const RecordingSpec& spec, const ColumnNames& names);

}  // namespace driftlab
