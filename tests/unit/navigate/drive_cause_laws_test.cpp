// The laws of causes of drives, over every entry of the registry, and causes that each of them refuses. What a search
// makes of a cause: drive_hidden_test.cpp, drive_causes_test.cpp.
#include "core/navigate/drive/likelihood.hpp"
#include "tests/unit/navigate/drive_injections.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace driftlab::drive {
namespace {

using Faults = std::vector<std::string>;

/// What a law is asked of: a cause among others, and those that are hidden in some drive.
struct Asked {
  const Cause& cause;
  const std::vector<Cause>& all;
  const std::set<std::string>& hidden;
};

std::set<std::string> hidden_causes() {
  std::set<std::string> names;
  for (const DriveInjection& one : drive_injections()) {
    names.insert(one.cause);
  }
  return names;
}

bool is_for_people(std::string_view words) {
  return !words.empty() && !std::regex_search(std::string(words), std::regex("[a-z0-9]_[a-z0-9]"));
}

/// Options in which every knob applies, of values whose sums with powers of two are exact.
FilterOptions all_in_use() {
  FilterOptions options;
  options.constraint.emplace();
  options.odometer = true;
  options.coloured.sigma_m = 0.5;
  options.velocity_latency_s = 0.5;
  options.velocity_averaging = 0.25;
  options.gyro_vibration = 0.25;
  options.force_vibration = 0.25;
  return options;
}

FilterOptions turned(FilterOptions options, const Knob& knob, double by) {
  knob.turn(options, by);
  return options;
}

/// The largest power of two within a knob's first step.
double exact_step(const Knob& knob) { return std::exp2(std::floor(std::log2(knob.step))); }

/// Turning changes the knob's own value by so much, back again leaves no trace, and no other knob sees it.
Faults faults_of_turning(const Knob& knob, const std::string& name, const std::vector<Cause>& all) {
  Faults faults;
  const FilterOptions options = all_in_use();
  const double step = exact_step(knob);
  for (const double by : {step, -step}) {
    const FilterOptions there = turned(options, knob, by);
    if (knob.value(there) != knob.value(options) + by) {
      faults.push_back(name + " turns by another amount than asked");
    } else if (!(turned(there, knob, -by) == options)) {
      faults.push_back(name + " does not turn back");
    }
    for (const Cause& cause : all) {
      for (const Knob& other : cause.knobs) {
        const bool itself = other.parameter == knob.parameter && other.value == knob.value;
        if (!itself && other.value(there) != other.value(options)) {
          faults.push_back(name + " turns " + std::string(cause.name) + "." + std::string(other.parameter) + " too");
        }
        if (!(turned(there, other, exact_step(other)) == turned(turned(options, other, exact_step(other)), knob, by))) {
          faults.push_back(name + " is another knob after " + std::string(other.parameter));
        }
      }
    }
  }
  return faults;
}

Faults faults_of_knob(const Knob& knob, const Asked& asked) {
  Faults faults;
  const std::string name = std::string(asked.cause.name) + "." + std::string(knob.parameter);
  const auto require = [&](bool holds, const char* law) {
    if (!holds) {
      faults.push_back(name + " " + law);
    }
  };
  require(std::count_if(asked.cause.knobs.begin(), asked.cause.knobs.end(),
                        [&](const Knob& other) { return other.parameter == knob.parameter; }) == 1,
          "is there twice");
  require(std::regex_match(std::string(knob.parameter), std::regex("[A-Za-z]+(_[a-z0-9]+)*")), "has no name");
  require(is_for_people(knob.title), "has no title for people");
  require(is_for_people(knob.told_apart), "is told apart by nothing, or by names of documents");
  require(knob.per_si > 0.0 && !knob.unit.empty(), "has no unit");
  require(knob.step > 0.0 && knob.most > knob.step, "has no first step within its bound");
  require(!knob.share || knob.most <= 1.0, "is a share of more than the whole");
  if (knob.turn == nullptr || knob.value == nullptr || !(knob.step > 0.0)) {
    faults.push_back(name + " cannot be turned");
    return faults;
  }
  require(std::isfinite(knob.value(FilterOptions{})), "has no value where it does not apply");
  const Faults of_turning = faults_of_turning(knob, name, asked.all);
  faults.insert(faults.end(), of_turning.begin(), of_turning.end());
  return faults;
}

Faults faults_of(const Asked& asked) {
  const Cause& cause = asked.cause;
  Faults faults;
  const auto require = [&](bool holds, const char* law) {
    if (!holds) {
      faults.push_back(std::string(cause.name) + " " + law);
    }
  };
  const auto shared_by = [&](auto member) {
    return std::count_if(asked.all.begin(), asked.all.end(),
                         [&](const Cause& other) { return other.*member == cause.*member; });
  };
  require(std::regex_match(std::string(cause.name), std::regex("[a-z]+(_[a-z0-9]+)*")), "has a name not in snake_case");
  require(shared_by(&Cause::name) == 1, "has the name of another");
  require(is_for_people(cause.words), "has no words for people");
  require(shared_by(&Cause::words) == 1, "has the words of another");
  require(!cause.knobs.empty() || !cause.levels.empty() || cause.from_files != nullptr, "can show in no way");
  require(asked.hidden.contains(std::string(cause.name)), "is hidden in no drive");
  require(cause.knobs.empty() || !cause.knobs.front().companion, "has a companion of nothing");
  for (const Knob& knob : cause.knobs) {
    const Faults of_knob = faults_of_knob(knob, asked);
    faults.insert(faults.end(), of_knob.begin(), of_knob.end());
  }
  for (const NoiseLevel& level : cause.levels) {
    require(level.factor != nullptr && FilterOptions{}.*level.factor == 1.0, "has a level that is no factor");
    require(level.named_from > 1.0, "has a level that is always named");
    require(is_for_people(level.title) && is_for_people(level.told_apart), "has a level without words");
  }
  return faults;
}

class LawsOfDriveCauses : public ::testing::TestWithParam<std::string_view> {
 protected:
  [[nodiscard]] const Cause& cause() const { return *find_cause(GetParam()); }
};

TEST_P(LawsOfDriveCauses, Hold) {
  EXPECT_THAT(faults_of({cause(), cause_registry(), hidden_causes()}), ::testing::IsEmpty());
}

TEST_P(LawsOfDriveCauses, AreOfTheKnobsThatASearchTurns) {
  EXPECT_EQ(find_cause(cause().name), &cause());
  for (const Knob& own : cause().knobs) {
    const Knob* const knob = find_knob(cause().name, own.parameter);
    ASSERT_NE(knob, nullptr) << own.parameter;
    EXPECT_EQ(knob->value, own.value);
    EXPECT_TRUE(is_for_people(words_of(*knob))) << words_of(*knob);
    EXPECT_EQ(std::count_if(all_knobs().begin(), all_knobs().end(),
                            [&](const Knob& other) { return words_of(other) == words_of(*knob); }),
              1)
        << words_of(*knob) << " is said of another";
    const DriveFinding finding = finding_of(*knob);
    EXPECT_EQ(finding.cause, cause().name);
    EXPECT_EQ(finding.parameter, own.parameter);
    EXPECT_EQ(finding.told_apart, own.told_apart);
    EXPECT_FALSE(finding.evidence.empty());
  }
}

/// A drive on which every knob applies, of one lap.
const Drive& drive_with_everything() {
  static const Drive drive = with_odometer(61, 0.0, 0.0, 1);
  return drive;
}

double log_likelihood_of(const FilterOptions& options) {
  const auto found = log_likelihood(drive_with_everything(), options);
  EXPECT_TRUE(found) << found.error().message;
  return found ? found->total() : 0.0;
}

TEST_P(LawsOfDriveCauses, TheFilterFeelsEveryKnobAndLevel) {
  const FilterOptions options = all_in_use();
  const double before = log_likelihood_of(options);
  for (const Knob& knob : cause().knobs) {
    EXPECT_NE(log_likelihood_of(turned(options, knob, knob.step)), before) << knob.parameter;
    if (knob.magnitude) {
      EXPECT_EQ(log_likelihood_of(turned(options, knob, -2.0 * knob.value(options))), before)
          << knob.parameter << " has a sign";
    }
    if (knob.systematic != nullptr) {
      EXPECT_GE(knob.systematic(drive_with_everything(), options), 0.0) << knob.parameter;
    }
  }
  for (const NoiseLevel& level : cause().levels) {
    FilterOptions louder = options;
    louder.*level.factor *= 1.1;
    EXPECT_NE(log_likelihood_of(louder), before) << level.parameter;
  }
}

/// What the files show of the drive in which the cause is hidden.
std::optional<FromFiles> shown_by_files(const Cause& cause) {
  for (const DriveInjection& one : drive_injections()) {
    if (one.cause == cause.name) {
      const Drive drive = one.drive(62, one.clear, 2);
      FilterOptions options = options_of(drive.document);
      options.odometer = !drive.odometer.empty();
      return cause.from_files(drive, options);
    }
  }
  return std::nullopt;
}

TEST_P(LawsOfDriveCauses, FilesShowNothingThatIsNotThereAndSayWhatIs) {
  if (cause().from_files == nullptr) {
    return;
  }
  EXPECT_FALSE(cause().from_files(simulated_drive(63, {}, 2), {}));
  EXPECT_FALSE(cause().from_files(with_odometer(63, 0.0, 0.0, 2), {}));
  const auto shown = shown_by_files(cause());
  ASSERT_TRUE(shown);
  EXPECT_FALSE(shown->finding.parameter.empty());
  EXPECT_TRUE(is_for_people(shown->finding.title)) << shown->finding.title;
  EXPECT_TRUE(is_for_people(shown->finding.evidence)) << shown->finding.evidence;
  EXPECT_TRUE(is_for_people(shown->finding.told_apart)) << shown->finding.told_apart;
  EXPECT_GE(shown->finding.score, 5.0);
  if (shown->use) {
    FilterOptions once;
    shown->use(once);
    FilterOptions twice = once;
    shown->use(twice);
    EXPECT_TRUE(twice == once);
    EXPECT_FALSE(once == FilterOptions{});
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, LawsOfDriveCauses, ::testing::ValuesIn([] {
                           std::vector<std::string_view> names;
                           for (const Cause& cause : cause_registry()) {
                             names.push_back(cause.name);
                           }
                           return names;
                         }()),
                         [](const auto& given) { return std::string(given.param); });

TEST(DriveCauseLaws, WhatIsHiddenIsRegistered) {
  for (const DriveInjection& one : drive_injections()) {
    const Cause* const cause = find_cause(one.cause);
    ASSERT_NE(cause, nullptr) << one.cause;
    const bool of_levels = std::any_of(cause->levels.begin(), cause->levels.end(),
                                       [&](const NoiseLevel& level) { return level.parameter == one.parameter; });
    const bool of_files = cause->from_files != nullptr && shown_by_files(*cause)->finding.parameter == one.parameter;
    EXPECT_TRUE(find_knob(one.cause, one.parameter) != nullptr || of_levels || of_files)
        << one.cause << " has no " << one.parameter;
  }
}

/// All that people read on how a cause is told apart.
std::string told_apart(const Cause& cause) {
  std::string text;
  for (const Knob& knob : cause.knobs) {
    text += std::string(knob.told_apart) + "; ";
  }
  for (const NoiseLevel& level : cause.levels) {
    text += std::string(level.told_apart) + "; ";
  }
  if (cause.from_files != nullptr) {
    text += shown_by_files(cause)->finding.told_apart;
  }
  return text;
}

TEST(DriveCauseLaws, TheRivalsOfTheSpecificationAreNamed) {
  // spec/drives.md, section 6, "told apart by": the rival, or the measurement that it does not show in.
  const std::vector<std::pair<std::string_view, std::vector<const char*>>> rivals{
      {"sample_clock", {"lattice", "stuck"}},
      {"imu_time_offset", {"speed", "late position", "same thing"}},
      {"gnss_velocity_latency", {"fixes alone"}},
      {"gnss_velocity_averaging", {"delay", "arm"}},
      {"gnss_lever_arm", {"constant in the body", "turns", "slopes"}},
      {"gnss_coloured_noise", {"fixes at rest", "innovations", "level"}},
      {"mounting_angles", {"speed", "axle", "turning"}},
      {"gyro_scale_factor_error", {"sign of the turn"}},
      {"accelerometer_scale_factor_error", {"acceleration"}},
      {"vibration_noise", {"outages", "gyroscope above 5 Hz", "noise level"}},
      {"noise_level", {"every other cause"}},
      {"odometer_scale", {"constant ratio", "slip"}},
      {"wheel_slip", {"bursts", "scale factor"}},
      {"initial_heading", {"first minutes", "mounting"}}};
  for (const auto& [name, words] : rivals) {
    const Cause* const cause = find_cause(name);
    ASSERT_NE(cause, nullptr) << name;
    for (const char* const word : words) {
      EXPECT_THAT(told_apart(*cause), ::testing::HasSubstr(word)) << name;
    }
  }
}

/// A cause that breaks no law: the gate of the filter.
Cause sound_cause() {
  return {.name = "narrow_gate",
          .words = "a narrow gate",
          .knobs = {{.parameter = "gate",
                     .title = "the gate is too narrow by",
                     .unit = "1",
                     .step = 1.0,
                     .most = 10.0,
                     .turn = [](FilterOptions& o, double by) { o.gate += by; },
                     .value = [](const FilterOptions& o) { return o.gate; },
                     .told_apart = "fixes that are rejected"}}};
}

struct Broken {
  const char* name;
  void (*change)(Cause& cause);
  const char* fault;
};

class BrokenDriveCauses : public ::testing::TestWithParam<Broken> {};

Faults faults_of_planted(const Cause& planted) {
  std::vector<Cause> all = cause_registry();
  all.push_back(planted);
  return faults_of({all.back(), all, {"narrow_gate", "Gate", "noise_level"}});
}

TEST_P(BrokenDriveCauses, AreRefused) {
  Cause cause = sound_cause();
  EXPECT_THAT(faults_of_planted(cause), ::testing::IsEmpty());
  GetParam().change(cause);
  EXPECT_THAT(faults_of_planted(cause), ::testing::Contains(::testing::HasSubstr(GetParam().fault)));
}

INSTANTIATE_TEST_SUITE_P(
    Planted, BrokenDriveCauses,
    ::testing::Values(
        Broken{"Nothing", [](Cause& c) { c.knobs.clear(); }, "can show in no way"},
        Broken{"Upper", [](Cause& c) { c.name = "Gate"; }, "snake_case"},
        Broken{"SameName", [](Cause& c) { c.name = "noise_level"; }, "the name of another"},
        Broken{"DocumentsName", [](Cause& c) { c.words = "narrow_gate"; }, "no words"},
        Broken{"SameWords", [](Cause& c) { c.words = cause_registry().front().words; }, "the words of another"},
        Broken{"Unhidden", [](Cause& c) { c.name = "wide_gate"; }, "hidden in no drive"},
        Broken{"Together", [](Cause& c) { c.knobs.front().told_apart = ""; }, "told apart by nothing"},
        Broken{"TwoParameters", [](Cause& c) { c.knobs.push_back(c.knobs.front()); }, "is there twice"},
        Broken{"Companion", [](Cause& c) { c.knobs.front().companion = true; }, "companion of nothing"},
        Broken{"Share", [](Cause& c) { c.knobs.front().share = true; }, "more than the whole"},
        Broken{"Bound", [](Cause& c) { c.knobs.front().most = 0.5; }, "no first step"},
        Broken{"NoTurn", [](Cause& c) { c.knobs.front().turn = nullptr; }, "cannot be turned"},
        Broken{"Double",
               [](Cause& c) { c.knobs.front().turn = [](FilterOptions& o, double by) { o.gate += 2.0 * by; }; },
               "another amount"},
        Broken{"Trace",
               [](Cause& c) {
                 c.knobs.front().turn = [](FilterOptions& o, double by) {
                   o.gate += by;
                   o.gate_memory += 1;
                 };
               },
               "does not turn back"},
        Broken{"Others",
               [](Cause& c) {
                 c.knobs.front().turn = [](FilterOptions& o, double by) {
                   o.gate += by;
                   o.imu_offset_s += by;
                 };
               },
               "turns imu_time_offset.delta_s too"},
        Broken{"Depends",
               [](Cause& c) {
                 c.knobs.front().turn = [](FilterOptions& o, double by) {
                   o.gate += o.odometer_scale == 0.0 ? by : 0.0;
                 };
               },
               "another knob after S"},
        Broken{"Level",
               [](Cause& c) { c.levels.push_back({"gate", "the gate times", &FilterOptions::gate, 1.25, "nothing"}); },
               "no factor"}),
    [](const auto& given) { return std::string(given.param.name); });

}  // namespace
}  // namespace driftlab::drive
