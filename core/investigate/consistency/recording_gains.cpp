#include "core/investigate/consistency/recording_gains.hpp"

#include "core/investigate/study/lattice.hpp"
#include "core/signal/angle.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace driftlab::investigate {
namespace {

constexpr double kKnown = 0.1;   ///< standard error of a gain that is looked at
constexpr double kRight = 0.1;   ///< a gain this near to 1 is right
constexpr double kSilent = 0.3;  ///< a gain this near to 0 does not see its own axis

/// One channel of one recording.
struct Seen {
  std::size_t recording = 0;
  std::size_t channel = 0;
  std::size_t axis = 0;
  Quantity quantity = Quantity::AngularRate;
  double mean = 0.0;                                 ///< [SI]
  double mean_sd = 0.0;                              ///< of the mean
  double noise = 0.0;                                ///< density of the sample-to-sample noise [SI sqrt(s)]
  double drive = 0.0;                                ///< mean of what drives its own axis [SI]
  bool still = false;                                ///< the recording is static
  std::vector<double> second;                        ///< means over a second
  std::array<std::vector<double>, 3> drive_seconds;  ///< what drives each axis, likewise
};

double median(std::vector<double> values) {
  if (values.empty()) {
    return 0.0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) {
    return *middle;
  }
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) {
    sum += v;
  }
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double square = 0.0;
  for (const double v : values) {
    square += (v - mean) * (v - mean);
  }
  return values.size() > 1 ? std::sqrt(square / static_cast<double>(values.size() - 1)) : 0.0;
}

/// From the median of the third differences' moduli, which neither motion nor gross values move; 0.6745 sqrt(20) of
/// Gaussian white noise.
double noise_density(const StudyRecording& recording, const Channel& channel) {
  constexpr std::size_t kMost = 200000;  // tell it to 0.3 %
  const std::size_t stride = recording.count() / kMost + 1;
  std::vector<double> third;
  const Series& y = channel.measured;
  for (std::size_t i = recording.begin + 3; i < recording.end; i += stride) {
    if (channel.valid[i] != 0 && channel.valid[i - 1] != 0 && channel.valid[i - 2] != 0 && channel.valid[i - 3] != 0) {
      third.push_back(std::fabs(y[i] - 3.0 * y[i - 1] + 3.0 * y[i - 2] - y[i - 3]));
    }
  }
  return third.size() < 50 ? 0.0 : median(std::move(third)) / 0.6745 / std::sqrt(20.0) * std::sqrt(recording.dt_s);
}

/// What drives the axis `k` of a quantity over the grid; empty: not known.
const Series& drive_of(const StudyRecording& recording, Quantity quantity, std::size_t k) {
  static const Series none;
  if (quantity == Quantity::AngularRate) {
    return recording.rate[k];
  }
  for (const Channel& channel : recording.channels) {
    if (channel.role.quantity == quantity && axis_index(channel.role.axis) == k) {
      return channel.reference;
    }
  }
  return none;
}

/// Of a channel that has an axis.
Seen look_at(const Study& study, std::size_t r, std::size_t c, const std::stop_token& stop) {
  const StudyRecording& recording = study.recordings[r];
  const Channel& channel = recording.channels[c];
  Seen seen;
  seen.recording = r;
  seen.channel = c;
  seen.quantity = channel.role.quantity;
  seen.axis = axis_index(channel.role.axis).value_or(0);
  seen.noise = noise_density(recording, channel);
  const double limit = clipped_at(channel) * std::fabs(channel.unit.factor);
  const auto block = static_cast<std::size_t>(std::max(1.0, std::round(1.0 / recording.dt_s)));
  for (std::size_t from = recording.begin; from + block <= recording.end && !stop.stop_requested(); from += block) {
    double sum = 0.0;
    double count = 0.0;
    std::array<double, 3> driven{};
    for (std::size_t i = from; i < from + block; ++i) {
      const bool clipped = limit > 0.0 && std::fabs(channel.measured[i]) > 0.999 * limit;
      if (channel.valid[i] == 0 || clipped) {
        continue;
      }
      sum += channel.measured[i];
      count += 1.0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& drive = drive_of(recording, seen.quantity, k);
        driven[k] += drive.empty() ? 0.0 : drive[i];
      }
    }
    if (count > 0.5 * static_cast<double>(block)) {
      seen.second.push_back(sum / count);
      for (std::size_t k = 0; k < 3; ++k) {
        seen.drive_seconds[k].push_back(driven[k] / count);
      }
    }
  }
  seen.mean = mean_of(seen.second);
  seen.mean_sd = deviation_of(seen.second) / std::sqrt(std::max(1.0, static_cast<double>(seen.second.size())));
  seen.drive = mean_of(seen.drive_seconds[seen.axis]);
  seen.still = recording.is_static();
  return seen;
}

