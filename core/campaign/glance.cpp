#include "core/campaign/glance.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

/// N of the model's white noise; no value where it has none.
ReportedValue white_noise_of(const ReportedFit& fit) {
  const auto white = std::find_if(fit.processes.begin(), fit.processes.end(),
                                  [](const ReportedProcess& process) { return process.process == "white_noise"; });
  if (white != fit.processes.end()) {
    for (const auto& [name, value] : white->parameters) {
      if (name == "N") {
        return value;
      }
    }
  }
  return {};
}

}  // namespace

AxisGlance glance_of(const ReportedFit& fit, const std::optional<ReportedValue>& density) {
  AxisGlance glance;
  glance.density = density ? *density : white_noise_of(fit);
  if (!fit.j_test || std::isnan(fit.j_test->p)) {
    glance.reason = "too few scales to test whether the best model fits";
    return glance;
  }
  glance.fits = fit.fits();
  if (*glance.fits) {
    glance.level = VerdictLevel::Fine;
  } else {
    glance.reason = "the best model does not fit (J test p < 0.01)";
  }
  return glance;
}

}  // namespace driftlab
