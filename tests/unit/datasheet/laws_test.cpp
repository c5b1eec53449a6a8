// Laws that every data sheet obeys: a slip of a digit or of a unit breaks one of them.
#include "core/datasheet/data_sheet.hpp"
#include "core/signal/unit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace driftlab {
namespace {

class EveryDataSheet : public ::testing::TestWithParam<const DataSheet*> {};

TEST_P(EveryDataSheet, SaysWhereItsFiguresStand) {
  const DataSheet& sheet = *GetParam();
  EXPECT_FALSE(sheet.name.empty());
  EXPECT_FALSE(sheet.manufacturer.empty());
  EXPECT_FALSE(sheet.document.empty());
  ASSERT_FALSE(sheet.sensors.empty());
  for (const SensorSheet& sensor : sheet.sensors) {
    EXPECT_FALSE(sensor.place.empty());
  }
}

TEST_P(EveryDataSheet, HasOneSensorOfAQuantityInAUnitThatMeasuresIt) {
  std::set<Quantity> seen;
  for (const SensorSheet& sensor : GetParam()->sensors) {
    EXPECT_TRUE(seen.insert(sensor.quantity).second);
    const auto unit = parse_unit(sensor.unit);
    ASSERT_TRUE(unit) << sensor.unit;
    EXPECT_EQ(unit->symbol, sensor.unit) << "write the unit as driftlab does";
    EXPECT_TRUE(sensor.quantity == Quantity::AngularRate || sensor.quantity == Quantity::SpecificForce);
    EXPECT_TRUE(measures(*unit, sensor.quantity));
  }
}

// A range is counted by one converter, so that all ranges have about the same counts: 6 to 16 bits, whole or in part.
// The widest range of the LSM9DS0 has two thirds of the others' and stands so in its table.
TEST_P(EveryDataSheet, HasRisingRangesOfAboutTheSameCounts) {
  for (const SensorSheet& sensor : GetParam()->sensors) {
    ASSERT_FALSE(sensor.scales.empty());
    EXPECT_TRUE(std::is_sorted(sensor.scales.begin(), sensor.scales.end(),
                               [](const FullScale& a, const FullScale& b) { return a.limit < b.limit; }));
    for (const FullScale& scale : sensor.scales) {
      if (!scale.per_count) {
        continue;
      }
      const double counts = scale.limit / *scale.per_count;
      EXPECT_GE(counts, 31.0);
      EXPECT_LE(counts, 32801.0);
      const double first = sensor.scales.front().limit / sensor.scales.front().per_count.value();
      EXPECT_LE(std::fabs(std::log(counts / first)), std::log(1.65)) << scale.limit;
    }
  }
}

// Silicon gyroscopes of this class lie between 0.5 and 60 mdeg/s/sqrt(Hz), accelerometers between 10 and 600
// ug/sqrt(Hz).
TEST_P(EveryDataSheet, HasNoiseOfItsClass) {
  for (const SensorSheet& sensor : GetParam()->sensors) {
    const auto density = stated_density_si(sensor, "");
    if (!density) {
      continue;
    }
    const bool rate = sensor.quantity == Quantity::AngularRate;
    const double in_class = rate ? *density * 180.0 / std::numbers::pi * 1e3 : *density / kStandardGravity * 1e6;
    EXPECT_GE(in_class, rate ? 0.5 : 10.0);
    EXPECT_LE(in_class, rate ? 60.0 : 600.0);
    EXPECT_GE(stated_density_si(sensor, "z").value(), *density * 0.5);
    EXPECT_LE(stated_density_si(sensor, "z").value(), *density * 2.0);
  }
}

// N by the random walk and N by the one-sided density are of one noise: from 0.94 of each other for the ADIS16405
// to 1.25 for the accelerometer of the ADIS16465.
TEST_P(EveryDataSheet, HasARandomWalkThatFollowsFromItsDensity) {
  for (const SensorSheet& sensor : GetParam()->sensors) {
    if (!sensor.random_walk || !sensor.noise_density) {
      continue;
    }
    SensorSheet alone = sensor;
    alone.random_walk.reset();
    const double ratio = stated_density_si(sensor, "").value() / stated_density_si(alone, "").value();
    EXPECT_GE(ratio, 0.8);
    EXPECT_LE(ratio, 1.4);
  }
}

// In-run bias stability over N is a time: flicker reaches the white noise at (B/N)^2 seconds, seconds to hours.
TEST_P(EveryDataSheet, HasABiasStabilityThatWhiteNoiseReachesInSecondsToHours) {
  for (const SensorSheet& sensor : GetParam()->sensors) {
    const auto density = stated_density_si(sensor, "");
    const auto least = stated_bias_stability_si(sensor);
    if (!density || !least) {
      continue;
    }
    const double tau_s = std::pow(*density / *least, 2);
    EXPECT_GE(tau_s, 0.5);
    EXPECT_LE(tau_s, 36000.0);
  }
}

TEST_P(EveryDataSheet, HasSpansWhoseEndsAreInOrder) {
  for (const SensorSheet& sensor : GetParam()->sensors) {
    for (const auto& span : {sensor.bandwidth_hz, sensor.rate_hz}) {
      if (span) {
        EXPECT_GT(span->lowest, 0.0);
        EXPECT_LE(span->lowest, span->highest);
      }
    }
  }
}

TEST_P(EveryDataSheet, IsFoundByItsNameHoweverItIsWritten) {
  const DataSheet& sheet = *GetParam();
  std::string bare;
  std::string spaced;
  std::string lower;
  for (const char c : sheet.name) {
    bare += c == '-' || c == ' ' ? "" : std::string(1, c);
    spaced += c == '-' ? ' ' : c;
    lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  for (const std::string& text : {std::string(sheet.name), bare, spaced, lower, "a phone with " + bare + " (rev. 2)",
                                  std::string(sheet.manufacturer) + " " + std::string(sheet.name), bare + "_north"}) {
    const auto named = sheets_named_in(text);
    ASSERT_EQ(named.size(), 1U) << text;
    EXPECT_EQ(named.front(), &sheet) << text;
  }
  EXPECT_TRUE(sheets_named_in("x" + bare).empty());
  const bool takes_any_code =
      std::any_of(sheet.also.begin(), sheet.also.end(), [](std::string_view also) { return also.ends_with('*'); });
  EXPECT_EQ(sheets_named_in(bare + "9Q").empty(), !takes_any_code);
}

TEST_P(EveryDataSheet, IsFoundByItsOtherNames) {
  for (const std::string_view also : GetParam()->also) {
    std::string text(also);
    if (text.ends_with('*')) {
      text.back() = '7';
    }
    const auto named = sheets_named_in(text);
    ASSERT_EQ(named.size(), 1U) << text;
    EXPECT_EQ(named.front(), GetParam()) << text;
  }
}

INSTANTIATE_TEST_SUITE_P(DataSheets, EveryDataSheet, ::testing::ValuesIn(data_sheets()),
                         [](const ::testing::TestParamInfo<const DataSheet*>& made) {
                           std::string name;
                           for (const char c : made.param->name) {
                             name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                           }
                           return name;
                         });

}  // namespace
}  // namespace driftlab
