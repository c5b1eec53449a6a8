#include "schema/text/data_sheet.hpp"

#include "core/signal/number.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/unit.hpp"

namespace driftlab {
namespace {

std::string span_text(const StatedSpan& span) {
  return short_text(span.lowest) + (span.lowest == span.highest ? std::string() : " to " + short_text(span.highest)) +
         " Hz";
}

std::string scales_text(const SensorSheet& sensor) {
  std::string text;
  for (const FullScale& scale : sensor.scales) {
    text += (text.empty() ? "" : ", ") + short_text(scale.limit);
    if (scale.per_count) {
      text += " (1 count = " + significant(*scale.per_count) + ")";
    }
  }
  return text + " " + std::string(sensor.unit);
}

std::string sensor_text(const SensorSheet& sensor) {
  const bool rate = sensor.quantity == Quantity::AngularRate;
  std::string text = "\n" + std::string(sensor_of(sensor.quantity)) + " (" + std::string(sensor.place) + ")\n";
  const auto line = [&](const char* name, const std::string& value) {
    text += "  " + std::string(name) + std::string(18 - std::string_view(name).size(), ' ') + value + "\n";
  };
  line("full scales, +-", scales_text(sensor));
  const auto figure = [&](const char* name, const std::optional<double>& value, const std::string& unit) {
    if (value) {
      line(name, significant(*value) + " " + unit);
    }
  };
  const std::string density_unit = std::string(sensor.unit) + "/sqrt(Hz), one-sided";
  figure("noise density", sensor.noise_density, density_unit);
  figure("  of axis z", sensor.noise_density_z, density_unit);
  figure("random walk", sensor.random_walk, rate ? "deg/sqrt(h)" : "m/s/sqrt(h)");
  figure("bias stability", sensor.bias_stability, rate ? "deg/h" : "ug");
  const ParameterUnit n = lab_unit(rate ? Dimension::AngularRate : Dimension::SpecificForce, 1);
  if (const auto stated = stated_density_si(sensor, "")) {
    line("N compares with", significant(*stated * n.per_si) + " " + n.symbol);
  }
  if (sensor.bandwidth_hz) {
    line("bandwidth", span_text(*sensor.bandwidth_hz));
  }
  if (sensor.rate_hz) {
    line("output rate", span_text(*sensor.rate_hz));
  }
  return text;
}

}  // namespace

std::string data_sheet_to_text(const DataSheet& sheet) {
  std::string text = std::string(sheet.name) + "\n  " + sheet.source() + "\n";
  for (const std::string_view name : sheet.also) {
    text += "  also " + std::string(name) + "\n";
  }
  for (const SensorSheet& sensor : sheet.sensors) {
    text += sensor_text(sensor);
  }
  return text;
}

std::string data_sheets_to_text() {
  std::string text;
  for (const DataSheet* const sheet : data_sheets()) {
    const std::string name(sheet->name);
    text += name + std::string(name.size() < 16 ? 16 - name.size() : 1, ' ') + sheet->source() + "\n";
  }
  return text;
}

}  // namespace driftlab
