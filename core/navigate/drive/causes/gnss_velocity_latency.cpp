/// gnss_velocity_latency: the velocities of fixes are older than their positions.
///
/// The fixes alone cannot tell it from a mean over twice the delay, which is as late in its middle
/// (gnss_velocity_averaging): both are said.
#include "core/navigate/drive/causes/cause.hpp"
#include "core/navigate/drive/likelihood.hpp"
#include "core/signal/significant.hpp"

#include <cmath>

namespace driftlab::drive {
namespace {

constexpr double kDelayNamed = 5.0;  ///< score
constexpr double kDelaySure = 3.0;   ///< standard errors
constexpr Knob kDelayKnob{.parameter = "delay_s",
                          .title = "velocities of fixes are late by",
                          .unit = "s",
                          .step = 0.02,
                          .most = 2.0,
                          .turn = [](FilterOptions& o, double by) { o.velocity_latency_s += by; },
                          .value = [](const FilterOptions& o) { return o.velocity_latency_s; },
                          .applies =
                              [](const Drive& drive, const FilterOptions&) {
                                return !drive.fixes.empty() &&
                                       drive.fixes[drive.fixes.size() / 2].velocity_ned_m_s.has_value();
                              },
                          .told_apart =
                              "the fixes alone show it: displacement against integrated velocity over change of "
                              "velocity"};

std::optional<FromFiles> delay_in_files(const Drive& drive, const FilterOptions& options) {
  const auto delay = delay_from_fixes(drive.fixes);
  if (!delay) {
    return std::nullopt;
  }
  const double rest = delay->delay_s - (options.velocity_latency_s - options.position_latency_s);
  if (delay->score < kDelayNamed || std::abs(rest) < kDelaySure * delay->se_s) {
    return std::nullopt;
  }
  DriveFinding finding = finding_of(kDelayKnob);
  finding.value = delay->delay_s;
  finding.se = delay->se_s;
  finding.score = delay->score;
  finding.evidence = "the fixes alone";
  if (delay->delay_s > 0.0) {
    finding.evidence += ", to which means over the " + significant(2.0 * delay->delay_s) + " s before them are as late";
  }
  return FromFiles{
      std::move(finding),
      [by = delay->delay_s](FilterOptions& told) { told.velocity_latency_s = told.position_latency_s + by; }, false};
}

std::string note_of_delay(const DriveFinding& finding, bool known) {
  return known ? "The innovations put the delay of the velocities at " + std::to_string(finding.value) +
                     " s: a receiver's velocity can be a mean over the interval before it."
               : "";
}

}  // namespace

Cause gnss_velocity_latency() {
  return {.name = "gnss_velocity_latency",
          .words = "late velocities of fixes",
          .knobs = {kDelayKnob},
          .from_files = delay_in_files,
          .note = note_of_delay};
}

}  // namespace driftlab::drive
