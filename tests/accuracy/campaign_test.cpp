// The campaign of the seed paper, simulated: do the intervals of the parameter table hold the truth?
// One test an experiment, so that a long run may be made in parts: --gtest_filter='*Campaign*/4'.
#include "tests/accuracy/campaign.hpp"

#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace driftlab::accuracy {
namespace {

struct Tally {
  std::size_t inside = 0;
  std::size_t unidentified = 0;
};

class Campaign : public testing::TestWithParam<std::size_t> {
 protected:
  static void SetUpTestSuite() {
    section = std::make_unique<Section>("campaign");
    section->print(
        "\n## A rate-table campaign: the parameter table\n\nTable 4 of Radi et al. (2017), iPhone, simulated: eight "
        "conditions, two recordings each, fitted jointly (WN+2GM; WN+GM under angular acceleration, as in the paper's "
        "table). Experiment 4: %.1f %% of the samples have an error of %.0f standard deviations of the white noise. "
        "Coverage [%%] of the 95 %% intervals, in brackets how often [%%] \"not identifiable\", which counts as "
        "holding; `agree` the share [%%] of agreement tests at 0.05 or more; `gross` the share [%%] of recordings "
        "called contaminated.\n\n| experiment | runs | N | sigma 1 | beta 1 | sigma 2 | beta 2 | agree | gross |\n"
        "|---|---|---|---|---|---|---|---|---|\n",
        100.0 * campaign::kOutlierShare, campaign::kOutlierSize);
  }
  static void TearDownTestSuite() {
    const double pooled = 100.0 * static_cast<double>(cells_inside) / static_cast<double>(cells);
    section->print("\nAll cells together: %.2f %%.\n", pooled);
    EXPECT_GE(pooled, 93.0);
    EXPECT_LE(pooled, 97.0);
    section.reset();
  }

  static inline std::unique_ptr<Section> section;
  static inline std::size_t cells_inside = 0;
  static inline std::size_t cells = 0;
};

}  // namespace

TEST_P(Campaign, TableHoldsTheTruth) {
  const std::size_t runs = repetitions(200);
  const campaign::Experiment experiment = campaign::experiments()[GetParam()];
  const std::string model = experiment.truth.size() == 3 ? "WN+2GM" : "WN+GM";
  std::vector<Tally> tally(2 * experiment.truth.size() - 1);
  std::size_t agree = 0;
  std::size_t gross = 0;
  for (std::size_t run = 0; run < runs; ++run) {
    const campaign::Row row = campaign::characterise_row(experiment, model, 52'000 + GetParam(), run);
    agree += row.agreement_p >= 0.05 ? 1 : 0;
    gross += static_cast<std::size_t>(row.contaminated);
    std::size_t k = 0;
    for (std::size_t p = 0; p < experiment.truth.size(); ++p) {
      for (std::size_t i = 0; i < experiment.truth[p].parameters.size(); ++i, ++k) {
        const FittedParameter& parameter = row.fit.processes[p].parameters[i];
        tally[k].inside += campaign::holds(parameter, experiment.truth[p].parameters[i]) ? 1 : 0;
        tally[k].unidentified += parameter.estimate ? 0 : 1;
      }
    }
  }
  const double percent = 100.0 / static_cast<double>(runs);
  section->print("| %s | %zu |", experiment.name.c_str(), runs);
  for (std::size_t k = 0; k < 5; ++k) {
    if (k >= tally.size()) {
      section->print(" |");
      continue;
    }
    const double coverage = percent * static_cast<double>(tally[k].inside);
    section->print(" %.1f", coverage);
    if (tally[k].unidentified > 0) {
      section->print(" (%.0f)", percent * static_cast<double>(tally[k].unidentified));
    }
    section->print(" |");
    cells_inside += tally[k].inside;
    cells += runs;
    EXPECT_GE(coverage, 90.0) << experiment.name << " parameter " << k;
    EXPECT_LE(coverage, 99.0) << experiment.name << " parameter " << k;
  }
  section->print(" %.1f | %.1f |\n", percent * static_cast<double>(agree), 0.5 * percent * static_cast<double>(gross));
}

INSTANTIATE_TEST_SUITE_P(Experiments, Campaign, testing::Range(std::size_t{0}, std::size_t{8}));

}  // namespace driftlab::accuracy
