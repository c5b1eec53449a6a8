#include "core/investigate/causes/clock_faults.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/recordings.hpp"
#include "core/investigate/causes/units.hpp"

#include <cmath>

namespace driftlab::investigate {

std::vector<FaultyRecordings> clock_faults(const Study& study, ClockBreak kind, const std::string& parameter,
                                           const LabUnit& unit, const std::stop_token& stop) {
  std::vector<FaultyRecordings> faults;
  for (std::size_t r = 0; r < study.recordings.size() && !stop.stop_requested(); ++r) {
    const auto found = find_clock_fault(study, r);
    if (!found || found->kind != kind) {
      continue;
    }
    const StudyRecording& recording = study.recordings[r];
    FaultyRecordings fault;
    for (const std::size_t c : found->channels) {
      fault.channels.push_back(name_of(recording, recording.channels[c]));
    }
    fault.parameters = {{parameter, found->size, unit}, {"t0_s", found->t0_s, units::seconds({})}};
    fault.sentence = recording.id + ": from " + in_digits(found->t0_s.value) + " s on the sensor's clock ";
    fault.sentence.append(kind == ClockBreak::Jump ? "is another by " : "runs at another rate, by ");
    fault.sentence.append(in_digits(found->size.value * unit.per_si)).append(" ").append(unit.symbol);
    fault.sentence.append(", against the reference. What follows is beside the reference on the sensor's clock.");
    fault.mend = [found = *found](Study& mended, std::deque<std::vector<double>>& rows) {
      StudyRecording& faulty = mended.recordings[found.recording];
      move_reference(faulty, reading_times(faulty, found.kind, found.size.value, found.t0_s.value));
      if (found.kind == ClockBreak::Jump) {  // on which side of it a sample lies is known but for the interval of t0
        std::vector<unsigned char> gone(faulty.length, 0);
        for (std::size_t i = 0; i < gone.size(); ++i) {
          const double t = faulty.time_s(i);
          gone[i] = t >= found.t0_s.ci95.low && t <= found.t0_s.ci95.high ? 1 : 0;
        }
        leave_out(faulty, gone, rows);
      }
    };
    faults.push_back(std::move(fault));
  }
  return faults;
}

void inject_clock_break(Draft& draft, ClockBreak kind, std::span<const double> values) {
  const StudyRecording& recording = *draft.recording;
  const std::vector<double> rate = recording.rate[draft.group->axis()].values();
  if (rate.empty()) {
    return;
  }
  const std::vector<double> read = read_at(rate, recording.dt_s, reading_times(recording, kind, values[0], values[1]));
  for (std::size_t i = 0; i < draft.mean.size(); ++i) {
    draft.mean[i] += read[i] - rate[i];
  }
}

std::vector<double> shown_clock_break(const Stage& stage, ClockBreak kind) {
  const StudyRecording& recording = stage.study.recordings.at(1);
  double information = 0.0;
  const double t0_s = 0.5 * recording.time_s(recording.length);
  for (std::size_t i = recording.length / 2; i < recording.length; ++i) {
    const double since = kind == ClockBreak::Jump ? 1.0 : recording.time_s(i) - t0_s;
    const double effect = recording.acceleration[2][i] * since;
    information += effect * effect;
  }
  return {1.5 * stage.z * stage.white_sd() / std::sqrt(information), t0_s};
}

}  // namespace driftlab::investigate
