// Operating characteristics of regression runs: wrong failures, wrong passes and power.
#include "tests/accuracy/regression_rig.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

namespace driftlab::accuracy {
namespace {

using regression::Row;

double at_margin_once(const Row& row) { return row.unit == 2 && row.octave == 4 ? row.margin : std::log(0.7); }
double at_margins(const Row& row) { return row.margin; }
double unchanged(const Row& /*row*/) { return 0.0; }

/// White noise of gyro y with its deviation larger by `share`.
Rig::Change white_noise(const Rig& rig, double share) {
  return [&rig, share](const Row& row) {
    const double m = std::exp2(row.octave);
    const double more = (1.0 + share) * (1.0 + share) - 1.0;
    return row.unit == 1 ? 0.5 * std::log(1.0 + more * rig.white(m) / rig.variance(m)) : 0.0;
  };
}

/// A process that was not there, of such a level that the deviation of gyro z grows by `share` at `octave`.
Rig::Change new_process(const Rig& rig, Process process, int octave, double share) {
  process.parameters[0] = 1.0;
  const double at = std::exp2(octave);
  const double level = ((1.0 + share) * (1.0 + share) - 1.0) * rig.variance(at) / process.haar_variance(at, Rig::kDt);
  return [&rig, process, level](const Row& row) {
    const double m = std::exp2(row.octave);
    return row.unit == 2 ? 0.5 * std::log(1.0 + level * process.haar_variance(m, Rig::kDt) / rig.variance(m)) : 0.0;
  };
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

struct Design {
  const char* name;
  Sessions sessions;
};

const Design kDesigns[] = {
    {"1 v 1", {1, 1, 0}}, {"1 v 1, 8 old sessions", {1, 1, 8}}, {"3 v 3", {3, 3, 0}}, {"5 v 5", {5, 5, 0}}};

}  // namespace

TEST(Accuracy, RegressionRunsKeepTheirPromises) {
  Section section("regression");
  section.print(
      "\n## Regression runs: wrong verdicts and power\n\nSix axes at 100 Hz, 15 min a session, rigs with ln k ~ N(0, "
      "0.5), sessions Student t5 by the law of the comparison (core/campaign/regression/session_scatter.hpp), one "
      "look. "
      "Shares [%%] of runs: pass / inconclusive / fail. Goals: wrong fail and wrong pass at most 5.\n\n| 15 min | runs "
      "|");
  for (const Design& design : kDesigns) {
    section.print(" %s |", design.name);
  }
  section.print("\n|---|---|---|---|---|---|\n");
  const Rig rig(900.0);
  const auto row = [&](const char* name, const Rig::Change& change, std::size_t runs, std::uint64_t seed, auto told,
                       const regression::TestSettings& settings) {
    section.print("| %s | %zu |", name, repetitions(runs));
    for (const Design& design : kDesigns) {
      told(design, run_many(rig, design.sessions, change, repetitions(runs), seed, settings));
    }
    section.print("\n");
  };
  const auto all = [&](const Design& /*design*/, const Shares& shares) {
    section.print(" %.1f / %.1f / %.1f |", shares.percent(shares.pass),
                  100.0 - shares.percent(shares.pass) - shares.percent(shares.fail), shares.percent(shares.fail));
  };
  const auto wrong_fail = [&](const Design& design, const Shares& shares) {
    all(design, shares);
    EXPECT_LE(shares.percent(shares.fail), 7.0) << design.name;
  };
  const auto wrong_pass = [&](const Design& design, const Shares& shares) {
    all(design, shares);
    EXPECT_LE(shares.percent(shares.pass), 7.0) << design.name;
  };
  const regression::TestSettings settings = table_settings();
  regression::TestSettings worse = settings;
  worse.fail_on_worse = true;
  row("unchanged", unchanged, 500, 101, wrong_fail, settings);
  row("unchanged, `fail_on: worse`", unchanged, 200, 102, all, worse);
  row("one scale of one axis at its margin, all others 30 % better", at_margin_once, 300, 103, wrong_pass, settings);
  row("all axes and scales at their margins", at_margins, 300, 104, wrong_fail, settings);
  row("white noise of one axis + 20 %", white_noise(rig, 0.2), 100, 105, all, settings);
  row("white noise of one axis + 50 %", white_noise(rig, 0.5), 100, 106, all, settings);
  const Process markov = *make_process("gauss_markov", {1.0, 1.0 / 0.32});
  row("new GM of 0.32 s, + 50 % at 0.64 s", new_process(rig, markov, 6, 0.5), 100, 107, all, settings);
  const Process walk = *make_process("random_walk", {1.0});
  row("new RW, + 50 % at 10 s", new_process(rig, walk, 10, 0.5), 100, 108, all, settings);

  section.print(
      "\nOther lengths, unchanged, %zu runs: pass / inconclusive / fail, median scope.\n\n| | 1 v 1 | 3 v 3 "
      "|\n|---|---|---|\n",
      repetitions(200));
  for (const auto& [name, seconds] : {std::pair{"5 min", 300.0}, std::pair{"60 min", 3600.0}}) {
    const Rig other(seconds);
    section.print("| %s |", name);
    for (const std::size_t n : {std::size_t{1}, std::size_t{3}}) {
      const Shares shares = run_many(other, {n, n, 0}, unchanged, repetitions(200), 109);
      section.print(" %.1f / %.1f / %.1f, %.2g s |", shares.percent(shares.pass),
                    100.0 - shares.percent(shares.pass) - shares.percent(shares.fail), shares.percent(shares.fail),
                    median(shares.scope_s));
    }
    section.print("\n");
  }
  section.print(
      "\nA rig more restless than the prior, unchanged, 15 min, %zu runs.\n\n| factor | 1 v 1 | 3 v 3 "
      "|\n|---|---|---|\n",
      repetitions(200));
  for (const double scale : {2.0, 3.0}) {
    section.print("| %.0f |", scale);
    for (const std::size_t n : {std::size_t{1}, std::size_t{3}}) {
      const Shares shares = run_many(rig, {n, n, 0}, unchanged, repetitions(200), 110, settings, scale);
      section.print(" %.1f / %.1f / %.1f |", shares.percent(shares.pass),
                    100.0 - shares.percent(shares.pass) - shares.percent(shares.fail), shares.percent(shares.fail));
    }
    section.print("\n");
  }
}

/// Whether a unit's trend over the releases warns, and how often its interval holds the truth.
TEST(Accuracy, ReleaseTrendsWarnOfDriftsAlone) {
  Section section("release trends");
  section.print(
      "\n## Drifts over releases\n\nThe same six axes, 5 min a session; gyro z drifts by so much a release, the other "
      "axes "
      "stay. Warnings at p < 0.01, intervals of 95 %%, scales to 1 s.\n\n| releases x sessions | drift | runs | "
      "warned: gyro "
      "z | warned: others | interval holds |\n|---|---|---|---|---|---|\n");
  const Rig rig(300.0);
  for (const auto& [releases, sessions, share] :
       {std::tuple{6U, 1U, 0.0}, {6U, 3U, 0.0}, {13U, 3U, 0.0}, {6U, 3U, 0.03}, {13U, 3U, 0.015}}) {
    const double step = std::log1p(share);
    std::size_t drifting = 0;
    std::size_t others = 0;
    std::size_t held = 0;
    const std::size_t runs = repetitions(200);
    for (std::size_t run = 0; run < runs; ++run) {
      Random random(120, run);
      const Releases drawn = draw_releases(rig, random, releases, sessions, [&](const Row& row, double release) {
        return row.unit == 2 ? step * release : 0.0;
      });
      const regression::Comparison comparison = regression::compare(drawn.design, table_settings());
      for (const regression::ReleaseTrend& trend : release_trends(
               drawn.design, scatter_terms(drawn.design), comparison.scatter, comparison.contrast, drawn.order, 1.0)) {
        if (trend.level) {
          continue;
        }
        const bool warned = trend.p < regression::kTrendWarning;
        (trend.unit == 2 ? drifting : others) += warned ? 1U : 0U;
        held += trend.ci95.contains(trend.unit == 2 ? step : 0.0) ? 1U : 0U;
      }
    }
    const auto count = static_cast<double>(runs);
    const double false_share = 100.0 * static_cast<double>(others) / (5.0 * count);
    section.print("| %u x %u | %.1f %% | %zu | %.1f %% | %.1f %% | %.1f %% |\n", releases, sessions, 100.0 * share,
                  runs, 100.0 * static_cast<double>(drifting) / count, false_share,
                  100.0 * static_cast<double>(held) / (6.0 * count));
    EXPECT_LE(false_share, 2.5);
  }
}

}  // namespace driftlab::accuracy
