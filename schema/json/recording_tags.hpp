#pragma once
/// What a recording is called, beside what it means (schema/json/recording_spec.hpp): labels, its session and its time.
/// No analysis of the recording itself depends on them; a regression run compares by them.
#include "schema/json/json.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

struct RecordingTags {
  std::map<std::string, std::string> labels;  ///< {"firmware", "1.5.0"}
  std::string session;                        ///< one power-up of the device, under any name
  std::string recorded_at;                    ///< RFC 3339; empty: not stated

  [[nodiscard]] bool operator==(const RecordingTags&) const = default;
};

/// `labels`, `session` and `recorded_at` of a recording's members; others are left alone.
[[nodiscard]] RecordingTags recording_tags_from_json(const Json& document, const std::string& pointer, Faults& faults);

/// Members that were not stated are left out.
[[nodiscard]] Json to_json(const RecordingTags& tags);

/// `firmware=1.5.0,board=b`, as a query and a command line have it. Error: InvalidArgument.
[[nodiscard]] Result<std::map<std::string, std::string>> parse_labels(std::string_view text);

/// Each label as `name=value`.
[[nodiscard]] std::vector<std::string> label_words(const std::map<std::string, std::string>& labels);

}  // namespace driftlab
