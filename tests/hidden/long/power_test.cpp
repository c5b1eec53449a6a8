/// The table of tests/hidden/RESULTS.md: power, confusion, interval coverage and false alarms of `investigate` on its
/// own simulator. Run by ./tests/run.sh --long, or by itself: accuracy_hidden [seeds per cell] [nulls]
#include "core/investigate/investigate.hpp"
#include "tests/hidden/simulated_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>

namespace driftlab::hidden {
namespace {

using namespace investigate;

std::size_t number_from(const char* name, std::size_t otherwise) {
  const char* const text = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): tests run one thread
  return text == nullptr ? otherwise : static_cast<std::size_t>(std::strtoul(text, nullptr, 10));
}

bool names(const Finding& finding, const std::string& cause) {
  if (finding.evidence.cause->name == cause) {
    return true;
  }
  return finding.evidence.ambiguous && std::any_of(finding.evidence.rivals.begin(), finding.evidence.rivals.end(),
                                                   [&](const Evidence& rival) { return rival.cause->name == cause; });
}

struct Cell {
  int cases = 0, named = 0, missed = 0, intervals = 0, holding = 0, gained = 0;
};

TEST(HiddenEffects, PowerAgainstSize) {
  const std::size_t seeds = number_from("DRIFTLAB_HIDDEN_SEEDS", 4);
  std::map<std::string, std::map<std::string, int>> confusion;
  double named = 0.0;
  double strong = 0.0;
  double total = 0.0;
  double total_strong = 0.0;
  double intervals = 0.0;
  double holding = 0.0;
  std::printf("| cause | z = 6 | z = 12 | z = 30 | intervals that hold |\n|---|---|---|---|---|\n");
  for (const Cause& cause : cause_registry()) {
    std::map<double, Cell> cells;
    Cell all;
    for (const double z : {6.0, 12.0, 30.0}) {
      Cell& cell = cells[z];
      for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const Case hidden = make_case(std::string(cause.name), z, 1000 * seed + static_cast<std::uint64_t>(z));
        const SimulatedStudy simulated = simulate_study(hidden.world, {hidden.effect});
        const auto report = investigate::investigate(simulated.study);
        ++cell.cases;
        if (!report || report->findings.empty()) {
          ++cell.missed;
          confusion[std::string(cause.name)]["(nothing)"]++;
          continue;
        }
        const Finding& first = report->findings.front();
        if (!names(first, std::string(cause.name))) {
          confusion[std::string(cause.name)][std::string(first.evidence.cause->name)]++;
          continue;
        }
        ++cell.named;
        cell.gained += first.gain.heldout && first.gain.log_score_per_sample > 0.0 ? 1 : 0;
        for (std::size_t k = 0; k < cause.parameters.size() && k < hidden.effect.values.size(); ++k) {
          for (const FoundParameter& found : first.evidence.parameters) {
            if (found.name == cause.parameters[k].name && first.evidence.cause == &cause) {
              ++all.intervals;
              const double margin = 1e-9 * std::abs(hidden.effect.values[k]);
              const Interval ci = found.estimate.ci95;
              all.holding += ci.low - margin <= hidden.effect.values[k] && hidden.effect.values[k] <= ci.high + margin;
            }
          }
        }
      }
      named += cell.named;
      total += cell.cases;
    }
    strong += cells[30.0].named;
    total_strong += cells[30.0].cases;
    intervals += all.intervals;
    holding += all.holding;
    std::printf("| %s | %d/%d | %d/%d | %d/%d | %d/%d |\n", std::string(cause.name).c_str(), cells[6.0].named,
                cells[6.0].cases, cells[12.0].named, cells[12.0].cases, cells[30.0].named, cells[30.0].cases,
                all.holding, all.intervals);
    std::fflush(stdout);
  }
  std::printf("\nNamed %.3f of all, %.3f of the strong; intervals that hold the truth %.3f.\n\nSaid instead:\n\n",
              named / total, strong / total_strong, holding / std::max(1.0, intervals));
  for (const auto& [cause, said] : confusion) {
    std::printf("- %s:", cause.c_str());
    for (const auto& [other, times] : said) {
      std::printf(" %s %d", other.c_str(), times);
    }
    std::printf("\n");
  }
  EXPECT_GE(strong / total_strong, 0.9);
}

