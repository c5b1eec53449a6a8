#pragma once
/// The worth of a stored model: an effect is hidden in a study, the study is investigated, and what the investigation
/// would store is scored on fresh data from the truth.
#include "tests/hidden/simulated_study.hpp"

#include <cstdint>
#include <string>

namespace driftlab::hidden {

struct StoredGain {
  bool named = false;       ///< the effect is among the findings
  double claimed = 0.0;     ///< held-out gain of the findings that are no facts of the file [nat]
  double stored = 0.0;      ///< of the stored extension over the stored baseline, on fresh data [nat]
  double attainable = 0.0;  ///< of the truth over the stored baseline, on the same data [nat]
  std::string said;         ///< the findings
};

/// `given`: the baseline of the study is the true base; else it is fitted. The log likelihoods are those of
/// fresh_likelihood.hpp.
[[nodiscard]] StoredGain stored_gain(const std::string& cause, double z, std::uint64_t seed, bool given);

/// Within 20 % of the truth; where the truth itself gains less than 60 nat, within 12 nat of it.
[[nodiscard]] bool holds_its_promise(const StoredGain& gain);

}  // namespace driftlab::hidden
