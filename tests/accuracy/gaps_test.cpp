// Recordings with gaps, characterised as one: do the intervals hold the truth, and what do the gaps cost?
#include "core/fit/characterise.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace driftlab::accuracy {
namespace {

constexpr double kDt = 0.01;
constexpr std::size_t kSamples = std::size_t{1} << 15U;

struct Loss {
  const char* name;
  std::vector<std::pair<std::size_t, std::size_t>> lost;  ///< places [first, last)
};

std::vector<Loss> losses() {
  std::vector<Loss> all{{"nothing", {}}, {"one gap of 2 %", {{20000, 20655}}}, {"one gap of 15 %", {{11000, 15915}}}};
  Loss bursts{"5 % in gaps of 50", {}};
  for (std::size_t at = 950; at + 50 < kSamples; at += 1000) {
    bursts.lost.push_back({at, at + 50});
  }
  Loss single{"1 % one by one", {}};
  for (std::size_t at = 77; at < kSamples; at += 100) {
    single.lost.push_back({at, at + 1});
  }
  all.push_back(std::move(bursts));
  all.push_back(std::move(single));
  return all;
}

/// What is left of a series.
struct Left {
  std::vector<double> rows;
  std::vector<Gap> gaps;
};

Left without(const std::vector<double>& x, const Loss& loss) {
  Left left;
  std::size_t from = 0;
  for (const auto& [first, last] : loss.lost) {
    left.rows.insert(left.rows.end(), x.begin() + static_cast<std::ptrdiff_t>(from),
                     x.begin() + static_cast<std::ptrdiff_t>(first));
    left.gaps.push_back({left.rows.size(), last - first});
    from = last;
  }
  left.rows.insert(left.rows.end(), x.begin() + static_cast<std::ptrdiff_t>(from), x.end());
  return left;
}

struct Truth {
  const char* name;
  Model model;
};

}  // namespace

TEST(Accuracy, IntervalsHoldTheTruthThroughGaps) {
  Section section("gaps");
  section.print(
      "\n## Recordings with gaps\n\n%zu places at 100 Hz, characterised as one recording: coverage [%%] of the 95 %% "
      "intervals of the wavelet variances (lowest-highest over scales of up to 4096 samples, edf 8 and more) and of "
      "the "
      "parameters of the true model; the clean recordings called contaminated [%%].\n\n| truth | lost | runs | "
      "variances "
      "| parameters | contaminated |\n|---|---|---|---|---|---|\n",
      kSamples);
  const std::vector<Truth> truths{{"WN+RW", model_of({{"white_noise", {0.0172}}, {"random_walk", {0.0024}}})},
                                  {"WN+GM", model_of({{"white_noise", {0.0172}}, {"gauss_markov", {0.0442, 1.71}}})}};
  std::uint64_t seed = 71'000'000;
  for (const Truth& truth : truths) {
    for (const Loss& loss : losses()) {
      const std::size_t runs = repetitions(200);
      std::vector<std::size_t> held;
      std::vector<std::pair<std::string, std::size_t>> parameters;
      std::size_t contaminated = 0;
      ++seed;
      for (std::size_t run = 0; run < runs; ++run) {
        Random random(seed, run);
        const Left left = without(simulate(truth.model, random, kDt, kSamples), loss);
        const auto found =
            characterise_channel({.values = left.rows, .dt_s = kDt, .gaps = left.gaps}, {.models = {truth.name}});
        ASSERT_TRUE(found) << found.error().message;
        contaminated += found->contamination.verdict == "contaminated" ? 1 : 0;
        held.resize(12);
        for (std::size_t j = 0; j < held.size(); ++j) {
          const std::size_t half = found->haar.scale[j] / 2;
          double variance = 0.0;
          for (const Process& process : truth.model) {
            variance += process.haar_variance(static_cast<double>(half), kDt);
          }
          held[j] += found->haar.ci95[j].contains(variance) ? 1 : 0;
        }
        std::size_t k = 0;
        for (std::size_t p = 0; p < truth.model.size(); ++p) {
          for (std::size_t i = 0; i < truth.model[p].parameters.size(); ++i, ++k) {
            const FittedParameter& parameter = found->fits[0].processes[p].parameters[i];
            parameters.resize(std::max(parameters.size(), k + 1));
            parameters[k].first = parameter.declared->name;
            const double value = truth.model[p].parameters[i];
            const bool inside =
                parameter.estimate ? parameter.estimate->ci95.contains(value) : value <= parameter.upper_limit;
            parameters[k].second += inside ? 1 : 0;
          }
        }
      }
      const double percent = 100.0 / static_cast<double>(runs);
      const auto [least, most] = std::minmax_element(held.begin(), held.end());
      section.print("| %s | %s | %zu | %.1f-%.1f |", truth.name, loss.name, runs, percent * static_cast<double>(*least),
                    percent * static_cast<double>(*most));
      // Twelve scales and three parameters: below three and a half standard errors of 95 % is a defect.
      const double error = 350.0 * std::sqrt(0.05 * 0.95 / static_cast<double>(runs));
      EXPECT_GT(percent * static_cast<double>(*least), 93.0 - error) << truth.name << ", " << loss.name;
      for (const auto& [name, inside] : parameters) {
        section.print(" %s %.1f,", name.c_str(), percent * static_cast<double>(inside));
        EXPECT_GT(percent * static_cast<double>(inside), 93.0 - error)
            << truth.name << ", " << loss.name << ": " << name;
      }
      section.print(" | %.1f |\n", percent * static_cast<double>(contaminated));
    }
  }
}

}  // namespace driftlab::accuracy
