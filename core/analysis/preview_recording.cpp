#include "core/analysis/preview_recording.hpp"

#include "core/analysis/growing_recording.hpp"
#include "core/datasheet/plausible_units.hpp"
#include "core/signal/angle.hpp"
#include "core/signal/infer_role.hpp"
#include "core/signal/number.hpp"
#include "core/signal/recording_columns.hpp"
#include "core/signal/recording_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kFirst = 5;
constexpr std::size_t kCourse = 120;
constexpr std::size_t kFewest = 20;  ///< rows from which a mean says something

constexpr double kTurns = 1.0 * kDegree;  ///< [rad/s]; a slower mean is a bias
constexpr double kSteady = 0.2;           ///< deviation over mean of a rate that is constant

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;
};

/// In SI; nothing below kFewest finite values.
std::optional<Moments> moments_of(std::span<const double> values, const Unit& unit) {
  double sum = 0.0;
  double squares = 0.0;
  std::size_t count = 0;
  for (const double value : values) {
    if (std::isfinite(value)) {
      const double x = unit.to_si(value);
      sum += x;
      squares += x * x;
      ++count;
    }
  }
  if (count < kFewest) {
    return std::nullopt;
  }
  const double mean = sum / static_cast<double>(count);
  return Moments{mean, std::sqrt(std::max(0.0, squares / static_cast<double>(count) - mean * mean))};
}

std::vector<double> spread(std::span<const double> values) {
  std::vector<double> course;
  const std::size_t step = std::max<std::size_t>(1, (values.size() + kCourse - 1) / kCourse);
  for (std::size_t i = 0; i < values.size(); i += step) {
    course.push_back(values[i]);
  }
  return course;
}

std::string written(const char* format, double value) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::optional<ConditionGuess> guess_condition(const RecordingPreview& preview) {
  bool seen = false;
  bool still = true;
  const PreviewColumn* fastest = nullptr;
  Moments turning;
  for (std::size_t i = 0; i < preview.columns.size(); ++i) {
    const auto& role = preview.columns[i].role;
    const bool rate = role && role->quantity == Quantity::AngularRate;
    const bool force = role && role->quantity == Quantity::SpecificForce;
    const auto moments = (rate || force) && role->unit && role->unit->dimension != Dimension::One
                             ? moments_of(preview.head.columns[i], *role->unit)
                             : std::nullopt;
    if (!moments) {
      continue;
    }
    seen = true;
    still = still && moments->deviation < still_deviation(rate ? Dimension::AngularRate : Dimension::SpecificForce);
    if (rate && !role->axis.empty() && (fastest == nullptr || std::abs(moments->mean) > std::abs(turning.mean))) {
      fastest = &preview.columns[i];
      turning = *moments;
    }
  }
  if (fastest != nullptr && std::abs(turning.mean) >= kTurns) {
    if (turning.deviation >= kSteady * std::abs(turning.mean)) {
      return std::nullopt;
    }
    const double rounded = parse_double(written("%.2g", turning.mean / kDegree)).value_or(0.0);
    const std::string axis = fastest->role ? fastest->role->axis : std::string();
    const auto condition = make_condition({"constant_rate", axis, rounded, "deg/s", std::nullopt});
    return condition ? std::optional(ConditionGuess{
                           *condition, "The gyroscope about " + axis + " reads " +
                                           written("%.3g deg/s and hardly changes.", turning.mean / kDegree)})
                     : std::nullopt;
  }
  return seen && still ? std::optional(ConditionGuess{Condition{},
                                                      "Nothing turns, and the readings are those of a "
                                                      "sensor that nobody moves."})
                       : std::nullopt;
}

/// Whether an error only says that few rows were seen so far.
bool is_for_lack_of_rows(const RecordingPreview& preview, const Error& error) {
  return preview.extent == HeadExtent::Beginning && error.code == ErrorCode::TooFewSamples;
}

