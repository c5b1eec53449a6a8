/// sample_clock: the host asks for readings faster than the sensor samples, and writes some of them twice. The loading
/// drops the repeats (sampling.hpp); this names it.
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {
namespace {

std::optional<FromFiles> clock_in_files(const Drive& drive, const FilterOptions& /*options*/) {
  const SamplingFacts& s = drive.facts.sampling;
  if (!s.polled_faster) {
    return std::nullopt;
  }
  DriveFinding finding;
  finding.parameter = "rate_hz";
  finding.title = "the host polls faster than the sensor samples, which runs at";
  finding.unit = "Hz";
  finding.value = s.sensor_rate_hz;
  finding.se = s.sensor_rate_hz * s.jitter_s / drive.end_s();
  // Repeats at random would be as likely anywhere; a lattice of them is not. One nat for each is a small part of it.
  finding.score = static_cast<double>(s.repeated - s.stuck);
  finding.evidence = "the file";
  finding.told_apart = "a lattice of single repeated rows; irregular runs of equal rows are a stuck sensor";
  return FromFiles{std::move(finding), nullptr, true};
}

}  // namespace

Cause sample_clock() {
  return {.name = "sample_clock", .words = "a poll faster than the sensor samples", .from_files = clock_in_files};
}

}  // namespace driftlab::drive
