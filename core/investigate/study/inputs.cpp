#include "core/investigate/study/inputs.hpp"

#include "core/investigate/study/reference_quality.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {

double longest_s(const ChannelGroup& group) {
  double longest = 0.0;
  for (const auto& member : group.members) {
    longest = std::max(longest, member.recording->time_s(member.recording->count()));
  }
  return longest;
}

bool turns_about(const ChannelGroup& group, std::size_t k) {
  for (const auto& member : group.members) {
    for (const double w : member.recording->rate[k]) {
      if (w != 0.0) {
        return true;
      }
    }
  }
  return false;
}

bool follow_rate(const StudyRecording& recording, const ChannelGroup& group, std::vector<std::vector<double>>& columns,
                 const std::function<double(double)>& f) {
  const Series& rate = recording.rate[group.axis()];
  if (rate.empty() || group.role.quantity != Quantity::AngularRate || group.role.axis.empty()) {
    return false;
  }
  columns.assign(1, std::vector<double>(rate.size()));
  std::transform(rate.begin(), rate.end(), columns[0].begin(), f);
  return true;
}

bool follow_slope(const StudyRecording& recording, const ChannelGroup& group, std::vector<std::vector<double>>& columns,
                  const std::function<double(double, double)>& f) {
  const Series& slope = recording.acceleration[group.axis()];
  if (slope.empty() || group.role.quantity != Quantity::AngularRate || group.role.axis.empty()) {
    return false;
  }
  columns.assign(1, std::vector<double>(slope.size(), 0.0));
  if (recording.condition.kind == ConditionKind::Profile || recording.condition.kind == ConditionKind::Drive) {
    for (std::size_t i = 0; i < slope.size(); ++i) {
      columns[0][i] = f(recording.time_s(i), slope[i]);
    }
  }
  return true;
}

std::vector<double> running_variance(const Series& values, double window) {
  const std::size_t n = values.size();
  const auto half = static_cast<std::size_t>(std::max(1.0, std::round(0.5 * window)));
  double mean = 0.0;
  for (const double v : values) {
    mean += v;
  }
  mean /= static_cast<double>(n);
  // Running sums up to each place, of which those of a window are kept.
  const std::size_t kept = std::min(2 * half, n) + 1;
  std::vector<double> sum(kept, 0.0);
  std::vector<double> square(kept, 0.0);
  std::size_t summed = 0;
  std::vector<double> variance(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t from = i > half ? i - half : 0;
    const std::size_t to = std::min(n, i + half);
    for (; summed < to; ++summed) {
      const double v = values[summed] - mean;
      sum[(summed + 1) % kept] = sum[summed % kept] + v;
      square[(summed + 1) % kept] = square[summed % kept] + v * v;
    }
    const auto count = static_cast<double>(to - from);
    const double m = (sum[to % kept] - sum[from % kept]) / count;
    variance[i] = std::max(0.0, (square[to % kept] - square[from % kept]) / count - m * m);
  }
  return variance;
}

namespace {

bool turns_about_own_axis(const ChannelGroup& group) {
  return group.role.quantity == Quantity::AngularRate && !group.role.axis.empty() && turns_about(group, group.axis());
}

}  // namespace

std::string lacks_rotation(const Study& /*study*/, const ChannelGroup& group) {
  return turns_about_own_axis(group) ? reference_lacks(group) : "rotation about the gyroscope's axis";
}

std::string lacks_profile(const Study& /*study*/, const ChannelGroup& group) {
  if (stamps_are_loose(group)) {
    return std::string(kTightStamps);
  }
  for (const auto& member : group.members) {
    const ConditionKind kind = member.recording->condition.kind;
    if ((kind == ConditionKind::Profile || kind == ConditionKind::Drive) && turns_about_own_axis(group)) {
      return "";
    }
  }
  return "a motion profile with a reference column";
}

std::string lacks_force(const Study& /*study*/, const ChannelGroup& group) {
  if (group.role.quantity == Quantity::AngularRate && !group.role.axis.empty()) {
    for (const auto& member : group.members) {
      if (!member.recording->force[group.axis()].empty()) {
        return "";
      }
    }
  }
  return "a specific-force column along the gyroscope's axis";
}

std::string lacks_stamps(const Study& /*study*/, const ChannelGroup& group) {
  const bool any = std::any_of(group.members.begin(), group.members.end(),
                               [](const auto& member) { return member.recording->stamps.present; });
  return any ? "" : "a time column";
}

std::string lacks_axes(const Study& study, const ChannelGroup& group) {
  for (const StudyRecording& recording : study.recordings) {
    const auto axes = std::count_if(recording.channels.begin(), recording.channels.end(), [&](const Channel& channel) {
      return channel.role.quantity == group.role.quantity && !channel.error.empty() && !channel.input_only;
    });
    if (axes > 1) {
      return "";
    }
  }
  return "several axes recorded together";
}

std::string lacks_recordings(const Study& /*study*/, const ChannelGroup& group) {
  return group.members.size() > 2 ? "" : "three recordings or more";
}

std::string lacks_rates(const Study& /*study*/, const ChannelGroup& group) {
  if (stamps_are_loose(group)) {
    return std::string(kTightStamps);
  }
  return turns_about(group, group.axis()) ? "" : "several rates or a profile";
}

std::string lacks_slopes(const Study& /*study*/, const ChannelGroup& group) {
  if (stamps_are_loose(group)) {
    return std::string(kTightStamps);
  }
  for (const auto& member : group.members) {
    for (const double a : member.recording->acceleration[group.axis()]) {
      if (a != 0.0) {
        return "";
      }
    }
  }
  return "several accelerations or a profile";
}

std::string lacks_contrast(const Study& study, const ChannelGroup& group) {
  const bool shown = !study.baseline.automatic || group.members.size() > 1;
  return shown ? "" : "a second recording, or a given baseline";
}

std::string lacks_motion(const Study& study, const ChannelGroup& group) {
  const auto moving = static_cast<std::size_t>(std::count_if(
      group.members.begin(), group.members.end(), [](const auto& member) { return !member.recording->is_static(); }));
  const bool shown = !study.baseline.automatic || (moving > 0 && moving < group.members.size());
  return shown ? "" : "recordings at rest and in motion, or a given baseline";
}

}  // namespace driftlab::investigate
