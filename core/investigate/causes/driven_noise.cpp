#include "core/investigate/causes/driven_noise.hpp"

#include "core/investigate/causes/draft.hpp"
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/fullrate/modulation.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

std::size_t axis_of(const ChannelGroup& group) {
  return group.role.quantity == Quantity::AngularRate ? group.axis() : 2;
}

}  // namespace

std::vector<Evidence> examine_driven(const FullRate& data, Driver driver, LabUnit (*unit)(const Unit&)) {
  const Modulation levels = modulation_of(
      data, [&](const StudyRecording& recording, std::size_t axis) { return &(recording.*driver)[axis]; });
  if (levels.distinct < 2) {
    return {};
  }
  const ModulationFit fit = fit_modulation(levels, data.given, 1.0 / levels.largest, [&](double u, double k) {
    const double factor = 1.0 + std::max(0.0, k) * u;
    return 1.0 + data.white_share * (factor * factor - 1.0);
  });
  if (fit.value <= 0.0) {
    return {};
  }
  const Interval interval = widened(fit, data);
  Evidence evidence;
  evidence.members = all_members(*data.group);
  evidence.gain = fit.gain;
  evidence.score = fit.gain / data.repeatability - 1.0;
  evidence.shape = fit.value;
  evidence.parameters = {{"k", {fit.value, {std::max(0.0, interval.low), interval.high}}, unit(data.group->unit)}};
  return {evidence};
}

void driven_deviation(const FullRate& data, const Evidence& found, std::size_t r, Driver driver,
                      std::vector<double>& sd) {
  const StudyRecording& recording = *data.group->members[r].recording;
  const Series& u = (recording.*driver)[axis_of(*data.group)];
  sd.assign(data.innovation[r].size(), 1.0);
  for (std::size_t i = 0; i < sd.size() && !u.empty(); ++i) {
    const double factor = 1.0 + found.shape * std::fabs(u[recording.begin + i]);
    sd[i] = std::sqrt(1.0 + data.white_share * (factor * factor - 1.0));
  }
}

void inject_driven(Draft& draft, double k, Driver driver) {
  const Series& u = (draft.recording->*driver)[axis_of(*draft.group)];
  for (std::size_t i = 0; i < u.size(); ++i) {
    draft.white[i] *= 1.0 + k * std::fabs(u[i]);
  }
}

double shown_driven(const Stage& stage, Driver driver) {
  double sum = 0.0;
  double square = 0.0;
  double count = 0.0;
  for (const StudyRecording& recording : stage.study.recordings) {
    for (const double v : (recording.*driver)[2]) {
      sum += std::fabs(v);
      square += v * v;
      count += 1.0;
    }
  }
  return stage.z / std::sqrt(2.0 * (stage.given ? square : square - sum * sum / count));
}

}  // namespace driftlab::investigate
