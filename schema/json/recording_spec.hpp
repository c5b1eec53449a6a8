#pragma once
/// The meaning of a recording (spec/study.md, one member of `recordings`) as JSON, query text and back.
#include "core/signal/recording.hpp"
#include "schema/json/json.hpp"

#include <string_view>

namespace driftlab {

/// {"kind": "constant_rate", "axis": "z", "value": 9, "unit": "deg/s"}
[[nodiscard]] Json to_json(const Condition& condition);

/// Faults are added at `pointer` and below; the result is then unspecified.
[[nodiscard]] Condition condition_from_json(const Json& document, const std::string& pointer, Faults& faults);

/// One recording without its file: id, rate_hz, columns, condition, trim. Members that were not stated are left out.
[[nodiscard]] Json to_json(const RecordingSpec& spec);

/// What becomes of the member `file` of a recording: an upload carries its bytes itself and ignores it, a stored
/// recording has none.
enum class FileMember { Ignored, Refused };

/// Reads the members of a recording; labels, session and recorded_at are accepted and ignored
/// (schema/json/recording_tags.hpp), and their faults found nevertheless.
[[nodiscard]] RecordingSpec recording_spec_from_json(const Json& document, const std::string& pointer, Faults& faults,
                                                     FileMember file = FileMember::Ignored);

/// `columns` of a query string or command line: `gz=angular_rate:z:deg/s,temp=temperature::degC,t=time::s`. A column is
/// named as in the file, or by number from 0; axis and unit may be empty or left out. Errors: InvalidArgument,
/// UnknownQuantity, UnknownUnit, UnitMismatch; each names the column.
[[nodiscard]] Result<std::map<std::string, ColumnRole>> parse_columns(std::string_view text);

/// A column of a file and its meaning: {"name", "quantity", "axis", "unit"}, null for a member that is not stated.
[[nodiscard]] Json role_json(const std::string& name, const std::optional<ColumnRole>& role);

}  // namespace driftlab
