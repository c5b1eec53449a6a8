// Causes put into a recorded drive and sought again; what arm and clock a search finds where both are known.
#include "core/navigate/drive/joint_top.hpp"
#include "core/navigate/drive/profile.hpp"
#include "core/navigate/drive/rest_correlation.hpp"
#include "core/navigate/drive/simulation.hpp"
#include "core/navigate/drive/vibration_thirds.hpp"
#include "tests/accuracy/recorded_injections.hpp"
#include "tests/accuracy/section.hpp"
#include "tests/unit/navigate/recorded_car.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::accuracy {
namespace {

/// The options that the recording's own search ends at, from the delay that the fixes show.
FilterOptions refitted(const Drive& recorded, bool constraint) {
  FilterOptions options = options_of(recorded.document);
  options.odometer = !recorded.odometer.empty();
  if (constraint) {
    options.constraint.emplace();
  }
  options.velocity_latency_s = velocities_late_s(recorded);
  const auto found = drive::search_causes(recorded, options, 10);
  EXPECT_TRUE(found) << found.error().message;
  return found ? found->options : options;
}

/// What is said of a drive beyond what it was before something was put in, in the order of an explanation: by the
/// files, by the search, levels. Values are changes; of a level, the factor.
std::vector<drive::DriveFinding> named(const Drive& before, const Drive& changed, const FilterOptions& base) {
  std::vector<drive::DriveFinding> all;
  const auto without_base = [&](drive::DriveFinding finding) {
    const drive::Knob* const knob = drive::find_knob(finding.cause, finding.parameter);
    finding.value -= knob != nullptr ? knob->value(base) * knob->per_si : 0.0;
    return finding;
  };
  FilterOptions options = base;
  for (const drive::Cause& cause : drive::cause_registry()) {
    auto found = cause.from_files != nullptr ? cause.from_files(changed, options) : std::nullopt;
    if (!found) {
      continue;
    }
    found->finding.cause = cause.name;
    if (const auto known = cause.from_files(before, base)) {
      found->finding.value -= known->finding.value;
      if (std::abs(found->finding.value) <= 3.0 * std::hypot(found->finding.se, known->finding.se)) {
        continue;
      }
    }
    if (found->use) {
      found->use(options);
    }
    all.push_back(without_base(found->finding));
  }
  const auto search = drive::search_causes(changed, options, 1);
  EXPECT_TRUE(search) << search.error().message;
  if (!search) {
    return all;
  }
  std::transform(search->findings.begin(), search->findings.end(), std::back_inserter(all), without_base);
  const RunControl control;
  const drive::Profile profile(changed, {true, true}, control);
  for (const drive::Cause& cause : drive::cause_registry()) {
    for (const drive::NoiseLevel& level : cause.levels) {
      FilterOptions without = search->options;
      without.*level.factor = base.*level.factor;
      const auto sums = profile.values({search->options, without});
      drive::DriveFinding finding;
      finding.cause = cause.name;
      finding.parameter = level.parameter;
      finding.value = search->options.*level.factor / base.*level.factor;
      finding.score = (sums[0] - sums[1]) / profile.scale(search->options);
      if ((finding.value > level.named_from || finding.value < 1.0 / level.named_from) && finding.score >= 5.0) {
        all.push_back(finding);
      }
    }
  }
  return all;
}

std::string row_of(const std::string& put, const std::vector<drive::DriveFinding>& all) {
  std::string names;
  std::array<char, 200> text{};
  for (const drive::DriveFinding& found : all) {
    (void)std::snprintf(text.data(), text.size(), "%s%s (%s)%s %.3g +- %.2g %s, score %.0f", names.empty() ? "" : "; ",
                        found.cause.c_str(), found.parameter.c_str(),
                        found.pair.empty() ? "" : (" or " + found.pair).c_str(), found.value, found.se,
                        found.unit.c_str(), found.score);
    names += text.data();
  }
  return "| " + put + " | " + (names.empty() ? "nothing" : names) + " |\n";
}

Drive on(const Drive& recorded, Ground ground) {
  Drive drive = recorded;
  if (ground == Ground::WithOdometer) {
    add_odometer(drive);
  }
  if (ground == Ground::HeadingStated) {
    state_heading(drive);
  }
  return drive;
}

}  // namespace

