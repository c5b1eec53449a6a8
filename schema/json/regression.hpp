#pragma once
/// A regression run as JSON: what it is asked (spec/regression.md, section 2) and its document
/// (schema/regression.schema.json).
#include "core/analysis/regress.hpp"
#include "core/signal/recording.hpp"
#include "schema/json/json.hpp"
#include "schema/json/stated_facts.hpp"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace driftlab {

/// Units in which margins of a bias and of a scale factor are written, beside deg/s: mg [m/s^2] and ppm.
inline constexpr double kRegressionMg = 9.80665e-3;
inline constexpr double kRegressionPpm = 1e-6;

/// One recording of a request, before anything is read: a file to be characterised, a file with a characterisation, or
/// a recording that a server has.
struct WrittenRecording {
  std::string file;
  std::string result;
  std::string recording;
  RecordingSpec spec;  ///< of `file`
  std::string session;
  std::string recorded_at;  ///< RFC 3339; empty: not stated
  StatedFacts stated;
  std::string pointer;
};

struct WrittenArm {
  std::string label;    ///< `firmware=1.4.2`, of `labels` by name, joined by commas
  std::string special;  ///< `anchor` or `last_pass` in place of an arm
  std::vector<WrittenRecording> recordings;
};

/// What the exit code does with an inconclusive verdict; the verdict stays.
enum class Inconclusive { Inconclusive, Pass, Fail };

struct WrittenRegression {
  std::string device;
  WrittenArm baseline;
  WrittenArm candidate;
  std::vector<WrittenArm> history;
  std::vector<regression::Exclusion> excluded;
  regression::Settings settings;
  std::size_t looks = 3;
  Inconclusive inconclusive = Inconclusive::Inconclusive;
  std::set<std::string> stated;  ///< settings that the request names
};

/// `firmware=1.5.0` from {"firmware": "1.5.0"}.
[[nodiscard]] std::string label_text(const Json& labels);

/// `settings` of a request; absent members keep their defaults.
void regression_settings_from_json(const Json& document, const std::string& pointer, WrittenRegression& into,
                                   Faults& faults);

/// The whole request. Unknown members are faults.
[[nodiscard]] WrittenRegression regression_from_json(const Json& document, Faults& faults);

/// Seconds since 1970 of an RFC 3339 time. Error: InvalidArgument.
[[nodiscard]] Result<double> seconds_of(const std::string& time);

/// The document of a run. `settings` and `between` are with it, so that it says what it rests on.
[[nodiscard]] Json to_json(const RegressReport& report);

/// A member of `event_limits` that is a number: its name, what it sets, and what one of its units is there.
struct LimitMember {
  const char* name;
  double regression::EventLimits::* limit;
  double unit;
};
[[nodiscard]] const std::vector<LimitMember>& limit_members();

/// Of the settings those that an anchor keeps (core/campaign/regression/kept_settings.hpp).
[[nodiscard]] Json kept_settings_json(const regression::Settings& settings);

/// Settings as they are written.
[[nodiscard]] Json to_json(const regression::Settings& settings, std::size_t looks);

}  // namespace driftlab