TEST(HiddenEffects, SilenceWithoutThem) {
  const std::size_t nulls = number_from("DRIFTLAB_HIDDEN_NULLS", 400);
  std::map<std::string, int> alarms;
  std::map<std::string, std::pair<int, int>> by_base;  // studies, alarms
  int alarmed = 0;
  int unexplained = 0;
  for (std::uint64_t seed = 1; seed <= nulls; ++seed) {
    World world;
    world.seed = 500000 + seed;
    world.scenario = static_cast<Scenario>(seed % 9);
    world.given = (seed / 9) % 2 == 1;
    world.accelerometer = world.scenario == Scenario::Static && seed % 4 == 0;
    world.rate_hz = seed % 3 == 0 ? 100.0 : seed % 3 == 1 ? 50.0 : 25.0;
    world.duration_s = seed % 5 == 0 ? 400.0 : 600.0;
    const SimulatedStudy simulated = simulate_study(world, {});
    const auto report = investigate::investigate(simulated.study);
    ASSERT_TRUE(report);
    auto& [studies, alarms_here] = by_base[simulated.base.name + (world.given ? ", given" : ", auto")];
    ++studies;
    alarms_here += report->findings.empty() ? 0 : 1;
    alarmed += report->findings.empty() ? 0 : 1;
    unexplained += report->unexplained.empty() ? 0 : 1;
    for (const Finding& finding : report->findings) {
      alarms[std::string(finding.evidence.cause->name)]++;
      std::printf("null %d scenario %d %s base %s: %s %.1f\n", static_cast<int>(seed), static_cast<int>(world.scenario),
                  world.given ? "given" : "auto", simulated.base.name.c_str(),
                  std::string(finding.evidence.cause->name).c_str(), finding.evidence.score);
      std::fflush(stdout);
    }
  }
  std::printf("\n%d of %d studies without effect have a finding, %d an unexplained misfit:", alarmed,
              static_cast<int>(nulls), unexplained);
  for (const auto& [cause, times] : alarms) {
    std::printf(" %s %d", cause.c_str(), times);
  }
  std::printf("\n\n| base model and baseline | studies | with a finding |\n|---|---|---|\n");
  for (const auto& [name, counts] : by_base) {
    std::printf("| %s | %d | %d |\n", name.c_str(), counts.first, counts.second);
  }
  // 5 % and two standard errors of the count.
  const double n = static_cast<double>(nulls);
  EXPECT_LE(alarmed, 0.05 * n + 2.0 * std::sqrt(0.05 * 0.95 * n));
}

TEST(HiddenEffects, EightQuartersOfAnHourTakeSeconds) {
  World world;
  world.seed = 777;
  world.scenario = Scenario::Rates;
  world.rate_hz = 50.0;
  world.duration_s = 900.0;
  SimulatedStudy simulated = simulate_study(world, {{"scale_factor_error", {2e-4}, {}}});
  // Two recordings more than the scenario has: the first two again, by other names.
  for (std::size_t r = 0; simulated.study.recordings.size() < 8; ++r) {
    simulated.study.recordings.push_back(simulated.study.recordings[r]);
    simulated.study.recordings.back().id.append("-again");
  }
  InvestigateOptions two;
  two.predict_outages = false;
  two.threads = 2;
  const auto began = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  const auto report = investigate::investigate(simulated.study, two);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  const double cpu_s = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  ASSERT_TRUE(report);
  std::printf("\nEight recordings of 900 s at 50 Hz: %.1f s with two threads, %.1f s of CPU.\n", took.count(), cpu_s);
  EXPECT_LE(cpu_s, 20.0);  // 10 s on two cores, however busy they are
}

}  // namespace
}  // namespace driftlab::hidden
