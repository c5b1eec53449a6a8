#pragma once
/// The use case "preview": reads the beginning of a file and describes the recording that its upload would make.
/// Nothing is stored.
///
/// Columns mean what an upload would take them to mean (core/signal/recording.hpp), the rate is that of the time column
/// or the one stated, and everything that would refuse the upload is a problem with the field that repairs it. What
/// speaks against a unit is a hint (core/datasheet/plausible_units.hpp). A column that rises as a time does and has
/// no unit is proposed as one, and a condition that the readings show is proposed where they show one:
///   turning: the gyroscope axis of the largest mean reads at least 1 deg/s with a standard deviation below a fifth of
///   it; at rest: every mean is below 1 deg/s, and the standard deviation of every axis is below that of a sensor that
///   lies still (`still_deviation`, core/analysis/growing_recording.hpp).
#include "core/read/decode_head.hpp"
#include "core/signal/guess_time.hpp"
#include "core/signal/recording.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// Where the meaning of a column comes from.
enum class RoleOrigin {
  Header,  ///< its name in the file
  Number,  ///< the file has no names; columns are numbered
  Stated,  ///< the user says so
};

/// `header`, `number`, `stated`.
[[nodiscard]] std::string_view name_of(RoleOrigin origin);

struct PreviewColumn {
  std::string name;
  std::optional<ColumnRole> role;  ///< nothing for a column that is not read
  RoleOrigin from = RoleOrigin::Header;
  std::vector<double> first;   ///< up to 5 values in the file's unit
  std::vector<double> course;  ///< up to 120 values spread over the rows seen
};

struct ConditionGuess {
  Condition condition;
  std::string because;  ///< a sentence
};

struct RecordingPreview {
  DecodedHead head;  ///< its samples too
  HeadExtent extent = HeadExtent::Beginning;
  std::vector<PreviewColumn> columns;
  std::optional<double> rate_hz;
  bool rate_is_stated = false;  ///< else from the time column
  std::optional<TimeGuess> time;
  std::optional<ConditionGuess> condition;
  std::vector<std::string> hints;  ///< sentences that speak against a unit
  std::vector<Error> problems;     ///< what an upload would be refused for
  std::vector<std::string> notes;  ///< what is true of the file
};

struct PreviewRequest {
  std::string_view bytes;
  HeadExtent extent = HeadExtent::Beginning;
  RecordingSpec spec;  ///< as an upload would state it; its condition only where `condition_is_stated`
  bool condition_is_stated = false;
  std::span<const std::string> hardware = {};  ///< texts that describe the device, most telling first
};

/// Never fails: a file that cannot be read is one problem and no columns. O(bytes).
[[nodiscard]] RecordingPreview preview_recording(const PreviewRequest& request, const DecodeLimits& limits = {});

}  // namespace driftlab
