// Several recordings together: agreement of replicates, one structure or several, trends over conditions.
#include "core/campaign/replicates.hpp"
#include "core/campaign/structure.hpp"
#include "core/campaign/trends.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/samples.hpp"
#include "tests/accuracy/campaign.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::accuracy {
namespace {

constexpr double kDt = 0.01;

WaveletRecord simulated(const Model& model, std::size_t samples, std::uint64_t seed, std::uint64_t stream) {
  Random random(seed, stream);
  const std::vector<double> x = simulate(model, random, kDt, samples);
  const HaarVariance curve = haar_variance(x, summarise(x)->mean);
  return {curve.half, curve.variance, {}, curve.samples, kDt};
}

/// Parameter `k` of process `p` times `factor`.
Model changed(Model model, std::size_t p, std::size_t k, double factor) {
  model[p].parameters[k] *= factor;
  return model;
}

double rejected(const Model& first, const Model& second, const ModelStructure& structure, std::size_t runs) {
  std::size_t count = 0;
  for (std::size_t run = 0; run < runs; ++run) {
    auto stack = Replicates::stack({simulated(first, 90000, 31'001, run), simulated(second, 90000, 31'002, run)});
    const Candidate joint = stack->fit(structure);
    count += stack->agreement(joint)->p < 0.05 ? 1 : 0;
  }
  return 100.0 * static_cast<double>(count) / static_cast<double>(runs);
}

/// Published models without their slow process, or as they are.
std::vector<Model> rate_models(bool with_slow) {
  std::vector<Model> models;
  for (const char* condition : {"static", "constant_rate:z:9:deg/s", "constant_rate:z:18:deg/s",
                                "constant_rate:z:36:deg/s", "constant_rate:z:120:deg/s"}) {
    models.push_back(campaign::published(condition));
    if (!with_slow) {
      models.back().pop_back();
    }
  }
  return models;
}

struct Verdicts {
  std::size_t one = 0;
  std::size_t changes = 0;
  std::size_t undecided = 0;
  std::size_t rejected = 0;  ///< p < 0.05 of the common best
};

Verdicts judge(const std::vector<Model>& conditions, std::size_t runs, std::uint64_t seed) {
  const std::vector<std::string> names = CharacteriseOptions{}.models;
  Verdicts verdicts;
  for (std::size_t run = 0; run < runs; ++run) {
    std::vector<std::vector<StructureScore>> scores;
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      auto stack = Replicates::stack(
          {simulated(conditions[c], 90000, seed + 2 * c, run), simulated(conditions[c], 90000, seed + 2 * c + 1, run)});
      std::vector<StructureScore> row;
      for (const std::string& name : names) {
        const Candidate fit = stack->fit(*parse_model(name));
        row.push_back({true, fit.criterion(stack->samples()), fit.log_fit->minimum(),
                       static_cast<double>(fit.log_fit->scales()) - static_cast<double>(fit.parameters)});
      }
      scores.push_back(std::move(row));
    }
    const StructureChoice choice = choose_structure(names, scores);
    verdicts.one += choice.verdict == StructureVerdict::OneStructure ? 1 : 0;
    verdicts.changes += choice.verdict == StructureVerdict::Changes ? 1 : 0;
    verdicts.undecided += choice.verdict == StructureVerdict::Undecided ? 1 : 0;
    verdicts.rejected += choice.p < 0.05 ? 1 : 0;
  }
  return verdicts;
}

}  // namespace

TEST(Accuracy, AgreementTestHoldsItsSize) {
  Section section("agreement");
  section.print(
      "\n## Agreement of replicates\n\nShare [%%] of pairs of 15 min at 100 Hz that the likelihood-ratio test rejects "
      "at 5 "
      "%%: both of the same model (size); one parameter of the second recording changed by 10 %% (power).\n\n| truth | "
      "runs | size | power, by parameter |\n|---|---|---|---|\n");
  const Model iphone = campaign::published("static");
  const Model fast{iphone[0], iphone[1]};
  Model walking = fast;
  walking.push_back(*make_process("random_walk", {4.2e-5}));
  const std::pair<const char*, Model> cases[] = {
      {"WN", {iphone[0]}}, {"WN+GM", fast}, {"WN+GM+RW", walking}, {"WN+2GM", iphone}};
  for (const auto& [name, model] : cases) {
    const ModelStructure structure = *parse_model(name);
    const std::size_t runs = repetitions(400);
    const double size = rejected(model, model, structure, runs);
    section.print("| %s | %zu | %.1f |", name, runs, size);
    for (std::size_t p = 0; p < model.size(); ++p) {
      for (std::size_t k = 0; k < model[p].parameters.size(); ++k) {
        section.print(" %s %.0f,", std::string(model[p].kind->parameters[k].name).c_str(),
                      rejected(model, changed(model, p, k, 1.1), structure, repetitions(50)));
      }
    }
    section.print(" |\n");
    EXPECT_NEAR(size, 5.0, 300.0 * std::sqrt(0.05 * 0.95 / static_cast<double>(runs))) << name;
  }
}

