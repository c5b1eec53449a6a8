#include "core/signal/recording_columns.hpp"

#include "core/signal/column_streams.hpp"
#include "core/signal/infer_role.hpp"
#include "core/signal/missing.hpp"
#include "core/signal/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace driftlab {
namespace {

bool holds_text(std::span<const double> values) {
  return !values.empty() && std::isnan(values.front()) && why_missing(values.front()).why == Missing::Text;
}

/// The words of a name in lower case, between marks and where a capital follows a small letter; not those in brackets.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  char before = ' ';
  for (const char c : name.substr(0, name.find_first_of("(["))) {
    const char small = lower_case(c);
    const bool letter = small >= 'a' && small <= 'z';
    if ((!letter || (small != c && before == lower_case(before))) && !words.back().empty()) {
      words.emplace_back();
    }
    words.back() += letter ? std::string(1, small) : std::string();
    before = c;
  }
  return words;
}

/// What logs keep of a sensor beside its samples: PX4's `gyro_integral_dt`, `accel_count`, `gyro_x_var`. Counts of an
/// axis may be raw samples.
bool is_beside_samples(std::string_view name) {
  constexpr std::array<std::string_view, 17> kWords{
      "dt",      "time",     "timestamp", "timestamps", "temp",   "temperature", "clip", "clipping", "integral",
      "counter", "variance", "var",       "std",        "stddev", "status",      "id",   "count"};
  const std::vector<std::string> words = words_of(name);
  const bool axis = std::any_of(words.begin(), words.end(), [](const auto& word) { return axis_index(word); });
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::find(kWords.begin(), kWords.end(), word) != kWords.end() && !(axis && word == "count");
  });
}

/// Whether a name speaks of a gyroscope or an accelerometer, though not which axis: `gyro`, `acc_l_x`.
bool sounds_inertial(std::string_view name) {
  const std::string lower = lower_case(name);
  if (is_beside_samples(name)) {
    return false;
  }
  const auto holds = [&](const char* word) { return lower.find(word) != std::string::npos; };
  if (lower.starts_with("absolute")) {  // the length of the vector beside its axes, as phyphox writes it
    return false;
  }
  return holds("gyr") || (holds("acc") && !holds("accuracy")) || holds("omega") || holds("angular");
}

/// A column of which nobody said what it is, and whose name says nothing, may be words, a serial number or a sparse
/// sensor; so may one without a name that holds no number at all. Everything else is a sensor, whose holes are faults.
bool may_be_left_out(const ColumnRole& role, const std::string& name, std::size_t index,
                     std::span<const double> values) {
  const bool named = name != std::to_string(index);
  return role.quantity == Quantity::Unspecified &&
         (named || std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); }));
}

}  // namespace

std::optional<std::size_t> axis_index(std::string_view axis) {
  if (axis.size() == 1 && axis[0] >= 'x' && axis[0] <= 'z') {
    return static_cast<std::size_t>(axis[0] - 'x');
  }
  return std::nullopt;
}

RecordingColumns::RecordingColumns(ColumnNames names, std::vector<std::optional<ColumnRole>> roles, Samples column,
                                   bool guessed, bool time_stated)
    : names_(std::move(names)),
      roles_(std::move(roles)),
      column_(std::move(column)),
      guessed_(guessed),
      time_stated_(time_stated) {}

Result<RecordingColumns> RecordingColumns::read(const RecordingSpec& spec, const ColumnNames& names, Samples column) {
  auto roles = assign_roles(spec, names);
  if (!roles) {
    return fail(roles.error());
  }
  const bool time_stated = std::any_of(spec.columns.begin(), spec.columns.end(),
                                       [](const auto& stated) { return stated.second.quantity == Quantity::Time; });
  RecordingColumns columns(names, std::move(*roles), std::move(column), reads_names(spec), time_stated);
  columns.of_others_ = of_other_streams(spec, names);
  return columns;
}

Unit RecordingColumns::unit(std::size_t index, const Unit& otherwise) const {
  const std::optional<ColumnRole>& role = roles_[index];
  return role && role->unit ? *role->unit : otherwise;
}

std::vector<double> RecordingColumns::si(std::size_t index, const Unit& otherwise) const {
  const std::span<const double> rows = samples(index);
  const Unit own = unit(index, otherwise);
  std::vector<double> values(rows.size());
  std::transform(rows.begin(), rows.end(), values.begin(), [&](double v) { return own.to_si(v); });
  return values;
}

std::optional<std::size_t> RecordingColumns::find(Quantity quantity, std::string_view axis) const {
  const auto found = std::find_if(roles_.begin(), roles_.end(), [&](const std::optional<ColumnRole>& role) {
    return role && role->quantity == quantity && role->axis == axis;
  });
  return found == roles_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - roles_.begin()));
}

std::optional<std::size_t> RecordingColumns::time() const {
  const auto index = find(Quantity::Time);
  return index && !time_stated_ && holds_text(samples(*index)) ? std::nullopt : index;
}

std::optional<ReferenceColumn> RecordingColumns::reference_of(Quantity sensor, std::string_view axis) const {
  const bool rate = sensor == Quantity::AngularRate;
  if (!rate && sensor != Quantity::SpecificForce) {
    return std::nullopt;
  }
  if (const auto index = find(rate ? Quantity::ReferenceAngularRate : Quantity::ReferenceSpecificForce, axis)) {
    return ReferenceColumn{*index, false};
  }
  const auto angle = rate ? find(Quantity::ReferenceAngle, axis) : std::nullopt;
  return angle ? std::optional(ReferenceColumn{*angle, true}) : std::nullopt;
}

