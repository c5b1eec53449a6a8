#include "core/campaign/sheet_comparison.hpp"

#include "core/signal/significant.hpp"

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kAgrees = 1.5;  ///< factor

/// The least Allan deviation of flicker noise over its coefficient B (IEEE Std 952, C.1.3).
double least_over_b() { return std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi); }

SheetFigure figure_of(std::string parameter, double stated_si, const ParameterUnit& unit,
                      const ReportedValue& measured) {
  SheetFigure figure;
  figure.parameter = std::move(parameter);
  figure.stated = stated_si * unit.per_si;
  figure.unit = unit.symbol;
  figure.measured = measured;
  if (!measured.value) {
    return figure;
  }
  figure.ratio = *measured.value / figure.stated;
  if (measured.low) {
    figure.ratio_low = *measured.low / figure.stated;
  }
  if (measured.high) {
    figure.ratio_high = *measured.high / figure.stated;
  }
  figure.verdict = figure.ratio_low.value_or(0.0) > kAgrees                  ? SheetVerdict::Above
                   : figure.ratio_high && *figure.ratio_high < 1.0 / kAgrees ? SheetVerdict::Below
                                                                             : SheetVerdict::Agrees;
  return figure;
}

}  // namespace

std::string_view name_of(SheetVerdict verdict) {
  switch (verdict) {
    case SheetVerdict::Above:
      return "above";
    case SheetVerdict::Below:
      return "below";
    case SheetVerdict::Agrees:
      break;
  }
  return "agrees";
}

std::optional<SheetComparison> compare_with_sheet(const KnownSensor& known, std::string_view axis,
                                                  const std::string& condition, const ReportedValue& density,
                                                  const ReportedValue* flicker) {
  const SensorSheet& sensor = *known.sensor;
  const Dimension dimension =
      sensor.quantity == Quantity::AngularRate ? Dimension::AngularRate : Dimension::SpecificForce;
  SheetComparison comparison{
      std::string(known.sheet->name), known.sheet->source() + ", " + std::string(sensor.place), condition, {}};
  const auto add = [&](const char* parameter, std::optional<double> stated_si, int halves, const ReportedValue& value) {
    const ParameterUnit unit = lab_unit(dimension, halves);
    if (stated_si && (value.unit == unit.symbol || (value.unit.empty() && !value.value))) {
      comparison.figures.push_back(figure_of(parameter, *stated_si, unit, value));
    }
  };
  add("N", stated_density_si(sensor, axis), 1, density);
  if (flicker != nullptr) {
    auto least = stated_bias_stability_si(sensor);
    if (least) {
      *least /= least_over_b();
    }
    add("B", least, 0, *flicker);
  }
  return comparison.figures.empty() ? std::nullopt : std::optional(std::move(comparison));
}

std::string sentence_of(const SheetFigure& figure) {
  const std::string stated = significant(figure.stated) + " " + figure.unit;
  if (!figure.ratio) {
    return figure.parameter + " is stated as " + stated + " and was not identified";
  }
  const std::string times = significant(*figure.ratio, figure.ratio_low, figure.ratio_high);
  const char* const word = figure.verdict == SheetVerdict::Above   ? ": above it"
                           : figure.verdict == SheetVerdict::Below ? ": below it"
                                                                   : "";
  return figure.parameter + " is " + times + " times the " + stated + " of its data sheet" + word;
}

}  // namespace driftlab