bool driven(const Seen& seen, std::size_t axis) {
  const auto& drive = seen.drive_seconds[axis];
  return std::any_of(drive.begin(), drive.end(), [](double w) { return w != 0.0; });
}

struct Gain {
  double value = 0.0;
  double deviation = 1e300;
  bool explained = false;
};

/// Of a channel on the axis `onto`, by regression on all that varies.
Gain regressed_gain(const Seen& seen, std::size_t onto) {
  std::vector<std::size_t> axes;
  for (std::size_t k = 0; k < 3; ++k) {
    if (deviation_of(seen.drive_seconds[k]) > 0.0) {
      axes.push_back(k);
    }
  }
  const auto place = std::find(axes.begin(), axes.end(), onto);
  const auto n = static_cast<Eigen::Index>(seen.second.size());
  const auto width = static_cast<Eigen::Index>(axes.size() + 1);
  if (place == axes.end() || n < 20) {
    return {};
  }
  Eigen::MatrixXd x(n, width);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    x(i, 0) = 1.0;
    for (Eigen::Index k = 1; k < width; ++k) {
      x(i, k) = seen.drive_seconds[axes[static_cast<std::size_t>(k - 1)]][static_cast<std::size_t>(i)];
    }
    y(i) = seen.second[static_cast<std::size_t>(i)];
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(x);
  if (qr.rank() < width) {
    return {};
  }
  const Eigen::VectorXd fit = qr.solve(y);
  const double left = (y - x * fit).squaredNorm() / static_cast<double>(n - width);
  const Eigen::MatrixXd inverse = (x.transpose() * x).inverse();
  const Eigen::Index column = 1 + (place - axes.begin());
  const double moved = deviation_of(seen.drive_seconds[onto]);
  return {fit(column), std::sqrt(left * inverse(column, column)), std::sqrt(left) < 0.3 * moved};
}

/// What the channel shows where nothing drives it: the median over such recordings, or over all once the motion is
/// taken off; with its standard error.
std::pair<double, double> rest_of(const std::vector<Seen>& all, const Seen& seen) {
  std::vector<double> rest;
  std::vector<double> left;
  for (const Seen& other : all) {
    if (other.quantity != seen.quantity || other.axis != seen.axis) {
      continue;
    }
    if (!driven(other, seen.axis)) {
      rest.push_back(other.mean);
    } else {
      left.push_back(other.mean - other.drive);
    }
  }
  const std::vector<double>& used = rest.empty() ? left : rest;
  const double middle = median(used);
  std::vector<double> distance;
  for (const double v : used) {
    distance.push_back(std::fabs(v - middle));
  }
  // One recording alone says nothing about its own bias.
  const bool known = !rest.empty() || left.size() > 2;
  return {middle, known ? 1.4826 * median(distance) / std::sqrt(static_cast<double>(used.size())) : 1e300};
}

/// The gain of readings divided by `factor`.
Gain gain_on(const std::vector<Seen>& all, const Seen& seen, std::size_t onto, double factor = 1.0) {
  const double level = mean_of(seen.drive_seconds[onto]);
  const double spread = deviation_of(seen.drive_seconds[onto]);
  double largest = 0.0;
  for (const double w : seen.drive_seconds[onto]) {
    largest = std::max(largest, std::fabs(w));
  }
  if (spread > 0.1 * largest) {
    Gain gain = regressed_gain(seen, onto);
    gain.value /= factor;
    gain.deviation /= factor;
    return gain;
  }
  if (level == 0.0 || seen.second.size() < 5) {
    return {};
  }
  const auto [bias, bias_sd] = rest_of(all, seen);
  const double sd = std::hypot(seen.mean_sd / factor, bias_sd) / std::fabs(level);
  return {(seen.mean / factor - bias) / level, sd, deviation_of(seen.second) < 0.3 * std::fabs(level)};
}

