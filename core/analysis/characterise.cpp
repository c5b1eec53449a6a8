#include "core/analysis/characterise.hpp"

#include "core/analysis/unit_notes.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {

Result<CharacterisedRecording> characterise_recording(const RecordingSpec& spec, RecordingView view,
                                                      const Calibration& calibration,
                                                      const CharacteriseOptions& options, const RunControl& control) {
  if (auto applied = apply_calibration(calibration, view); !applied) {
    return fail(applied.error());
  }
  std::vector<ReferenceAlignment> alignments = align_references(view);
  CharacterisedRecording found{spec, {}, {}, {}};
  const auto count = static_cast<double>(view.channels.size());
  for (const ChannelView& channel : view.channels) {
    const auto done = static_cast<double>(found.channels.size());
    const RunControl part = control.reporting([&](std::string_view stage, double fraction) {
      control.report(channel.column + ": " + std::string(stage), (done + fraction) / count);
    });
    const double factor = channel.role.unit ? channel.role.unit->factor : 1.0;
    auto result = characterise_channel({channel.values, view.window.time.dt_s, factor, channel.gaps}, options, part);
    if (!result) {
      return fail(Error(result.error()).with("column", channel.column));
    }
    const auto aligned = std::find_if(alignments.begin(), alignments.end(), [&](const ReferenceAlignment& alignment) {
      return alignment.channel == channel.column;
    });
    found.channels.push_back({channel.column, channel.role, std::move(*result), std::nullopt});
    if (aligned != alignments.end()) {
      found.channels.back().reference = std::move(*aligned);
    }
  }
  found.window = std::move(view.window);
  return found;
}

Result<std::vector<CharacterisedRecording>> characterise(RecordingSource& recordings,
                                                         const CharacteriseOptions& options,
                                                         const RunControl& control) {
  std::vector<CharacterisedRecording> found;
  const auto count = static_cast<double>(recordings.count());
  const auto one = [&](std::size_t i) -> Result<CharacterisedRecording> {
    const double opened = recordings.opening_share();
    const RunControl part = part_of(control, static_cast<double>(i) / count, static_cast<double>(i + 1) / count);
    auto recording = recordings.open(i, part_of(part, 0.0, opened));
    if (!recording) {
      return fail(recording.error());
    }
    auto view = view_of(*recording);
    if (!view) {
      return fail(view.error());
    }
    add_unit_notes(*view, recording->columns, recording->spec, recording->hardware);
    auto calibration = recordings.calibration(i);
    if (!calibration) {
      return fail(calibration.error());
    }
    auto temperature = measured_temperature(recording->spec, recording->columns.names(), *view,
                                            [&](std::size_t k) { return recording->columns.column(k); });
    auto found_one =
        characterise_recording(recording->spec, std::move(*view), *calibration, options, part_of(part, opened, 1.0));
    if (found_one) {
      found_one->temperature = std::move(temperature);
      found_one->device = recording->device;
    }
    return found_one;
  };
  for (std::size_t i = 0; i < recordings.count(); ++i) {
    auto recording = one(i);
    if (!recording) {
      return fail(recordings.located(i, recording.error()));
    }
    found.push_back(std::move(*recording));
  }
  return found;
}

std::vector<Remark> remarks_of(const std::vector<CharacterisedRecording>& recordings) {
  std::vector<Remark> remarks;
  for (const CharacterisedRecording& recording : recordings) {
    for (const std::string& note : recording.window.quality.notes) {
      remarks.push_back({recording.spec.id, note});
    }
    for (const CharacterisedChannel& channel : recording.channels) {
      for (const std::string& warning : channel.result.warnings) {
        remarks.push_back({recording.spec.id + ", " + channel.column, warning});
      }
    }
  }
  return remarks;
}

std::vector<SensorSources> sensors_of(const std::vector<CharacterisedRecording>& recordings,
                                      const ResultName& result_name) {
  std::vector<SensorSources> sensors;
  for (const CharacterisedRecording& recording : recordings) {
    for (const CharacterisedChannel& channel : recording.channels) {
      add_source(sensors, {recording.spec.id, to_text(without_heading(recording.spec.condition)),
                           reported(channel.column, channel.role, channel.result),
                           result_name ? result_name(recording.spec.id, channel.column) : std::string(),
                           frozen_samples(recording.window.quality, channel.column)});
    }
  }
  return sensors;
}

}  // namespace driftlab
