#include "schema/text/calibration.hpp"

#include "core/signal/with_count.hpp"
#include "schema/text/printed.hpp"

#include <cmath>

namespace driftlab {
namespace {

constexpr double kWidestAngle = 1.0;  // [rad] a half interval beyond it says nothing about how two axes lie

bool bounded(const Estimate& estimate) { return std::isfinite(estimate.ci95.half_width()); }

/// "+- 0.001", or that nothing bounds the number.
std::string spread_text(const Estimate& estimate) {
  return bounded(estimate) ? printed("+- %.2g", estimate.ci95.half_width()) : "(no interval)";
}

std::string ppm_text(const Estimate& estimate) {
  const std::string spread = bounded(estimate) ? printed("+- %.1f", 1e6 * estimate.ci95.half_width()) : "(no interval)";
  return printed("%+.1f %s ppm", 1e6 * estimate.value, spread.c_str());
}

/// A line for each pair of axes whose angle was estimated.
std::string angle_lines(const AxisAngles& angles) {
  std::string text;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const auto& angle = angles[i][j];
      if (!angle) {
        continue;
      }
      if (angle->ci95.half_width() < kWidestAngle) {
        text += printed("  %c reads %+.3f +- %.3f mrad of %c\n", "xyz"[i], 1e3 * angle -> value,
                        1e3 * angle -> ci95.half_width(), "xyz"[j]);
      } else {
        text += printed(
            "  What %c reads of %c cannot be told from these positions; add attitudes with gravity between the two "
            "axes.\n",
            "xyz"[i], "xyz"[j]);
      }
    }
  }
  return text;
}

std::string lines_of(const TriadCalibration& calibration, const char* unit) {
  std::string text;
  bool all_bounded = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Estimate& bias = calibration.bias[i];
    const Estimate& scale = calibration.scale_factor[i];
    text += printed("  %c  bias %+.6g %s %s   scale factor %s\n", "xyz"[i], bias.value, spread_text(bias).c_str(), unit,
                    ppm_text(scale).c_str());
    all_bounded = all_bounded && bounded(bias) && bounded(scale);
  }
  if (!all_bounded) {
    text +=
        "  An axis has no interval: its readings do not scatter within a position, and one position up and one down "
        "leave nothing else to tell their uncertainty by; record each position twice.\n";
  }
  if (calibration.misalignment[0][1]) {
    text += angle_lines(calibration.misalignment);
  } else {
    text += "  The angles between the axes are taken as right, not estimated; --misalignment estimates them.\n";
  }
  return text + printed("  residual %.4g -> %.4g %s over %zu readings\n", calibration.residual_before,
                        calibration.residual_after, unit, calibration.readings);
}

std::string lines_of(const MultiPositionCalibration& calibration) {
  std::string text;
  bool all_bounded = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Estimate& bias = calibration.bias[i];
    const Estimate& scale = calibration.correction[i][i];
    text += printed("  %c  bias %+.6g %s   m/s^2 a unit %.7g %s\n", "xyz"[i], bias.value, spread_text(bias).c_str(),
                    scale.value, spread_text(scale).c_str());
    all_bounded = all_bounded && bounded(bias) && bounded(scale);
  }
  if (!all_bounded) {
    text += "  What has no interval cannot be told from these positions; turn the sensor to more attitudes.\n";
  }
  text += angle_lines(calibration.misalignment());
  text +=
      "  y reads nothing of x, and z nothing of x and y, by definition: rests in unknown attitudes do not show a "
      "rotation of the triad as a whole, so the z sensor gives the z axis and the y sensor the plane of y and z.\n";
  text += printed("  length of the reading beside gravity, rms %.4g -> %.4g m/s^2\n", calibration.residual_before,
                  calibration.residual_after);
  for (const std::string& warning : calibration.warnings) {
    text += "  " + warning + "\n";
  }
  return text;
}

}  // namespace

std::string calibration_to_text(const CalibrationReport& report) {
  std::string text;
  if (const auto& rests = report.rests) {
    text +=
        "accelerometer, from " + with_count(rests->found.positions, "position") + " at rest\n" + lines_of(rests->found);
  }
  const auto add = [&](const char* sensor, const std::optional<PositionCalibration>& one, const char* unit) {
    if (one) {
      text +=
          std::string(sensor) + ", from " + with_count(one->positions, "position") + "\n" + lines_of(one->found, unit);
    }
  };
  add("accelerometer", report.accelerometer, "m/s^2");
  add("gyroscope", report.gyroscope, "rad/s");
  for (const std::string& note : report.notes) {
    text += note + "\n";
  }
  return text;
}

}  // namespace driftlab