/// Factors by which readings in one unit differ from those in another.
std::span<const double> unit_factors(Quantity quantity) {
  static const std::vector<double> rate{kDegree, 1.0 / kDegree, 3600.0, 1.0 / 3600.0, 60.0, 1.0 / 60.0, 1000.0, 1e-3};
  static const std::vector<double> force{kStandardGravity,          1.0 / kStandardGravity, 1000.0, 1e-3,
                                         1000.0 * kStandardGravity, 1e-3 / kStandardGravity};
  return quantity == Quantity::AngularRate ? rate : force;
}

/// The factor nearest to a ratio, if it is within `tolerance` of it.
std::optional<double> factor_near(Quantity quantity, double ratio, double tolerance) {
  std::optional<double> nearest;
  for (const double factor : unit_factors(quantity)) {
    const double off = std::fabs(ratio / factor - 1.0);
    if (off < tolerance && (!nearest || off < std::fabs(ratio / *nearest - 1.0))) {
      nearest = factor;
    }
  }
  return nearest;
}

/// Noise of the channel over the median of its other recordings; 0: not known.
double noise_ratio(const std::vector<Seen>& all, const Seen& seen) {
  std::vector<double> others;
  for (const Seen& other : all) {
    const bool same = other.quantity == seen.quantity && other.axis == seen.axis;
    if (same && other.recording != seen.recording && other.noise > 0.0) {
      others.push_back(other.noise);
    }
  }
  return others.size() > 1 && seen.noise > 0.0 ? seen.noise / median(others) : 0.0;
}

/// The factor by which the readings of a moving channel must be divided for a gain of 1. The noise, where others tell
/// it, carries the same factor.
std::optional<double> unit_of_motion(const std::vector<Seen>& all, const Seen& seen, double ratio) {
  // Chosen, not measured: units of one quantity differ by a factor of 9.8 and more, and 5 % leave room for a scale
  // factor.
  constexpr double kNear = 0.05;
  std::optional<double> nearest;
  double off = kNear;
  for (const double factor : unit_factors(seen.quantity)) {
    const Gain gain = gain_on(all, seen, seen.axis, factor);
    const bool noise_agrees = !(ratio > 0.0) || std::fabs(std::log(ratio / factor)) < std::log(1.5);
    if (noise_agrees && gain.deviation < 0.5 * kNear && std::fabs(gain.value - 1.0) < off) {
      off = std::fabs(gain.value - 1.0);
      nearest = factor;
    }
  }
  return nearest;
}

/// Another channel of the recording that sees what this one should see.
std::optional<std::pair<std::size_t, bool>> exchanged_with(const std::vector<Seen>& all, const Seen& seen) {
  for (const Seen& other : all) {
    if (other.recording != seen.recording || other.quantity != seen.quantity || other.channel == seen.channel) {
      continue;
    }
    const Gain gain = gain_on(all, other, seen.axis);
    if (gain.explained && gain.deviation < kKnown && std::fabs(std::fabs(gain.value) - 1.0) < kRight) {
      return std::pair{other.channel, gain.value < 0.0};
    }
  }
  return std::nullopt;
}