/// The rate, and what an upload would be refused for. Gives the interval of the samples [s], 0 where it is not known.
double view(const PreviewRequest& request, RecordingPreview& preview) {
  const DecodedHead& head = preview.head;
  const std::size_t rows = head.rows();
  const auto column = [&](std::size_t i) { return std::span<const double>(head.columns[i]).first(rows); };
  const auto seen = view_recording(request.spec, head.names, rows, column, ViewUse::Survey);
  if (!seen) {
    if (!is_for_lack_of_rows(preview, seen.error())) {
      preview.problems.push_back(seen.error());
    }
    return 0.0;
  }
  const Quality& quality = seen->window.quality;
  preview.rate_is_stated = !(quality.measured_rate_hz > 0.0);
  preview.rate_hz = preview.rate_is_stated ? request.spec.rate_hz : std::optional<double>(quality.measured_rate_hz);
  preview.notes.insert(preview.notes.end(), quality.notes.begin(), quality.notes.end());
  return seen->window.time.dt_s;
}

/// What speaks against the units of the inertial columns, by their readings before the first that is missing.
std::vector<std::string> hints_of(const PreviewRequest& request, const RecordingPreview& preview, double dt_s) {
  std::vector<ObservedChannel> observed;
  for (std::size_t i = 0; i < preview.columns.size(); ++i) {
    const auto& role = preview.columns[i].role;
    if (role && role->unit && (role->quantity == Quantity::AngularRate || role->quantity == Quantity::SpecificForce)) {
      const std::vector<double>& values = preview.head.columns[i];
      const auto end = std::find_if(values.begin(), values.end(), [](double x) { return !std::isfinite(x); });
      observed.push_back(
          {preview.columns[i].name, role->quantity, role->axis, *role->unit, std::span(values.begin(), end)});
    }
  }
  const bool at_rest = request.condition_is_stated ? request.spec.condition.kind == ConditionKind::Static
                                                   : preview.condition && preview.condition->condition == Condition{};
  return unit_notes(observed, dt_s, at_rest, request.hardware);
}

}  // namespace

std::string_view name_of(RoleOrigin origin) {
  switch (origin) {
    case RoleOrigin::Header:
      return "header";
    case RoleOrigin::Number:
      return "number";
    case RoleOrigin::Stated:
      return "stated";
  }
  return "header";
}

RecordingPreview preview_recording(const PreviewRequest& request, const DecodeLimits& limits) {
  RecordingPreview preview;
  preview.extent = request.extent;
  auto head = decode_head(request.bytes, request.extent, limits);
  if (!head) {
    preview.problems.push_back(head.error());
    return preview;
  }
  preview.head = std::move(*head);
  preview.notes = preview.head.notes;
  auto roles = assign_roles(request.spec, preview.head.names);
  if (!roles) {
    preview.problems.push_back(roles.error());
    roles = std::vector<std::optional<ColumnRole>>(preview.head.names.size());
  }
  for (std::size_t i = 0; i < preview.head.names.size(); ++i) {
    const std::span<const double> values = preview.head.columns[i];
    const auto first = values.first(std::min(kFirst, values.size()));
    const std::optional<ColumnRole>& role = (*roles)[i];
    const bool time = role && role->quantity == Quantity::Time;
    const bool stated = !request.spec.columns.empty() && (time || !reads_names(request.spec));
    const RoleOrigin from = stated                    ? RoleOrigin::Stated
                            : preview.head.has_header ? RoleOrigin::Header
                                                      : RoleOrigin::Number;
    preview.columns.push_back({preview.head.names[i], role, from, {first.begin(), first.end()}, spread(values)});
  }
  preview.time = guess_time(preview.head.names, *roles,
                            [&](std::size_t i) { return std::span<const double>(preview.head.columns[i]); });
  preview.condition = guess_condition(preview);
  const bool readable = preview.problems.empty() && preview.head.rows() > 0;
  const double dt_s = readable ? view(request, preview) : 0.0;
  preview.hints = hints_of(request, preview, dt_s);
  return preview;
}

}  // namespace driftlab
