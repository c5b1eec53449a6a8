#pragma once
/// The recordings of an arm, as a report describes them.
#include "core/campaign/regression/sessions.hpp"

#include <string>
#include <vector>

namespace driftlab::regression {

struct ArmReport {
  std::string label;
  struct Session {
    std::string name;
    std::vector<std::string> recordings;  ///< more than one: they are merged and count once
    double duration_s = 0.0;
  };
  std::vector<Session> sessions;
  std::vector<double> rates_hz;  ///< of all recordings, each once, rising

  /// Names of the sessions whose recordings are merged.
  [[nodiscard]] std::vector<std::string> merged() const;
};

[[nodiscard]] ArmReport arm_report(const Recordings& arm, const PowerUps& sessions);

/// "Baseline 100 Hz, candidate 200 Hz: compared from 0.01 s on; 0.005 s exists only in the candidate.": for arms whose
/// recordings have different rates. `from_s`: the shortest averaging time that is compared.
[[nodiscard]] std::string rates_sentence(const ArmReport& baseline, const ArmReport& candidate, double from_s);

}  // namespace driftlab::regression
