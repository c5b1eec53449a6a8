#include "schema/json/calibration.hpp"

#include <array>
#include <cstdio>

namespace driftlab {
namespace {

Json numbers(const Triple& row) { return Json{number(row[0]), number(row[1]), number(row[2])}; }

double half_width(const Estimate& estimate) { return 0.5 * (estimate.ci95.high - estimate.ci95.low); }

}  // namespace

Json to_json(const TriadCalibration& calibration, std::string_view unit) {
  Json document;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    document["bias"][axis] = quantity(calibration.bias[i], 1.0, unit);
    document["scale_factor"][axis] = quantity(calibration.scale_factor[i], 1e6, "ppm");
    for (std::size_t j = 0; j < 3; ++j) {
      if (i != j && calibration.misalignment[i][j].ci95.high > calibration.misalignment[i][j].ci95.low) {
        document["misalignment"][axis + "xyz"[j]] = quantity(calibration.misalignment[i][j], 1e3, "mrad");
      }
    }
  }
  document["matrix"] =
      Json{numbers(calibration.law.matrix[0]), numbers(calibration.law.matrix[1]), numbers(calibration.law.matrix[2])};
  document["readings"] = calibration.readings;
  document["chi_square_per_dof"] = number(calibration.chi_square_per_dof);
  document["residual_rms"] = Json{
      {"before", number(calibration.residual_before)}, {"after", number(calibration.residual_after)}, {"unit", unit}};
  return document;
}

Json to_json(const MultiPositionCalibration& calibration) {
  Json document;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    document["bias"][axis] = quantity(calibration.bias[i], 1.0, "1");
    for (std::size_t j = i; j < 3; ++j) {
      document["correction"][axis + "xyz"[j]] = quantity(calibration.correction[i][j], 1.0, "m/s^2");
    }
  }
  document["positions"] = calibration.positions;
  document["converged"] = calibration.converged;
  document["condition_number"] = number(calibration.condition);
  document["residual_rms"] = Json{{"before", number(calibration.residual_before)},
                                  {"after", number(calibration.residual_after)},
                                  {"unit", "m/s^2"}};
  document["warnings"] = calibration.warnings;
  return document;
}

std::string to_text(const TriadCalibration& calibration, std::string_view unit) {
  std::string text;
  std::array<char, 200> line{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::snprintf(line.data(), line.size(), "  %c  bias %+.6g +- %.2g %.*s   scale factor %+.1f +- %.1f ppm\n",
                  "xyz"[i], calibration.bias[i].value, half_width(calibration.bias[i]), static_cast<int>(unit.size()),
                  unit.data(), 1e6 * calibration.scale_factor[i].value, 1e6 * half_width(calibration.scale_factor[i]));
    text += line.data();
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Estimate& angle = calibration.misalignment[i][j];
      if (i != j && angle.ci95.high > angle.ci95.low) {
        std::snprintf(line.data(), line.size(), "  %c reads %+.3f +- %.3f mrad of %c\n", "xyz"[i], 1e3 * angle.value,
                      1e3 * half_width(angle), "xyz"[j]);
        text += line.data();
      }
    }
  }
  std::snprintf(line.data(), line.size(), "  residual %.4g -> %.4g %.*s over %zu readings\n",
                calibration.residual_before, calibration.residual_after, static_cast<int>(unit.size()), unit.data(),
                calibration.readings);
  return text + line.data();
}

std::string to_text(const MultiPositionCalibration& calibration) {
  std::string text;
  std::array<char, 200> line{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::snprintf(line.data(), line.size(), "  %c  bias %+.6g +- %.2g   m/s^2 a unit %.7g +- %.2g\n", "xyz"[i],
                  calibration.bias[i].value, half_width(calibration.bias[i]), calibration.correction[i][i].value,
                  half_width(calibration.correction[i][i]));
    text += line.data();
  }
  std::snprintf(line.data(), line.size(), "  length of the reading beside gravity, rms %.4g -> %.4g m/s^2\n",
                calibration.residual_before, calibration.residual_after);
  text += line.data();
  for (const std::string& warning : calibration.warnings) {
    text += "  " + warning + "\n";
  }
  return text;
}

}  // namespace driftlab
