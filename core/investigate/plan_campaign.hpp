#pragma once
/// The recordings to make next: those that would settle the most questions that an investigation left open.
///
/// An ambiguous finding is an open question, and so is a cause that could not be examined. For each question one answer
/// is assumed, the recordings that a laboratory would then make are simulated, and the whole study is investigated
/// anew. A proposal decides the question if the investigation names the assumed answer and reports no rival beside it.
/// The share of the simulated studies in which it does is the probability that is stated, with Wilson's interval
/// (1927).
///
/// Simulated are the recordings that exist, under the extended model, and the proposed ones beside them. An ambiguous
/// finding is simulated as it was estimated, and where it and a rival are both effects on the mean, in every second run
/// as that rival, of the size that fits the finding best. A cause that was not examined is simulated at the size that
/// an oracle who knows base and template would see at twelve standard deviations in the proposed recordings: the plan
/// says from what size on a recording would show it, not how likely it is.
///
/// Cost: an investigation of one channel per run, question and proposal. Deterministic in the seed.
#include "core/investigate/report/report.hpp"
#include "core/signal/progress.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace driftlab::investigate {

struct PlanOptions {
  std::size_t runs = 6;  ///< simulated studies per question and proposal
  std::uint64_t seed = 1;
};

/// An open question.
struct OpenQuestion {
  std::string cause;
  std::string channel;              ///< column
  std::vector<std::string> rivals;  ///< of an ambiguous finding; empty: it was not examined
  std::string needs;                ///< what was wanting
};

struct Decision {
  std::size_t question = 0;           ///< place in CampaignPlan::open
  std::vector<FoundParameter> sizes;  ///< at which it was simulated
  std::size_t decided = 0, runs = 0;
  Estimate probability;
};

struct Proposal {
  std::string title;
  std::string channel;
  std::vector<Condition> conditions;
  double duration_s = 0.0;  ///< of each recording
  double rate_hz = 0.0;
  std::vector<std::string> columns;
  std::vector<Decision> decisions;

  /// Questions that it is expected to decide.
  [[nodiscard]] double expected() const;
};

struct CampaignPlan {
  std::vector<OpenQuestion> open;
  std::vector<Proposal> proposals;  ///< that decide something, most first
  /// Questions that no simulated proposal decides, with what they need.
  std::vector<std::size_t> undecided;
};

/// The open questions of `report`, each once per channel.
[[nodiscard]] std::vector<OpenQuestion> open_questions(const Report& report);

/// `report` is the investigation of `study`. Errors: Cancelled; those of investigate.
[[nodiscard]] Result<CampaignPlan> plan_campaign(const Study& study, const Report& report,
                                                 const PlanOptions& options = {}, const RunControl& control = {});

}  // namespace driftlab::investigate
