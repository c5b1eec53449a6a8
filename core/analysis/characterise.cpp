#include "core/analysis/characterise.hpp"

#include "core/analysis/unit_notes.hpp"

#include <algorithm>
#include <atomic>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

/// Channels of recordings of at most so many rows are characterised side by side: each takes its memory.
constexpr std::size_t kMostRowsSideBySide = 400'000;

}  // namespace

Result<PreparedRecording> PreparedRecording::make(const RecordingSpec& spec, RecordingView view,
                                                  const Calibration& calibration) {
  if (auto applied = apply_calibration(calibration, view); !applied) {
    return fail(applied.error());
  }
  PreparedRecording prepared;
  prepared.alignments_ = align_references(view);
  prepared.frame_.spec = spec;
  prepared.frame_.window = view.window;
  prepared.view_ = std::move(view);
  return prepared;
}

Result<PreparedRecording> PreparedRecording::open(RecordingSource& recordings, std::size_t index,
                                                  const RunControl& control) {
  const auto opened = [&]() -> Result<PreparedRecording> {
    auto recording = recordings.open(index, control);
    if (!recording) {
      return fail(recording.error());
    }
    auto view = view_of(*recording);
    if (!view) {
      return fail(view.error());
    }
    add_unit_notes(*view, recording->columns, recording->spec, recording->hardware);
    auto calibration = recordings.calibration(index);
    if (!calibration) {
      return fail(calibration.error());
    }
    auto temperature = measured_temperature(recording->spec, recording->columns.names(), *view,
                                            [&](std::size_t k) { return recording->columns.column(k); });
    auto prepared = make(recording->spec, std::move(*view), *calibration);
    if (prepared) {
      prepared->frame_.temperature = std::move(temperature);
      prepared->frame_.device = recording->device;
      prepared->columns_ = std::move(recording->columns);
    }
    return prepared;
  };
  auto prepared = opened();
  return prepared ? std::move(prepared) : fail(recordings.located(index, prepared.error()));
}

Result<CharacterisedChannel> PreparedRecording::characterise(std::size_t channel, const CharacteriseOptions& options,
                                                             const RunControl& control) const {
  const ChannelView& seen = view_.channels[channel];
  const RunControl part = control.reporting([&](std::string_view stage, double fraction) {
    control.report(seen.column + ": " + std::string(stage), fraction);
  });
  const double factor = seen.role.unit ? seen.role.unit->factor : 1.0;
  auto result = characterise_channel({seen.values, view_.window.time.dt_s, factor, seen.gaps}, options, part);
  if (!result) {
    return fail(Error(result.error()).with("column", seen.column));
  }
  const auto aligned = std::find_if(alignments_.begin(), alignments_.end(), [&](const ReferenceAlignment& alignment) {
    return alignment.channel == seen.column;
  });
  return CharacterisedChannel{seen.column, seen.role, std::move(*result),
                              aligned != alignments_.end() ? std::optional(*aligned) : std::nullopt};
}

Result<CharacterisedRecording> characterise_recording(const PreparedRecording& recording,
                                                      const CharacteriseOptions& options, const RunControl& control) {
  const std::size_t count = recording.channels();
  std::vector<std::optional<Result<CharacterisedChannel>>> channels(count);
  std::atomic<std::size_t> done{0};
  const auto caller = std::this_thread::get_id();  // of the threads that share the channels it alone reports
  const auto characterise_one = [&](std::size_t c) {
    const RunControl part = control.reporting([&](std::string_view stage, double fraction) {
      if (std::this_thread::get_id() == caller) {
        control.report(stage, (static_cast<double>(done) + fraction) / static_cast<double>(count));
      }
    });
    channels[c] = recording.characterise(c, options, part);
    ++done;
  };
  const bool side_by_side = recording.frame().window.count <= kMostRowsSideBySide;
  parallel_for(side_by_side ? control.threads : ThreadShare{}, count, characterise_one, control.stop);
  CharacterisedRecording found = recording.frame();
  for (std::optional<Result<CharacterisedChannel>>& channel : channels) {
    if (!channel) {
      return fail(ErrorCode::Cancelled, "The characterisation was cancelled.");
    }
    if (!*channel) {
      return fail(channel->error());
    }
    found.channels.push_back(std::move(**channel));
  }
  return found;
}

Result<std::vector<CharacterisedRecording>> characterise(RecordingSource& recordings,
                                                         const CharacteriseOptions& options,
                                                         const RunControl& control) {
  std::vector<CharacterisedRecording> found;
  const auto count = static_cast<double>(recordings.count());
  for (std::size_t i = 0; i < recordings.count(); ++i) {
    const double opened = recordings.opening_share();
    const RunControl part = part_of(control, static_cast<double>(i) / count, static_cast<double>(i + 1) / count);
    const auto prepared = PreparedRecording::open(recordings, i, part_of(part, 0.0, opened));
    if (!prepared) {
      return fail(prepared.error());
    }
    auto recording = characterise_recording(*prepared, options, part_of(part, opened, 1.0));
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
