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

/// What is missing is read on the line between its neighbours, before the first and behind the last as these.
std::vector<double> filled(std::span<const double> values) {
  std::vector<double> whole(values.begin(), values.end());
  auto before = whole.end();
  for (auto at = whole.begin(); at != whole.end(); at = std::next(before)) {
    const auto next = std::find_if(at, whole.end(), is_finite);
    if (next == whole.end()) {
      std::fill(at, next, before == whole.end() ? 0.0 : *before);
      break;
    }
    const double from = before == whole.end() ? *next : *before;
    const double step = (*next - from) / static_cast<double>(std::distance(at, next) + 1);
    for (auto hole = at; hole != next; ++hole) {
      *hole = from + step * static_cast<double>(std::distance(at, hole) + 1);
    }
    before = next;
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

}  // namespace

Result<SoundColumns> sound_columns(const RecordingSpec& spec, const ColumnNames& names, RecordingColumns columns) {
  SoundColumns sound{std::move(columns), {}, {}, {}, nullptr};
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto use = sound.columns.use_of(i);
    if (!use) {
      return fail(use.error());
    }
    if (!use->note.empty()) {
      sound.notes.push_back(std::move(use->note));
    }
    if (use->examined) {
      sound.examined.push_back(i);
      const ChannelSurvey survey = sound.columns.survey(i);
      sound.left_out.insert(sound.left_out.end(), survey.unsound.begin(), survey.unsound.end());
      ChannelQuality holes;
      holes.column = names[i];
      holes.missing = survey.quality.missing;
      holes.implausible = survey.quality.implausible;
      if (std::string sentence = describe(holes, 0); !sentence.empty()) {
        sound.notes.push_back(std::move(sentence));
      }
    } else if (is_reference(sound.columns.role(i))) {
      const std::span<const double> samples = sound.columns.samples(i);
      for (std::size_t row = 0; row < samples.size(); ++row) {
        if (!std::isfinite(samples[row])) {
          sound.left_out.push_back(row);
        }
      }
    }
  }
  if (std::string skipped = sound.columns.note_of_skipped(); !skipped.empty()) {
    sound.notes.push_back(std::move(skipped));
  }
  sort_once(sound.left_out);
  const auto temperature = sound.columns.find(Quantity::Temperature);
  const bool holes_in_temperature = temperature && [&] {
    const std::span<const double> samples = sound.columns.samples(*temperature);
    return !std::all_of(samples.begin(), samples.end(), is_finite) &&
           std::any_of(samples.begin(), samples.end(), is_finite);
  }();
  if (sound.left_out.empty() && !holes_in_temperature) {
    return sound;
  }
  Memory memory(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool fill = holes_in_temperature && i == *temperature;
    if (fill) {
      memory[i] = filled(sound.columns.samples(i));
    }
    if (!sound.left_out.empty()) {
      const std::span<const double> all = fill ? std::span<const double>(memory[i]) : sound.columns.samples(i);
      memory[i] = without(all, std::span<const std::size_t>(sound.left_out));
    }
  }
  if (!sound.left_out.empty()) {
    sound.notes.push_back(with_count(sound.left_out.size(),
                                     "row lacks a sample of a sensor or of a reference, and counts as lost.",
                                     "rows lack a sample of a sensor or of a reference, and count as lost."));
  }
  if (holes_in_temperature) {
    sound.notes.push_back("Column '" + names[*temperature] +
                          "' is missing in some rows; the temperature is read between their neighbours there.");
  }
  sound.memory = std::make_shared<const Memory>(std::move(memory));
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
