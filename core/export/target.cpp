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

}  // namespace

NoiseFigure largest(const SensorNoise& sensor, NoiseFigure AxisNoise::* member) {
  if (sensor.axes.empty()) {
    NoiseFigure none;
    none.remark = sensor.missing;
    return none;
  }
  const AxisNoise* found = &sensor.axes.front();
  for (const AxisNoise& axis : sensor.axes) {
    found = tells_more(axis.*member, found->*member) ? &axis : found;
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
  std::vector<NoiseFigure> figures;
  for (const char* const name : {"x", "y", "z"}) {
    const auto axis =
        std::find_if(sensor.axes.begin(), sensor.axes.end(), [&](const AxisNoise& one) { return one.axis == name; });
    NoiseFigure other = largest(sensor, member);
    const bool own = axis != sensor.axes.end() && ((*axis).*member).value && (!((*axis).*member).limit || other.limit);
    if (own) {
      figures.push_back((*axis).*member);
    } else {
      if (other.value) {
        other.remark = axis == sensor.axes.end() ? "not recorded about this axis, the largest of the others"
                                                 : "not identified about this axis, the largest of the others";
      }
      figures.push_back(std::move(other));
    }
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
