#include "core/datasheet/plausible_units.hpp"

#include "core/signal/angle.hpp"
#include "core/signal/median.hpp"
#include "core/signal/number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace driftlab {
namespace {

constexpr std::size_t kFewest = 64;     ///< samples
constexpr std::size_t kLengths = 4096;  ///< at so many places |f| is looked at
constexpr std::size_t kFewestMeans = 20;
constexpr double kMeanOver = 0.5;       ///< [s]
constexpr double kGravityWithin = 1.1;  ///< factor
constexpr double kClearlyOff = 8.0;     ///< ratio of noise that no sensor of the model shows at rest
constexpr double kNoiseWithin = 2.5;

/// A unit that readings may be in.
struct Candidate {
  std::string name;
  double factor = 1.0;  ///< SI in one of it
};

/// What readings of that quantity may be in, beside the unit that is said: units, and counts of the sensor.
std::vector<Candidate> candidates(Quantity quantity, const Unit& said, const std::optional<KnownSensor>& sensor) {
  std::vector<Candidate> all;
  if (quantity == Quantity::AngularRate) {
    all = {{"rad/s", 1.0}, {"deg/s", kDegree}, {"mdeg/s", kDegree * 1e-3}};
  } else {
    all = {{"m/s^2", 1.0}, {"g", kStandardGravity}, {"mg", kStandardGravity * 1e-3}};
  }
  if (sensor) {
    const auto unit = parse_unit(sensor->sensor->unit);
    for (const FullScale& scale : sensor->sensor->scales) {
      if (unit && scale.per_count) {
        all.push_back({"counts of the range of " + short_text(scale.limit) + " " + unit->symbol,
                       *scale.per_count * unit->factor});
      }
    }
  }
  std::erase_if(all, [&](const Candidate& one) { return std::fabs(std::log(one.factor / said.factor)) < 1e-6; });
  return all;
}

/// The candidate that brings `ratio`, found with the unit that is said, closest to 1; nothing beyond `within`.
std::optional<Candidate> explains(const std::vector<Candidate>& all, const Unit& said, double ratio, double within) {
  std::optional<Candidate> best;
  double least = std::log(within);
  for (const Candidate& one : all) {
    const double off = std::fabs(std::log(ratio * one.factor / said.factor));
    if (off < least) {
      least = off;
      best = one;
    }
  }
  return best;
}

/// Median of |f| over the series, in the unit of the channels.
double median_length(const std::array<const ObservedChannel*, 3>& axes) {
  std::size_t count = axes[0]->samples.size();
  for (const ObservedChannel* const axis : axes) {
    count = std::min(count, axis->samples.size());
  }
  const std::size_t step = std::max<std::size_t>(1, count / kLengths);
  std::vector<double> lengths;
  for (std::size_t i = 0; i < count; i += step) {
    lengths.push_back(std::hypot(axes[0]->samples[i], axes[1]->samples[i], axes[2]->samples[i]));
  }
  return take_median(lengths);
}

void check_gravity(std::span<const ObservedChannel> channels, std::span<const std::string> hardware,
                   std::vector<std::string>& notes) {
  std::array<const ObservedChannel*, 3> axes{};
  for (const ObservedChannel& channel : channels) {
    if (channel.quantity == Quantity::SpecificForce && channel.samples.size() >= kFewest && channel.axis.size() == 1 &&
        channel.axis >= "x" && channel.axis <= "z") {
      axes[static_cast<std::size_t>(channel.axis.front() - 'x')] = &channel;
    }
  }
  if (axes[0] == nullptr || axes[1] == nullptr || axes[2] == nullptr || !(axes[0]->unit == axes[1]->unit) ||
      !(axes[0]->unit == axes[2]->unit) || axes[0]->unit.dimension != Dimension::SpecificForce) {
    return;
  }
  const Unit& said = axes[0]->unit;
  const double length = median_length(axes);
  const double ratio = length * said.factor / kStandardGravity;
  if (!(ratio > 0.0) || std::fabs(std::log(ratio)) < std::log(kGravityWithin)) {
    return;
  }
  const auto sensor = known_sensor(hardware, Quantity::SpecificForce);
  const auto unit = explains(candidates(Quantity::SpecificForce, said, sensor), said, ratio, kGravityWithin);
  if (unit) {
    notes.push_back("At rest the length of (" + axes[0]->column + ", " + axes[1]->column + ", " + axes[2]->column +
                    ") is " + short_text(length) + " " + said.symbol + ", where gravity is " +
                    short_text(kStandardGravity / said.factor) + " " + said.symbol + ": these columns look like " +
                    unit->name + ". Correct their unit.");
  }
}

/// N by the Allan deviation at about half a second [unit/sqrt(Hz)]; nothing where the series is short or stands still.
std::optional<double> robust_density(std::span<const double> samples, double dt_s) {
  if (samples.size() < kFewest || !(dt_s > 0.0)) {
    return std::nullopt;
  }
  const std::size_t most = samples.size() / kFewestMeans;
  const double wanted = std::min(kMeanOver / dt_s, static_cast<double>(most));
  const auto length = static_cast<std::size_t>(std::max(1.0, std::round(wanted)));
  std::vector<double> steps;
  std::optional<double> before;
  for (std::size_t first = 0; first + length <= samples.size(); first += length) {
    double sum = 0.0;
    for (const double sample : samples.subspan(first, length)) {
      sum += sample;
    }
    const double mean = sum / static_cast<double>(length);
    if (before) {
      steps.push_back(std::fabs(mean - *before));
    }
    before = mean;
  }
  // The median of |x| of a normal x is 0.6745 of its deviation; a difference of two means has sqrt(2) of one.
  const double deviation = take_median(steps) / 0.6745 / std::numbers::sqrt2;
  const double density = deviation * std::sqrt(static_cast<double>(length) * dt_s);
  return density > 0.0 ? std::optional(density) : std::nullopt;
}

void check_noise(const ObservedChannel& channel, double dt_s, const KnownSensor& sensor,
                 std::vector<std::string>& notes) {
  const auto stated = stated_density_si(*sensor.sensor, channel.axis);
  const auto density = robust_density(channel.samples, dt_s);
  if (!stated || !density) {
    return;
  }
  const double ratio = *density * channel.unit.factor / *stated;
  if (std::fabs(std::log(ratio)) < std::log(kClearlyOff)) {
    return;
  }
  const auto unit = explains(candidates(channel.quantity, channel.unit, sensor), channel.unit, ratio, kNoiseWithin);
  if (unit) {
    notes.push_back(
        "The noise of column '" + channel.column + "' at rest is " +
        (ratio > 1.0 ? short_text(std::round(ratio)) + " times" : "1/" + short_text(std::round(1.0 / ratio)) + " of") +
        " what the data sheet of the " + std::string(sensor.sheet->name) + " states: this column looks like " +
        unit->name + ", not " + channel.unit.symbol + ". Correct its unit.");
  }
}

void check_range(const ObservedChannel& channel, const KnownSensor& sensor, std::vector<std::string>& notes) {
  const auto unit = parse_unit(sensor.sensor->unit);
  if (!unit || sensor.sensor->scales.empty()) {
    return;
  }
  double reach = 0.0;
  for (const double sample : channel.samples) {
    reach = std::max(reach, std::fabs(sample));
  }
  // Many sensors count some per cent beyond the range they state.
  const double limit = sensor.sensor->scales.back().limit * unit->factor;
  if (reach * channel.unit.factor > 1.25 * limit) {
    notes.push_back("Column '" + channel.column + "' reaches " + short_text(reach) + " " + channel.unit.symbol +
                    ", but the largest range of the " + std::string(sensor.sheet->name) + " is " +
                    short_text(sensor.sensor->scales.back().limit) + " " + unit->symbol + ": its unit is not " +
                    channel.unit.symbol + ", or the device is another.");
  }
}

}  // namespace

std::vector<std::string> unit_notes(std::span<const ObservedChannel> channels, double dt_s, bool at_rest,
                                    std::span<const std::string> hardware) {
  std::vector<std::string> notes;
  if (at_rest) {
    check_gravity(channels, hardware, notes);
  }
  for (const ObservedChannel& channel : channels) {
    const auto sensor = known_sensor(hardware, channel.quantity);
    const Dimension dimension =
        channel.quantity == Quantity::AngularRate ? Dimension::AngularRate : Dimension::SpecificForce;
    if (!sensor || channel.unit.dimension != dimension) {
      continue;
    }
    const std::size_t before = notes.size();
    if (at_rest && channel.quantity == Quantity::AngularRate) {
      check_noise(channel, dt_s, *sensor, notes);
    }
    if (notes.size() == before) {
      check_range(channel, *sensor, notes);
    }
  }
  return notes;
}

}  // namespace driftlab
