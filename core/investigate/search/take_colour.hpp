#pragma once
/// The colour of the noise at full rate: a band limit, and peaks of the spectrum. They are sought before everything
/// else at full rate, because they colour the innovations in which all other effects are sought.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/search/group_search.hpp"

#include <vector>

namespace driftlab::investigate {

/// Facts about the baseline and the file that looking at the data at full rate needs.
struct ColourSetting {
  bool given = false;  ///< the baseline is given
  double quantization = 0.0;
  double lattice_step = 0.0;
  const std::vector<std::vector<unsigned char>>& mask;
};

/// Takes one band limit and up to three peaks, the strongest first, out of `outcome.after`; the white level of an
/// automatic baseline, and a fast process that only imitates the colour, are renewed in `outcome.model`. Findings are
/// held out, and appended to `outcome.found`.
void take_colours(const ColourSetting& setting, GroupOutcome& outcome);

/// A noise model without the slow processes that are findings, which stand last in it.
[[nodiscard]] SlowModel base_of(SlowModel noise, const std::vector<Evidence>& found);

}  // namespace driftlab::investigate
