#pragma once
/// What the model lacks of a sensor in every recording, and what therefore speaks neither for nor against a difference
/// between recordings, or between the parts of one.
///
/// Real sensors have spectra that no model of the registry describes and noise that swells in a steady rhythm, in all
/// recordings alike. A finding that is such a difference is doubted by what goes with its own recordings or its own
/// moment (earned.hpp), and not by
///   - checks of the spectrum, and a profile of it, where one profile is that of all recordings;
///   - a rhythm of the noise's power, as a line or as a profile of its phase, that the finding's recordings and others
///     have, of at least twenty periods a recording: a change that lasts is none of it, and a spectrum neither.
/// The differences meant are a level of noise that changes within a recording, and differenced noise of some recordings
/// and not of others, which is sought against a spectrum that all share. Any other finding has no shared misfit: a
/// level of whole recordings, or a peak, may be what an error that goes with their motion leaves.
#include "core/investigate/report/remainder.hpp"
#include "core/investigate/report/report.hpp"

#include <string>
#include <vector>

namespace driftlab::investigate {

/// The lists must outlive it. `unnamed`: profiles that were found beside the findings.
class SharedMisfit {
 public:
  SharedMisfit(const Evidence& evidence, const ChannelGroup& group, const std::vector<Remainder>& remains,
               const std::vector<UnnamedFinding>& unnamed);

  /// Whether one profile of the spectrum is that of all recordings, and the finding a difference.
  [[nodiscard]] bool of_spectrum() const { return of_spectrum_; }
  /// Whether something is part of what is shared.
  [[nodiscard]] bool holds(const Check& check) const;
  [[nodiscard]] bool holds(const Remainder& remainder) const;
  [[nodiscard]] bool holds(const UnnamedFinding& profile) const;

 private:
  [[nodiscard]] bool is_of_finding(const std::string& recording) const;
  [[nodiscard]] bool is_rhythm(const std::string& recording, double period_s) const;
  [[nodiscard]] bool is_rhythm(const UnnamedFinding& profile) const;

  const Evidence& evidence_;
  const ChannelGroup& group_;
  bool in_some_ = false;  ///< differenced noise of some recordings
  bool of_spectrum_ = false;
  bool rhythm_ = false;  ///< of the finding's recordings and of others
};

}  // namespace driftlab::investigate
