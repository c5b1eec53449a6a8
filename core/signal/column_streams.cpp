#include "core/signal/column_streams.hpp"

#include "core/signal/infer_role.hpp"

#include <algorithm>
#include <string>

namespace driftlab {
namespace {

/// `imu2` of a column `imu2_...`; nothing for another name.
std::optional<std::string_view> unit_beside(std::string_view name) {
  constexpr std::string_view kUnit = "imu";
  const std::size_t end = name.find('_');
  if (end == std::string_view::npos || !name.starts_with(kUnit) || end == kUnit.size()) {
    return std::nullopt;
  }
  const std::string_view number = name.substr(kUnit.size(), end - kUnit.size());
  return number.find_first_not_of("0123456789") == std::string_view::npos ? std::optional(name.substr(0, end))
                                                                          : std::nullopt;
}

bool has(const ColumnNames& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::optional<std::string_view> name_within(std::string_view stream, std::string_view name) {
  constexpr std::string_view kMarks = "_./: ";
  const bool begins = !stream.empty() && name.size() > stream.size() + 1 && name.starts_with(stream) &&
                      kMarks.find(name[stream.size()]) != std::string_view::npos;
  return begins ? std::optional(name.substr(stream.size() + 1)) : std::nullopt;
}

std::vector<bool> of_other_streams(const RecordingSpec& spec, const ColumnNames& names) {
  std::vector<bool> other(names.size(), false);
  if (!reads_names(spec)) {
    return other;
  }
  const bool own_time = has(names, "time (s)");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto unit = unit_beside(names[i]);
    other[i] = spec.stream.empty() ? own_time && unit && has(names, std::string(*unit) + "_time (s)")
                                   : !name_within(spec.stream, names[i]);
  }
  return other;
}

Status check_stream(const RecordingSpec& spec, const ColumnNames& names) {
  if (spec.stream.empty()) {
    return {};
  }
  if (!reads_names(spec)) {
    return fail(
        ErrorCode::InvalidArgument,
        "State either the `stream` '" + spec.stream + "', whose columns are known by their names, or `columns`.",
        {{"parameter", "stream"}});
  }
  const bool any = std::any_of(names.begin(), names.end(),
                               [&](const std::string& name) { return name_within(spec.stream, name).has_value(); });
  return any ? Status{}
             : fail(ErrorCode::UnknownColumn,
                    "No column's name begins with '" + spec.stream +
                        "' and a mark, as those of the stream imu2 begin with 'imu2_'.",
                    {{"parameter", "stream"}});
}

}  // namespace driftlab