TEST(Accuracy, CausesPutIntoARecordedDriveAreNamedFirst) {
  const auto recorded = drive::recorded_car();
  if (!recorded) {
    GTEST_SKIP();
  }
  Section section("recorded_drives");
  section.print(
      "\n## Causes put into a recorded drive\n\nrtk-car-0708 with the values that its own search ends at; one cause is "
      "put into readings, fixes, odometer or document, and the search goes on from there for one more. Values are "
      "changes; of a level, the factor.\n\n| put in | named, in this order |\n|---|---|\n");
  for (const auto& [ground, with] :
       {std::pair{Ground::AsRecorded, ""}, std::pair{Ground::Constrained, " (velocity constraints)"},
        std::pair{Ground::WithOdometer, " (an odometer)"}, std::pair{Ground::HeadingStated, " (heading stated)"}}) {
    const Drive before = on(*recorded, ground);
    const FilterOptions base = refitted(before, ground == Ground::Constrained);
    const auto nothing = named(before, before, base);
    section.print("%s", row_of(std::string("nothing") + with, nothing).c_str());
    EXPECT_TRUE(nothing.empty()) << with;
    for (const Injected& one : recorded_injections()) {
      if (one.ground != ground) {
        continue;
      }
      Drive changed = before;
      one.put(changed, base, one.size);
      const drive::Knob* const knob = drive::find_knob(one.cause, one.parameter);
      const double put = one.change ? one.change(base, one.size) : one.size * (knob != nullptr ? knob->per_si : 1.0);
      const auto all = named(before, changed, base);
      std::array<char, 100> words{};
      (void)std::snprintf(words.data(), words.size(), "%s (%s) %.3g%s", one.cause, one.parameter, put, with);
      section.print("%s", row_of(words.data(), all).c_str());
      const auto found = std::find_if(all.begin(), all.end(), [&](const drive::DriveFinding& finding) {
        return finding.cause == one.cause && finding.parameter == one.parameter;
      });
      if (found == all.end()) {
        ADD_FAILURE() << words.data() << " has no name";
        continue;
      }
      const bool of_level = !drive::find_cause(one.cause)->levels.empty();  // a level is named last
      EXPECT_TRUE(found == all.begin() || of_level) << words.data();
      EXPECT_LT(std::abs(found->value - put), std::max({0.2 * std::abs(put), 3.0 * found->se, one.within}))
          << words.data();
    }
  }
}

/// What a search for clock, velocities' delay and arm ends at, on drives simulated along the recording's path with an
/// arm of 0.59 m, and with what a filter could mistake for another arm.
TEST(Accuracy, TheArmOfADriveAlongTheRecordedPathIsFound) {
  const auto recorded = drive::recorded_car();
  if (!recorded) {
    GTEST_SKIP();
  }
  Section section("recorded_arm");
  FilterOptions base = refitted(*recorded, false);
  base.imu_offset_s = -0.133;
  base.lever_arm_m = Vector3(0.59, 0.0, 0.0);
  const auto prepared = drive::PreparedDrive::make(*recorded, base);
  ASSERT_TRUE(prepared);
  const auto world = drive::SimulatedWorld::make(*prepared, 0);
  ASSERT_TRUE(world) << world.error().message;
  section.print(
      "\n| simulated along the path, arm 0.59 m, clock 0 s | arm x [m] | se alone | se | clock [s] | se alone | se "
      "|\n|---|---|---|---|---|---|---|\n");
  const std::vector<const drive::Knob*> knobs{
      drive::find_knob("imu_time_offset", "delta_s"), drive::find_knob("gnss_lever_arm", "x"),
      drive::find_knob("gnss_lever_arm", "y"), drive::find_knob("gnss_velocity_latency", "delay_s")};
  struct Case {
    const char* name;
    double gyro_late_s, mean_velocity_s;
    bool must_find;
  };
  for (const Case& one :
       {Case{"as the filter believes", 0.0, 0.0, true}, Case{"velocities are means over 0.25 s", 0.0, 0.25, false},
        Case{"gyroscope 50 ms later than accelerometer", 0.05, 0.0, false},
        Case{"gyroscope 50 ms earlier", -0.05, 0.0, false}}) {
    auto drawn = world->draw(7, 0);
    Drive simulated = std::move(drawn.drive);
    drive::UniformRun& run = simulated.runs.front();
    if (one.gyro_late_s != 0.0) {
      const auto shift = static_cast<std::ptrdiff_t>(std::lround(one.gyro_late_s / run.dt_s));
      const auto readings = run.readings;
      for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(readings.size()); ++i) {
        const auto from = std::clamp<std::ptrdiff_t>(i - shift, 0, static_cast<std::ptrdiff_t>(readings.size()) - 1);
        for (std::size_t c = 0; c < 3; ++c) {
          run.readings[static_cast<std::size_t>(i)][c] = readings[static_cast<std::size_t>(from)][c];
        }
      }
    }
    if (one.mean_velocity_s > 0.0) {
      const std::vector<Fix> exact = simulated.fixes;
      for (Fix& fix : simulated.fixes) {
        Vector3 sum = Vector3::Zero();
        int count = 0;
        for (int k = 0; k < 5; ++k) {
          if (const auto at = velocity_at(exact, fix.time_s - one.mean_velocity_s * (k + 0.5) / 5.0)) {
            sum += *at;
            ++count;
          }
        }
        if (count == 5) {
          fix.velocity_ned_m_s = sum / 5.0;
        }
      }
    }
    FilterOptions options = world->options();
    options.lever_arm_m.setZero();
    const RunControl control;
    const drive::Profile profile(simulated, {true, true}, control);
    options = profile.refitted(options, knobs, 6);
    const double scale = profile.scale(options);
    const auto alone = profile.estimates(options, profile.values({options}).front(), knobs, scale);
    std::vector<double> steps;
    std::transform(alone.begin(), alone.end(), std::back_inserter(steps),
                   [](const drive::ProfileEstimate& estimate) { return estimate.scatter; });
    const drive::JointTop together(profile, options, knobs, steps, scale);
    section.print("| %s | %.3f | %.3f | %.3f | %.4f | %.4f | %.4f |\n", one.name, options.lever_arm_m.x(), alone[1].se,
                  together.se(1), options.imu_offset_s, alone[0].se, together.se(0));
    if (one.must_find) {
      EXPECT_NEAR(options.lever_arm_m.x(), 0.59, 0.06);
      EXPECT_NEAR(options.imu_offset_s, 0.0, 0.01);
    }
  }
}