std::optional<DoubtfulRecording> judge(const std::vector<Seen>& all, const Seen& seen) {
  DoubtfulRecording doubt;
  doubt.recording = seen.recording;
  doubt.channel = seen.channel;
  const double ratio = noise_ratio(all, seen);
  if (!driven(seen, seen.axis)) {
    const auto factor = factor_near(seen.quantity, ratio, 0.12);
    if (seen.still && factor) {
      doubt.doubt = RecordingDoubt::OtherUnit;
      doubt.factor = *factor;
      return doubt;
    }
    return std::nullopt;
  }
  const Gain gain = gain_on(all, seen, seen.axis);
  doubt.factor = gain.value;
  doubt.deviation = gain.deviation;
  if (!(gain.deviation < kKnown) || std::fabs(gain.value - 1.0) < std::max(kRight, 5.0 * gain.deviation)) {
    return std::nullopt;
  }
  if (gain.explained && std::fabs(gain.value + 1.0) < kRight) {
    doubt.doubt = RecordingDoubt::TurnedSign;
    return doubt;
  }
  if (std::fabs(gain.value) < kSilent) {
    if (const auto other = exchanged_with(all, seen)) {
      doubt.doubt = RecordingDoubt::SwappedAxes;
      doubt.other = other->first;
      doubt.turned = other->second;
      return doubt;
    }
  }
  if (const auto factor = unit_of_motion(all, seen, ratio)) {
    doubt.doubt = RecordingDoubt::OtherUnit;
    doubt.factor = *factor;
    return doubt;
  }
  doubt.doubt = std::fabs(gain.value) < 0.1 ? RecordingDoubt::NoResponse : RecordingDoubt::OddGain;
  return doubt;
}

/// A gain that none of the known errors explains is odd only beside two recordings of the axis that are right.
bool others_are_right(const std::vector<Seen>& all, const Seen& seen) {
  const auto right = std::count_if(all.begin(), all.end(), [&](const Seen& other) {
    if (other.quantity != seen.quantity || other.axis != seen.axis || other.recording == seen.recording) {
      return false;
    }
    const Gain gain = gain_on(all, other, other.axis);
    return gain.deviation < kKnown && std::fabs(gain.value - 1.0) < kRight;
  });
  return right > 1;
}

/// Where an axis that moves shows another unit, the axes beside it that do not move share it if their noise does.
void share_units(const std::vector<Seen>& all, std::vector<DoubtfulRecording>& doubts) {
  const std::vector<DoubtfulRecording> shown = doubts;
  for (const Seen& seen : all) {
    const bool said = std::any_of(shown.begin(), shown.end(), [&](const DoubtfulRecording& d) {
      return d.recording == seen.recording && d.channel == seen.channel;
    });
    const auto beside = std::find_if(shown.begin(), shown.end(), [&](const DoubtfulRecording& d) {
      return d.recording == seen.recording && d.doubt == RecordingDoubt::OtherUnit;
    });
    if (said || seen.still || beside == shown.end()) {
      continue;
    }
    const double ratio = noise_ratio(all, seen);
    if (ratio > 0.0 && std::fabs(ratio / beside->factor - 1.0) < 0.3) {
      DoubtfulRecording same = *beside;
      same.channel = seen.channel;
      doubts.push_back(same);
    }
  }
}

}  // namespace

std::vector<DoubtfulRecording> doubtful_recordings(const Study& study, const std::stop_token& stop) {
  std::vector<Seen> all;
  for (std::size_t r = 0; r < study.recordings.size(); ++r) {
    const StudyRecording& recording = study.recordings[r];
    for (std::size_t c = 0; c < recording.channels.size(); ++c) {
      const Channel& channel = recording.channels[c];
      const bool rate = channel.role.quantity == Quantity::AngularRate && !channel.error.empty();
      const bool force = channel.role.quantity == Quantity::SpecificForce && !channel.reference.empty();
      if (axis_index(channel.role.axis) && (rate || force)) {
        all.push_back(look_at(study, r, c, stop));
      }
    }
  }
  std::vector<DoubtfulRecording> doubts;
  for (const Seen& seen : all) {
    if (stop.stop_requested()) {
      return {};
    }
    const auto doubt = judge(all, seen);
    if (!doubt) {
      continue;
    }
    const bool unnamed = doubt->doubt == RecordingDoubt::NoResponse || doubt->doubt == RecordingDoubt::OddGain;
    // Of two exchanged channels the second says the same as the first.
    const bool said = std::any_of(doubts.begin(), doubts.end(), [&](const DoubtfulRecording& d) {
      return d.doubt == RecordingDoubt::SwappedAxes && d.recording == doubt->recording && d.other == doubt->channel;
    });
    if (!said && (!unnamed || others_are_right(all, seen))) {
      doubts.push_back(*doubt);
    }
  }
  share_units(all, doubts);
  return doubts;
}

}  // namespace driftlab::investigate
