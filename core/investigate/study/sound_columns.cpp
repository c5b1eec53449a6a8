#include "core/investigate/study/sound_columns.hpp"

#include "core/signal/left_out.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

namespace driftlab::investigate {
namespace {

using Memory = std::vector<std::vector<double>>;

bool is_finite(double value) { return std::isfinite(value); }

/// Of `values`, one of which is finite at least: what is missing is read on the line between its neighbours, before the
/// first and behind the last as these.
std::vector<double> filled(std::span<const double> values) {
  std::vector<double> whole(values.begin(), values.end());
  auto before = std::find_if(whole.begin(), whole.end(), is_finite);
  std::fill(whole.begin(), before, *before);
  for (auto next = before; before != whole.end(); before = next) {
    next = std::find_if(std::next(before), whole.end(), is_finite);
    const double step =
        next == whole.end() ? 0.0 : (*next - *before) / static_cast<double>(std::distance(before, next));
    for (auto hole = std::next(before); hole != next; ++hole) {
      *hole = *before + step * static_cast<double>(std::distance(before, hole));
    }
  }
  return whole;
}

bool is_reference(const std::optional<ColumnRole>& role) {
  return role && (role->quantity == Quantity::ReferenceAngularRate || role->quantity == Quantity::ReferenceAngle ||
                  role->quantity == Quantity::ReferenceSpecificForce);
}

void sort_once(std::vector<std::size_t>& rows) {
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

/// What is missing in a sensor's column, for the notes.
std::string note_of_holes(const ChannelQuality& quality) {
  ChannelQuality holes;
  holes.column = quality.column;
  holes.missing = quality.missing;
  holes.implausible = quality.implausible;
  return describe(holes, 0);
}

void add_note(std::string note, std::vector<std::string>& notes) {
  if (!note.empty()) {
    notes.push_back(std::move(note));
  }
}

/// Sorts the columns into sensors and others, and finds the rows that lack a sample of a sensor or a reference.
Status survey_columns(SoundColumns& sound) {
  const RecordingColumns& columns = sound.columns;
  for (std::size_t i = 0; i < columns.count(); ++i) {
    auto use = columns.use_of(i);
    if (!use) {
      return fail(use.error());
    }
    add_note(std::move(use->note), sound.notes);
    if (use->examined) {
      sound.examined.push_back(i);
      const ChannelSurvey survey = columns.survey(i);
      sound.left_out.insert(sound.left_out.end(), survey.unsound.begin(), survey.unsound.end());
      add_note(note_of_holes(survey.quality), sound.notes);
    } else if (is_reference(columns.role(i))) {
      const std::span<const double> samples = columns.samples(i);
      for (std::size_t row = 0; row < samples.size(); ++row) {
        if (!std::isfinite(samples[row])) {
          sound.left_out.push_back(row);
        }
      }
    }
  }
  add_note(columns.note_of_skipped(), sound.notes);
  sort_once(sound.left_out);
  return {};
}

/// The temperature column where it lacks some of its values, but not all.
std::optional<std::size_t> sparse_temperature(const RecordingColumns& columns) {
  const auto index = columns.find(Quantity::Temperature);
  if (!index) {
    return std::nullopt;
  }
  const std::span<const double> samples = columns.samples(*index);
  const auto finite = std::count_if(samples.begin(), samples.end(), is_finite);
  return finite > 0 && static_cast<std::size_t>(finite) < samples.size() ? index : std::nullopt;
}

/// Every column without the rows left out, and the temperature filled; empty for one that is as in the file.
Memory memory_of(const RecordingColumns& columns, const std::vector<std::size_t>& left_out,
                 const std::optional<std::size_t>& temperature) {
  Memory memory(columns.count());
  for (std::size_t i = 0; i < columns.count(); ++i) {
    if (temperature == i) {
      memory[i] = filled(columns.samples(i));
    }
    if (!left_out.empty()) {
      const std::span<const double> all = temperature == i ? std::span<const double>(memory[i]) : columns.samples(i);
      memory[i] = without(all, std::span<const std::size_t>(left_out));
    }
  }
  return memory;
}

}  // namespace

Result<SoundColumns> sound_columns(const RecordingSpec& spec, const ColumnNames& names, RecordingColumns columns) {
  SoundColumns sound{std::move(columns), {}, {}, {}, nullptr};
  if (const Status surveyed = survey_columns(sound); !surveyed) {
    return fail(surveyed.error());
  }
  const auto temperature = sparse_temperature(sound.columns);
  if (sound.left_out.empty() && !temperature) {
    return sound;
  }
  if (!sound.left_out.empty()) {
    sound.notes.push_back(with_count(sound.left_out.size(),
                                     "row lacks a sample of a sensor or of a reference, and counts as lost.",
                                     "rows lack a sample of a sensor or of a reference, and count as lost."));
  }
  if (temperature) {
    sound.notes.push_back("Column '" + names[*temperature] +
                          "' is missing in some rows; the temperature is read between their neighbours there.");
  }
  sound.memory = std::make_shared<const Memory>(memory_of(sound.columns, sound.left_out, temperature));
  auto whole = RecordingColumns::read(
      spec, names, [memory = sound.memory, file = sound.columns](std::size_t i) -> std::span<const double> {
        return (*memory)[i].empty() ? file.samples(i) : std::span<const double>((*memory)[i]);
      });
  if (!whole) {
    return fail(whole.error());
  }
  sound.columns = std::move(*whole);
  return sound;
}

}  // namespace driftlab::investigate
