#include "core/export/target.hpp"

#include <algorithm>

namespace driftlab {

bool ExportEntry::complete() const {
  return std::all_of(figures.begin(), figures.end(),
                     [](const NoiseFigure& figure) { return figure.value.has_value(); });
}

namespace {

/// Whether a figure tells more than another: identified before a limit before nothing; of two that are identified the
/// larger, of two limits the tighter, for it holds for the sensor at its best.
bool tells_more(const NoiseFigure& a, const NoiseFigure& b) {
  if (!a.value || !b.value) {
    return a.value.has_value() && !b.value;
  }
  if (a.limit != b.limit) {
    return b.limit;
  }
  return a.limit ? *a.value < *b.value : *a.value > *b.value;
}

/// The axis whose figure tells the most; null without axes.
const AxisNoise* most_telling(const SensorNoise& sensor, NoiseFigure AxisNoise::* member) {
  const AxisNoise* found = nullptr;
  for (const AxisNoise& axis : sensor.axes) {
    found = found == nullptr || tells_more(axis.*member, found->*member) ? &axis : found;
  }
  return found;
}

NoiseFigure without_axes(const SensorNoise& sensor) {
  NoiseFigure none;
  none.remark = sensor.missing;
  return none;
}

}  // namespace

NoiseFigure largest(const SensorNoise& sensor, NoiseFigure AxisNoise::* member) {
  const AxisNoise* const found = most_telling(sensor, member);
  if (found == nullptr) {
    return without_axes(sensor);
  }
  NoiseFigure figure = found->*member;
  if (sensor.axes.size() > 1 && figure.value) {
    const std::string name = found->axis.empty() ? found->channel : found->axis;
    figure.remark =
        (figure.limit ? "identified about no axis, the least limit is that of " : "largest of the axes, that of ") +
        name + "; " + figure.remark;
  }
  return figure;
}

std::vector<NoiseFigure> by_axis(const SensorNoise& sensor, NoiseFigure AxisNoise::* member) {
  NoiseFigure AxisNoise::* const ruling = member == &AxisNoise::correlation_s ? &AxisNoise::bias_sd : member;
  const AxisNoise* const other = most_telling(sensor, ruling);
  std::vector<NoiseFigure> figures;
  for (const char* const name : {"x", "y", "z"}) {
    const auto axis =
        std::find_if(sensor.axes.begin(), sensor.axes.end(), [&](const AxisNoise& one) { return one.axis == name; });
    const bool recorded = axis != sensor.axes.end();
    if (recorded && ((*axis).*ruling).value && (!((*axis).*ruling).limit || (other->*ruling).limit)) {
      figures.push_back((*axis).*member);
      continue;
    }
    NoiseFigure figure = other == nullptr ? without_axes(sensor) : other->*member;
    if (figure.value) {
      const std::string which = member == ruling ? "the largest of the others" : "that of the largest of the others";
      figure.remark = (recorded ? "not identified about this axis, " : "not recorded about this axis, ") + which;
    }
    figures.push_back(std::move(figure));
  }
  return figures;
}

std::vector<NoiseFigure> scaled(std::vector<NoiseFigure> figures, double factor) {
  for (NoiseFigure& figure : figures) {
    figure = figure.scaled(factor);
  }
  return figures;
}

}  // namespace driftlab