// What tells the noise that follows the vibration, and lasting errors of positions, apart from everything else.
TEST(Accuracy, TheRecordedDriveErrsMoreWhereItIsShaken) {
  const auto recorded = drive::recorded_car();
  if (!recorded) {
    GTEST_SKIP();
  }
  Section section("recorded_drives");
  section.print("\n## Vibration and rest\n\nrtk-car-0708, by the values that its own search ends at.\n\n");
  const auto rest = drive::rest_correlation(*recorded);
  ASSERT_TRUE(rest);
  section.print("At rest (%zu times, %.0f s in all) positions correlate by %.2f after 1 s and by 1/e after %.1f s.\n\n",
                rest->rests, rest->seconds, rest->after_1s, rest->lasts_s.value_or(0.0));
  section.print(
      "| outages of 10 s in thirds by the gyroscope's power above 5 Hz | calm | middle | shaken "
      "|\n|---|---|---|---|\n");
  const FilterOptions found = refitted(*recorded, false);
  FilterOptions even = found;
  even.gyro_vibration = even.force_vibration = 0.0;
  const RunControl control;
  even = drive::Profile(*recorded, {true, true}, control).with_noise_fitted(even, 1.2);
  for (const auto& [name, options] : {std::pair{"rms [m], noise that is even", even},
                                      {"rms [m], noise that follows the vibration", found},
                                      {"rms [m], velocity constraints beside it", refitted(*recorded, true)}}) {
    const auto evaluation = drive::evaluate_drive(*recorded, options, {.resamples = 0});
    ASSERT_TRUE(evaluation) << evaluation.error().message;
    const auto thirds = drive::errors_by_vibration(*recorded, evaluation->durations.front());
    ASSERT_TRUE(thirds);
    if (std::string_view(name).ends_with("even")) {
      section.print("| power over its mean | %.2f | %.2f | %.2f |\n", thirds->power[0], thirds->power[1],
                    thirds->power[2]);
    }
    section.print("| %s | %.2f | %.2f | %.2f |\n", name, thirds->rms_m[0], thirds->rms_m[1], thirds->rms_m[2]);
    EXPECT_GT(thirds->rms_m[2], thirds->rms_m[0]) << name;
  }
}

// How long a gate that believes the receiver again remembers those that disagreed (core/navigate/drive/fix_gate.hpp).
TEST(Accuracy, TheGatesMemoryDecidesLittleOnARecordedDrive) {
  const auto recorded = drive::recorded_car();
  if (!recorded) {
    GTEST_SKIP();
  }
  Section section("recorded_drives");
  section.print(
      "\n## Memory of the gate\n\nrtk-car-0708, the data sheet's model, gate 25.\n\n| fixes remembered | rejected | "
      "rms "
      "after 10, 30, 60 s [m] |\n|---|---|---|\n");
  double least = std::numeric_limits<double>::infinity();
  double own = 0.0;
  for (const int memory : {5, 15, 60, 240, 1000}) {
    FilterOptions options = drive::options_of(recorded->document);
    options.gate = 25.0;
    options.gate_memory = memory;
    const auto evaluation = drive::evaluate_drive(*recorded, options, {.resamples = 0});
    ASSERT_TRUE(evaluation) << evaluation.error().message;
    const double ten = evaluation->durations.front().rms_m.value;
    section.print("| %d | %zu | %.2f; %.1f; %.0f |\n", memory, evaluation->rejected, ten,
                  evaluation->durations[1].rms_m.value, evaluation->durations[2].rms_m.value);
    least = std::min(least, ten);
    own = memory == FilterOptions{}.gate_memory ? ten : own;
  }
  EXPECT_LT(own, 1.1 * least);
}

}  // namespace driftlab::accuracy
