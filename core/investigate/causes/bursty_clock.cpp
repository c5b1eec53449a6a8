/// bursty_clock: samples arrive in bursts, and their stamps are those of the arrival: more than a fifth of the steps
/// are below a quarter of the mean step. The samples themselves are evenly spaced, at the mean step, and are taken so.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/recordings.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/process/random.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

std::vector<FaultyRecordings> find(const Study& study, const std::stop_token& /*stop*/) {
  FaultyRecordings fault;
  std::vector<std::size_t> recordings;
  std::vector<std::string> ids;
  double bursts = 0.0;
  double rows = 0.0;
  double lengths_square = 0.0;
  double seconds = 0.0;
  for (std::size_t r = 0; r < study.recordings.size(); ++r) {
    const StudyRecording& recording = study.recordings[r];
    const Bursts& seen = recording.stamps.bursts;
    if (seen.count == 0) {
      continue;
    }
    recordings.push_back(r);
    ids.push_back(recording.id);
    for (const Channel& channel : recording.channels) {
      if (!channel.input_only && !channel.error.empty()) {
        fault.channels.push_back(name_of(recording, channel));
      }
    }
    const auto count = static_cast<double>(seen.count);
    bursts += count;
    rows += count * seen.mean;
    lengths_square += count * (seen.deviation * seen.deviation + seen.mean * seen.mean);
    seconds += count * seen.mean * recording.dt_s;
  }
  if (recordings.empty()) {
    return {};
  }
  const double mean = rows / bursts;
  const double sd = std::sqrt(std::max(0.0, lengths_square / bursts - mean * mean) / bursts) + 1.0 / bursts;
  const double rate = rows / seconds;
  const double rate_sd = 2.0 * rate * mean / rows;  // a burst more or less at the ends
  fault.parameters = {{"burst", {mean, {mean - 1.96 * sd, mean + 1.96 * sd}}, units::one({})},
                      {"rate_hz", {rate, {rate - rate_sd, rate + rate_sd}}, units::hertz({})}};
  fault.sentence = list_of_names(ids) + ": samples arrive in bursts of " + in_digits(mean) +
                   " and are stamped on arrival. They are taken as evenly spaced at the measured rate of " +
                   in_digits(rate) + " Hz.";
  fault.mend = [recordings](Study& mended, std::deque<std::vector<double>>& /*rows*/) {
    for (const std::size_t r : recordings) {
      mended.recordings[r].stamps.scatter_s = 0.0;
      mended.recordings[r].stamps.repeated = 0;
    }
  };
  return {fault};
}

/// Bursts of the whole numbers next to the mean; each arrives with its last sample.
void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  const double dt = draft.recording->dt_s;
  const std::size_t n = draft.white.size();
  draft.stamp_error_s.assign(n, 0.0);
  for (std::size_t from = 0; from < n;) {
    const auto length = static_cast<std::size_t>(std::max(1.0, std::floor(values[0] + random.uniform())));
    const std::size_t last = std::min(n, from + length) - 1;
    for (std::size_t i = from; i <= last; ++i) {
      draft.stamp_error_s[i] = 0.99 * dt * static_cast<double>(last - i);
    }
    from = last + 1;
  }
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) { return {8.0, stage.rate_hz}; }

}  // namespace

Cause bursty_clock() {
  return {.name = "bursty_clock",
          .title = "samples that arrive in bursts and are stamped on arrival",
          .equation =
              "t(k) = the time of the last sample of the burst that sample k arrives in, samples taken at k / rate and "
              "burst of them "
              "arriving at a time",
          .family = RecordingFault{.find = find},
          .rivals = {"timestamp_jitter"},
          .needs = "a time column",
          .separates = "stamps from the sensor's own data-ready line",
          .parameters = {{"burst", units::one}, {"rate_hz", units::hertz}},
          .lacks = lacks_stamps,
          .inject = inject_effect,
          .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
