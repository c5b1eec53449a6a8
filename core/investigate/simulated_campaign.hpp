#pragma once
/// A study as it would be with more recordings, simulated with a known answer to an open question.
#include "core/investigate/plan_campaign.hpp"

#include <deque>
#include <vector>

namespace driftlab::investigate {

/// What is taken to be true, as an effect in the model.
struct Answer {
  GivenEffect effect;
  std::vector<FoundParameter> sizes;
};

struct SimulatedStudy {
  Study study;
  std::deque<std::vector<double>> memory;  ///< the columns that the study points into
};

/// One channel of a study: the recordings there are and `blank` ones beside them, under the extended model of `report`.
class SimulatedCampaign {
 public:
  SimulatedCampaign(const Study& study, const Report& report, const ChannelGroup& group,
                    const std::vector<StudyRecording>& blank);

  /// The answers that a question may have and that these recordings could show; none where the cause could not be
  /// examined with them either, cannot be simulated, or has no size that could be stated.
  [[nodiscard]] std::vector<Answer> answers_to(const OpenQuestion& question) const;

  /// All recordings with noise of their own. Same seed, same bits.
  [[nodiscard]] SimulatedStudy simulate(const Answer& answer, std::uint64_t seed) const;

 private:
  [[nodiscard]] std::vector<Answer> as_estimated(const OpenQuestion& question) const;
  [[nodiscard]] std::vector<Answer> as_seen_by_an_oracle(const OpenQuestion& question) const;

  Study frame_;     ///< the recordings, this channel alone
  Baseline model_;  ///< that simulates, without what is in question
  const Report& report_;
  const ChannelModel* channel_ = nullptr;
  std::string column_;
  ColumnRole role_;
};

}  // namespace driftlab::investigate