std::string RecordingColumns::time_of_text() const {
  const auto index = find(Quantity::Time);
  return index && !time() ? name(*index) : std::string();
}

std::string RecordingColumns::note_of_time() const {
  const auto index = find(Quantity::Time);
  if (const std::string text = time_of_text(); !text.empty()) {
    return "The column '" + text + "' holds text and is not used as time.";
  }
  return index && !guessed_ && !time_stated_
             ? "No column is stated to be the time; '" + name(*index) + "' is taken for it by its name."
             : "";
}

bool RecordingColumns::are_fixes() const {
  using Pair = std::pair<std::string_view, std::string_view>;
  constexpr std::array<Pair, 5> kOfReceivers{Pair{"latitude(deg)", "Q"},
                                             {"x-ecef(m)", "Q"},
                                             {"latitude (deg)", "hdop"},
                                             {"lat (deg)", "fixType"},
                                             {"gnss_latitude (deg)", "gnss_longitude (deg)"}};
  const auto named = [&](std::string_view name) {
    return std::find(names_.begin(), names_.end(), name) != names_.end();
  };
  return guessed_ && !has_inertial() && std::any_of(kOfReceivers.begin(), kOfReceivers.end(), [&](const Pair& pair) {
           return named(pair.first) && named(pair.second);
         });
}

bool RecordingColumns::has_inertial() const {
  return std::any_of(roles_.begin(), roles_.end(), [](const std::optional<ColumnRole>& role) {
    return role && (role->quantity == Quantity::AngularRate || role->quantity == Quantity::SpecificForce);
  });
}

bool RecordingColumns::is_skipped(std::size_t index) const {
  const std::optional<ColumnRole>& role = roles_[index];
  return guessed_ && role && role->quantity == Quantity::Unspecified && !sounds_inertial(name(index)) && has_inertial();
}

std::string RecordingColumns::note_of_skipped() const {
  std::string skipped;
  for (std::size_t i = 0; i < count(); ++i) {
    if (is_skipped(i)) {
      skipped += (skipped.empty() ? "'" : ", '") + name(i) + "'";
    }
  }
  return skipped.empty() ? skipped
                         : "No inertial sensor by their names, and skipped: " + skipped +
                               ". State what they measure to have them analysed.";
}

Result<ColumnUse> RecordingColumns::use_of(std::size_t index, const Passed& passed) const {
  const std::optional<ColumnRole>& role = roles_[index];
  if (is_skipped(index) || (!role && of_others_[index])) {
    return ColumnUse{};
  }
  if (!role) {
    return ColumnUse{false, "The column '" + name(index) + "' has no stated meaning and is ignored.", {}};
  }
  if (!is_sensor(role->quantity)) {
    const std::string unknown = role->unit ? "" : unknown_unit_of_temperature(name(index));
    return ColumnUse{false,
                     unknown.empty() ? ""
                                     : "The unit '" + unknown + "' of column '" + name(index) +
                                           "' is not known; it counts as not stated.",
                     {}};
  }
  if (const Status holes = check_holes(name(index), samples(index), passed); !holes) {
    if (guessed_ && may_be_left_out(*role, name(index), index, samples(index))) {
      return ColumnUse{false, "The column '" + name(index) + "' is left out: " + holes.error().message, holes.error()};
    }
    return fail(holes.error());
  }
  if (role->unit) {
    return ColumnUse{true, "", {}};
  }
  if (guessed_ && role->quantity == Quantity::Unspecified && states_unit(name(index))) {
    return ColumnUse{true,
                     "The name of column '" + name(index) +
                         "' does not say which sensor and axis it is, so its unit is not read and is 1.",
                     {}};
  }
  if (const std::string unread = guessed_ ? unread_unit(name(index)) : ""; !unread.empty()) {
    return ColumnUse{
        true, "The unit '" + unread + "' of column '" + name(index) + "' is not understood; its unit is 1.", {}};
  }
  return ColumnUse{true, "The unit of column '" + name(index) + "' is not stated; its unit is 1.", {}};
}

ChannelSurvey RecordingColumns::survey(std::size_t index, const Passed& passed) const {
  const std::span<const double> values = samples(index);
  ChannelSurvey survey = survey_channel(name(index), values, passed);
  const ColumnRole role = roles_[index].value_or(ColumnRole{});
  if (const auto source = reference_of(role.quantity, role.axis)) {
    const std::span<const double> subtracted = samples(source->index);
    for (std::size_t i = 0; i < subtracted.size(); ++i) {
      if (!std::isfinite(subtracted[i]) && std::isfinite(values[i])) {
        survey.unsound.push_back(i);
      }
    }
    std::sort(survey.unsound.begin(), survey.unsound.end());
    survey.unsound.erase(std::unique(survey.unsound.begin(), survey.unsound.end()), survey.unsound.end());
  }
  return survey;
}

double stated_rate(const Condition& condition, std::string_view axis, double time_s) {
  if (condition.axis != axis || !condition.value) {
    return 0.0;
  }
  switch (condition.kind) {
    case ConditionKind::ConstantRate:
      return *condition.value;
    case ConditionKind::ConstantAngularAcceleration:
      return *condition.value * time_s;
    default:
      return 0.0;
  }
}

}  // namespace driftlab
