#include "core/investigate/study/reference_quality.hpp"

#include "core/investigate/study/measured_constants.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace driftlab::investigate {
namespace {

/// Reference and channel as means over about a second.
struct Means {
  std::vector<double> measured, reference;
  double samples = 1.0;  ///< in a mean
};

Means second_means(const StudyRecording& recording, const Channel& channel) {
  Means means;
  const auto block = static_cast<std::size_t>(std::max(1.0, std::round(1.0 / recording.dt_s)));
  means.samples = static_cast<double>(block);
  for (std::size_t from = recording.begin; from + block <= recording.end; from += block) {
    double measured = 0.0;
    double reference = 0.0;
    for (std::size_t i = from; i < from + block; ++i) {
      measured += channel.measured[i] / means.samples;
      reference += channel.reference[i] / means.samples;
    }
    means.measured.push_back(measured);
    means.reference.push_back(reference);
  }
  return means;
}

double centred_product(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  double mean_a = 0.0;
  double mean_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / n;
    mean_b += b[i] / n;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - mean_a) * (b[i] - mean_b) / n;
  }
  return sum;
}

}  // namespace

double noise_of_third_differences(const Series& values, std::size_t begin, std::size_t end) {
  // The variance of third differences of white noise over its own.
  constexpr double kGain = 1.0 + 9.0 + 9.0 + 1.0;
  if (end < begin + 8) {
    return 0.0;
  }
  double square = 0.0;
  for (std::size_t i = begin + 3; i < end; ++i) {
    const double d = values[i] - 3.0 * values[i - 1] + 3.0 * values[i - 2] - values[i - 3];
    square += d * d;
  }
  return std::sqrt(square / kGain / static_cast<double>(end - begin - 3));
}

bool stamps_are_loose(const ChannelGroup& group) {
  return std::any_of(group.members.begin(), group.members.end(), [](const ChannelGroup::Member& member) {
    const Stamps& stamps = member.recording->stamps;
    return !member.channel->reference.empty() && stamps.present &&
           stamps.scatter_s > kLooseStamps * member.recording->dt_s;
  });
}

std::string reference_lacks(const ChannelGroup& group) {
  if (stamps_are_loose(group)) {
    return std::string(kTightStamps);
  }
  const bool noisy = std::any_of(group.members.begin(), group.members.end(), [](const ChannelGroup::Member& member) {
    const StudyRecording& recording = *member.recording;
    const Channel& channel = *member.channel;
    return !channel.reference.empty() &&
           noise_of_third_differences(channel.reference, recording.begin, recording.end) >
               noise_of_third_differences(channel.measured, recording.begin, recording.end);
  });
  return noisy ? "a reference of less noise than the channel's own" : "";
}

std::string why_reference_misleads(const ChannelGroup& group) {
  // Times the noise of a mean over a second: the motion must be so much larger for its reference to be judged. Chosen,
  // not measured.
  constexpr double kBeyondNoise = 30.0;
  for (const ChannelGroup::Member& member : group.members) {
    const StudyRecording& recording = *member.recording;
    const Channel& channel = *member.channel;
    if (channel.reference.empty()) {
      continue;
    }
    const Means means = second_means(recording, channel);
    if (means.reference.size() < 20) {
      continue;
    }
    const double noise = noise_of_third_differences(channel.measured, recording.begin, recording.end);
    const double moved = std::sqrt(centred_product(means.reference, means.reference));
    if (moved < kBeyondNoise * noise / std::sqrt(means.samples)) {
      continue;
    }
    const double spread = std::sqrt(centred_product(means.measured, means.measured));
    const double correlation = spread > 0.0 ? centred_product(means.measured, means.reference) / (moved * spread) : 0.0;
    if (correlation < kLeastCorrelation) {
      char text[160];
      (void)std::snprintf(text, sizeof text, "it does not follow its reference in %s (correlation of 1 s means %.2f)",
                          recording.id.c_str(), correlation);
      return text;
    }
  }
  return "";
}

}  // namespace driftlab::investigate
