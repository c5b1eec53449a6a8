#include "core/analysis/survey_recording.hpp"

#include "core/analysis/unit_notes.hpp"
#include "core/read/open_recording.hpp"
#include "core/signal/channel_survey.hpp"
#include "core/signal/recording_columns.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab {
namespace {

bool holds_no_sensor(const RecordingSpec& spec) {
  return spec.condition.kind == ConditionKind::Drive && !spec.columns.empty() &&
         std::none_of(spec.columns.begin(), spec.columns.end(),
                      [](const auto& column) { return is_sensor(column.second.quantity); });
}

/// Of a recording none of whose columns is a sensor; nothing where the time alone is stated and the names of others are
/// those of a gyroscope or an accelerometer.
Result<std::optional<RecordingSurvey>> survey_fixes(const SurveyRequest& request) {
  const auto file = ColumnFile::open(request.columns);
  if (!file) {
    return fail(file.error());
  }
  const auto read = RecordingColumns::read(request.spec, file->names(), [&](std::size_t i) { return file->column(i); });
  if (!read) {
    return fail(read.error());
  }
  for (std::size_t i = 0; i < read->count(); ++i) {
    const Quantity quantity = read->role(i).value_or(ColumnRole{}).quantity;
    if (quantity == Quantity::AngularRate || quantity == Quantity::SpecificForce) {
      return std::optional<RecordingSurvey>();
    }
  }
  RecordingSurvey survey;
  survey.quality.samples = file->rows();
  survey.quality.notes.emplace_back(
      "No column is a sensor: the recording is for drives, and nothing in it is characterised.");
  return std::optional(std::move(survey));
}

std::vector<Gap> longest_of(std::vector<Gap> gaps) {
  const auto end = gaps.begin() + static_cast<std::ptrdiff_t>(std::min(gaps.size(), kMarksTold));
  std::partial_sort(gaps.begin(), end, gaps.end(), [](const Gap& a, const Gap& b) {
    return a.missing != b.missing ? a.missing > b.missing : a.row < b.row;
  });
  gaps.erase(end, gaps.end());
  std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.row < b.row; });
  return gaps;
}

std::vector<SampleStretch> implausible_in(const std::string& column, std::span<const double> values) {
  std::vector<SampleStretch> stretches;
  for (const std::size_t row : survey_channel(column, values).unsound) {
    if (std::isnan(values[row])) {
      continue;
    }
    if (!stretches.empty() && row == stretches.back().row + stretches.back().samples) {
      ++stretches.back().samples;
    } else if (stretches.size() < kMarksTold) {
      stretches.push_back({row, 1});
    } else {
      break;
    }
  }
  return stretches;
}

ChannelMarks marks_of(const ChannelQuality& channel, const ColumnFile& columns) {
  ChannelMarks marks;
  const auto& names = columns.names();
  const auto named = std::find(names.begin(), names.end(), channel.column);
  if (named == names.end()) {
    return marks;
  }
  const std::span<const double> values = columns.column(static_cast<std::size_t>(named - names.begin()));
  if (channel.saturated > 0) {
    marks.rails = find_rails(channel.column, values);
  }
  if (channel.implausible > 0) {
    marks.implausible = implausible_in(channel.column, values);
  }
  return marks;
}

}  // namespace

Result<RecordingSurvey> survey_recording(const SurveyRequest& request) {
  const RecordingSpec& spec = request.spec;
  const bool calibrated = !spec.calibration.empty();
  if (!calibrated && holds_no_sensor(spec)) {
    auto fixes = survey_fixes(request);
    if (!fixes) {
      return fail(fixes.error());
    }
    if (std::optional<RecordingSurvey>& found = *fixes; found) {
      return *std::move(found);
    }
  }
  auto opened = open_recording(request.columns, spec, calibrated ? ViewUse::Analysis : ViewUse::Survey);
  if (!opened) {
    return fail(opened.error());
  }
  add_unit_notes(opened->view, opened->columns, spec, request.hardware);
  RecordingSurvey survey;
  survey.quality = opened->view.window.quality;
  survey.temperature = measured_temperature(spec, opened->columns.names(), opened->view,
                                            [&](std::size_t index) { return opened->columns.column(index); });
  survey.longest_gaps = longest_of(opened->view.window.gaps);
  for (const ChannelQuality& channel : survey.quality.channels) {
    survey.marks.push_back(marks_of(channel, opened->columns));
  }
  if (calibrated) {
    if (auto applied = apply_calibration(request.calibration, opened->view); !applied) {
      return fail(applied.error());
    }
  }
  return survey;
}

}  // namespace driftlab
