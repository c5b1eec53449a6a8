// Is it one noise? False alarms of the test on stationary noise, and what it finds of jumps and changes of level.
#include "core/fit/stationarity.hpp"

#include "core/process/model.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

namespace driftlab::accuracy {
namespace {

constexpr double kDt = 0.01;

using Series = std::vector<double>;

struct Case {
  std::string name;
  std::function<Series(Random&, std::size_t)> make;
  double power_at_12000 = 0.0;  ///< least share to be found there; 0: stationary, at most 1 % false alarms
};

Series white(Random& random, std::size_t count) {
  Series x(count);
  for (double& value : x) {
    value = random.normal();
  }
  return x;
}

Case of_model(const char* name, const std::vector<std::pair<const char*, std::vector<double>>>& parts) {
  return {name,
          [model = model_of(parts)](Random& random, std::size_t count) { return simulate(model, random, kDt, count); }};
}

/// Each sample of the second half times `factor`, plus `step`.
Case changed(const char* name, double factor, double step, double power) {
  return {name,
          [=](Random& random, std::size_t count) {
            Series x = white(random, count);
            for (std::size_t i = count / 2; i < count; ++i) {
              x[i] = factor * x[i] + step;
            }
            return x;
          },
          power};
}

std::vector<Case> cases() {
  std::vector<Case> all{
      of_model("WN", {{"white_noise", {0.1}}}),
      of_model("QN", {{"quantization_noise", {0.01}}}),
      of_model("RW", {{"random_walk", {1.0}}}),
      of_model("flicker", {{"flicker_noise", {1.0}}}),
      of_model("WN+flicker", {{"white_noise", {0.1}}, {"flicker_noise", {0.3}}}),
      of_model("WN+GM", {{"white_noise", {0.1}}, {"gauss_markov", {1.0, 1.7}}}),
      of_model("slow GM", {{"white_noise", {0.03}}, {"gauss_markov", {1.0, 0.1}}}),
      of_model("WN+GM+RW", {{"white_noise", {0.1}}, {"gauss_markov", {1.0, 1.7}}, {"random_walk", {0.05}}}),
  };
  all.push_back({"WN with 1 % of gross errors", [](Random& random, std::size_t count) {
                   Series x = white(random, count);
                   for (double& value : x) {
                     value += random.uniform() < 0.01 ? 50.0 * random.normal() : 0.0;
                   }
                   return x;
                 }});
  all.push_back({"WN on a lattice of 2.5 sd", [](Random& random, std::size_t count) {
                   Series x = white(random, count);
                   for (double& value : x) {
                     value = std::round(0.4 * value);
                   }
                   return x;
                 }});
  all.push_back({"GARCH(.1, .85)", [](Random& random, std::size_t count) {
                   Series x = white(random, count);
                   double variance = 1.0;
                   for (double& value : x) {
                     value *= std::sqrt(variance);
                     variance = 0.05 + 0.1 * value * value + 0.85 * variance;
                   }
                   return x;
                 }});
  all.push_back(changed("jump of 50 sd", 1.0, 50.0, 0.99));
  all.push_back(changed("jump of 2 sd", 1.0, 2.0, 0.99));
  all.push_back(changed("level x 1.2", 1.2, 0.0, 0.85));
  all.push_back(changed("level x 1.1 (variance x 1.21)", 1.1, 0.0, 0.1));
  return all;
}

}  // namespace

TEST(Accuracy, OneNoiseIsCalledOneAndSeveralAreNot) {
  Section section("stationarity");
  section.print(
      "\n## One noise, or several\n\nShare of records [%%] of which the test says that they are not one noise; above, "
      "of "
      "noise that is one throughout (false alarms); below, of white noise that changes in the middle, with the mean "
      "distance [%% of the record] of the first change from there.\n\n| noise | runs | 3,000 samples | 12,000 | 90,000 "
      "|\n|---|---|---|---|---|\n");
  std::uint64_t seed = 95'000'000;
  for (const Case& one : cases()) {
    const std::size_t runs = repetitions(400);
    section.print("| %s | %zu |", one.name.c_str(), runs);
    for (const std::size_t count : {std::size_t{3000}, std::size_t{12000}, std::size_t{90000}}) {
      ++seed;
      std::size_t said = 0;
      double off = 0.0;
      for (std::size_t run = 0; run < runs; ++run) {
        Random random(seed, run);
        const Stationarity found = test_stationarity(one.make(random, count), kDt);
        if (!found.changes.empty()) {
          ++said;
          off += std::abs(static_cast<double>(found.changes.front().sample) / static_cast<double>(count) - 0.5);
        }
      }
      const double share = static_cast<double>(said) / static_cast<double>(runs);
      section.print(" %.1f", 100.0 * share);
      if (one.power_at_12000 > 0.0 && said > 0) {
        section.print(" (%.1f)", 100.0 * off / static_cast<double>(said));
      }
      section.print(" |");
      const double error = 3.5 * std::sqrt(0.01 * 0.99 / static_cast<double>(runs));
      if (one.power_at_12000 == 0.0) {
        EXPECT_LT(share, 0.01 + error) << one.name << ", " << count;
      } else if (count >= 12000) {
        EXPECT_GE(share, one.power_at_12000) << one.name << ", " << count;
      }
    }
    section.print("\n");
  }
}

}  // namespace driftlab::accuracy