TEST(Accuracy, StructureVerdictIsSeldomWrong) {
  Section section("structure");
  section.print(
      "\n## One structure or several\n\nFive conditions with the iPhone values of Table 4 (static, 9, 18, 36, 120 "
      "deg/s), two "
      "recordings of 15 min each, nine candidates: verdicts [%%], and how often the best common structure is rejected "
      "at 5 "
      "%%. Where drift and random walk never occur together the structure changes; a random walk that happens to look "
      "like "
      "a drift as well in one of the three conditions that have it shows both, and speaks for one structure.\n\n| "
      "truth | "
      "runs | one structure | changes | undecided | rejected |\n|---|---|---|---|---|---|\n");
  struct Case {
    std::string name;
    std::vector<Model> conditions;
    bool one;
    bool sure;  ///< a change so large that it must mostly be seen
  };
  std::vector<Case> cases{{"WN+GM throughout", rate_models(false), true, true},
                          {"WN+2GM throughout", rate_models(true), true, true}};
  // The process at rest, and beside it a drift under two conditions, a random walk under three, of growing size. The
  // mean of half a recording scatters by 4e-5 rad/s at rest; in 900 s the smallest drift moves by 7e-5, the smallest
  // walk by 5e-5 (one standard deviation).
  for (const double size : {1.0 / 128.0, 1.0 / 64.0, 1.0 / 32.0, 1.0 / 16.0, 1.0 / 4.0, 1.0}) {
    std::vector<Model> mixed(5, rate_models(false).front());
    for (std::size_t c = 0; c < mixed.size(); ++c) {
      mixed[c].push_back(c < 2 ? *make_process("linear_drift", {1e-5 * size})
                               : *make_process("random_walk", {2e-4 * size}));
    }
    char name[120];
    (void)std::snprintf(name, sizeof name, "WN+GM+DR (R %.2g) at rest and 9 deg/s, WN+GM+RW (K %.2g) above",
                        1e-5 * size, 2e-4 * size);
    cases.push_back({name, std::move(mixed), false, size >= 1.0});
  }
  std::uint64_t seed = 83'000'000;
  for (const Case& one : cases) {
    const std::size_t runs = repetitions(60);
    const Verdicts verdicts = judge(one.conditions, runs, seed += 100);
    const double percent = 100.0 / static_cast<double>(runs);
    section.print("| %s | %zu | %.0f | %.0f | %.0f | %.0f |\n", one.name.c_str(), runs,
                  percent * static_cast<double>(verdicts.one), percent * static_cast<double>(verdicts.changes),
                  percent * static_cast<double>(verdicts.undecided), percent * static_cast<double>(verdicts.rejected));
    if (one.one) {
      EXPECT_LE(verdicts.changes, runs / 10 + 1) << one.name;
    } else if (one.sure) {
      EXPECT_GE(verdicts.changes, runs / 2) << one.name;
    }
  }
}

TEST(Accuracy, TrendsHoldTheirSize) {
  Section section("trends");
  section.print(
      "\n## Trends over six conditions\n\nShare [%%] of 2,000 series (0, 9, 18, 36, 72, 120 deg/s; each value known to "
      "2 %%): "
      "equality rejected, arrow shown; the relation chosen; interval of the relation at 54 deg/s holding the parameter "
      "there.\n\n| truth | equality rejected | arrow | constant / linear / power | interval holds "
      "|\n|---|---|---|---|---|\n");
  struct Case {
    const char* name;
    double spread;
    double slope;  ///< of the value from 0 to 120 deg/s, relative
    double exponent;
  };
  constexpr double kAt[] = {0.0, 9.0, 18.0, 36.0, 72.0, 120.0};
  for (const Case& one : {Case{"constant", 0.0, 0.0, 1.0}, Case{"constant, 20 % spread", 0.2, 0.0, 1.0},
                          Case{"linear, +50 %", 0.0, 0.5, 1.0}, Case{"linear, +200 %, 20 % spread", 0.2, 2.0, 1.0},
                          Case{"square, +200 %", 0.0, 2.0, 2.0}, Case{"root, +200 %", 0.0, 2.0, 0.5}}) {
    const std::size_t runs = repetitions(2000);
    std::size_t moved = 0;
    std::size_t arrows = 0;
    std::size_t chosen[3] = {0, 0, 0};
    std::size_t inside = 0;
    for (std::size_t run = 0; run < runs; ++run) {
      Random random(47'110, run);
      const auto truth = [&](double w) {
        return (1.0 + one.slope * std::pow(w / 120.0, one.exponent)) * std::exp(one.spread * random.normal());
      };
      std::vector<TrendPoint> points;
      for (const double w : kAt) {
        const double value = truth(w) * std::exp(0.02 * random.normal());
        const double reach = std::exp(1.96 * 0.02);
        points.push_back({w, {value, {value / reach, value * reach}}});
      }
      const Trend trend = *fit_trend(std::move(points));
      moved += trend.equal_p < 0.05 ? 1 : 0;
      arrows += trend.direction != 0 ? 1 : 0;
      ++chosen[static_cast<std::size_t>(trend.relation.relation)];
      inside += value_at(trend, 54.0).estimate.ci95.contains(truth(54.0)) ? 1 : 0;
    }
    const double percent = 100.0 / static_cast<double>(runs);
    section.print("| %s | %.1f | %.1f | %.0f / %.0f / %.0f | %.1f |\n", one.name, percent * static_cast<double>(moved),
                  percent * static_cast<double>(arrows), percent * static_cast<double>(chosen[0]),
                  percent * static_cast<double>(chosen[1]), percent * static_cast<double>(chosen[2]),
                  percent * static_cast<double>(inside));
    const double error = 300.0 * std::sqrt(0.05 * 0.95 / static_cast<double>(runs));
    if (one.slope == 0.0) {
      EXPECT_LT(percent * static_cast<double>(arrows), 5.0 + error) << one.name;
    }
    EXPECT_GT(percent * static_cast<double>(inside), 90.0 - error) << one.name;
  }
}

}  // namespace driftlab::accuracy
