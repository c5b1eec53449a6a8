#include "core/datasheet/plausible_units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace driftlab {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kDt = 0.01;

std::vector<double> noise(double level, double sigma, unsigned seed, std::size_t count = 6000) {
  std::mt19937_64 source(seed);
  std::normal_distribution<double> normal(level, sigma);
  std::vector<double> samples(count);
  for (double& sample : samples) {
    sample = normal(source);
  }
  return samples;
}

struct Rig {
  std::vector<std::vector<double>> samples;
  std::vector<ObservedChannel> channels;

  void add(Quantity quantity, const char* axis, const char* unit, std::vector<double> values) {
    samples.push_back(std::move(values));
    channels.push_back({std::string(quantity == Quantity::AngularRate ? "g" : "a") + axis,
                        quantity,
                        axis,
                        parse_unit(unit).value(),
                        {}});
  }
  std::vector<std::string> notes(const std::string& device, bool at_rest = true) {
    for (std::size_t i = 0; i < channels.size(); ++i) {
      channels[i].samples = samples[i];
    }
    return unit_notes(channels, kDt, at_rest, std::vector<std::string>{device});
  }
};

/// An accelerometer on its side whose readings are `gravity` long.
Rig lying(const char* unit, double gravity) {
  Rig rig;
  rig.add(Quantity::SpecificForce, "x", unit, noise(0.6 * gravity, 1e-3 * gravity, 1));
  rig.add(Quantity::SpecificForce, "y", unit, noise(-0.8 * gravity, 1e-3 * gravity, 2));
  rig.add(Quantity::SpecificForce, "z", unit, noise(0.0, 1e-3 * gravity, 3));
  return rig;
}

/// White noise of an MPU-6050 at 100 Hz: N = 0.005/sqrt(2) deg/s/sqrt(Hz), a sample N/sqrt(dt).
Rig still(const char* unit, double factor) {
  Rig rig;
  rig.add(Quantity::AngularRate, "z", unit, noise(0.3 * factor, 0.005 / std::sqrt(2.0) * 10.0 * factor, 4));
  return rig;
}

TEST(UnitNotes, SayNothingAboutReadingsThatAreWhatTheyAreSaidToBe) {
  EXPECT_THAT(lying("m/s^2", 9.79).notes("anything"), IsEmpty());
  EXPECT_THAT(lying("g", 1.02).notes("anything"), IsEmpty());
  EXPECT_THAT(lying("mg", 998.0).notes("anything"), IsEmpty());
  EXPECT_THAT(still("deg/s", 1.0).notes("MPU-6050"), IsEmpty());
  EXPECT_THAT(still("rad/s", 1.0 / 57.29578).notes("MPU-6050"), IsEmpty());
}

TEST(UnitNotes, NameTheUnitInWhichGravityIsOneG) {
  EXPECT_THAT(lying("g", 9.81).notes("anything"), ElementsAre(HasSubstr("look like m/s^2")));
  EXPECT_THAT(lying("m/s^2", 1.0).notes("anything"), ElementsAre(HasSubstr("look like g")));
  EXPECT_THAT(lying("g", 1000.0).notes("anything"), ElementsAre(HasSubstr("look like mg")));
  EXPECT_THAT(lying("g", 16384.0).notes("anything"), IsEmpty()) << "whose counts these are is not known";
  EXPECT_THAT(lying("g", 16384.0).notes("MPU-6050"), ::testing::Contains(HasSubstr("counts of the range of 2 g")));
}

// Gravity taken out, or a sensor that moves, is no unit.
TEST(UnitNotes, LeaveOtherLengthsAlone) {
  EXPECT_THAT(lying("m/s^2", 0.02).notes("anything"), IsEmpty());
  EXPECT_THAT(lying("g", 9.81).notes("anything", false), IsEmpty());
}

TEST(UnitNotes, NameTheUnitInWhichTheNoiseIsThatOfTheDataSheet) {
  const auto told = still("rad/s", 1.0).notes("MPU-6050");
  ASSERT_THAT(told, SizeIs(1));
  EXPECT_THAT(told.front(), HasSubstr("looks like deg/s, not rad/s"));
  EXPECT_THAT(told.front(), HasSubstr("MPU-6050"));
  EXPECT_THAT(still("deg/s", 1.0 / 57.29578).notes("MPU-6050"), ElementsAre(HasSubstr("looks like rad/s")));
  EXPECT_THAT(still("deg/s", 1000.0).notes("MPU-6050"), ElementsAre(HasSubstr("looks like mdeg/s")));
  EXPECT_THAT(still("deg/s", 65.5).notes("MPU-6050"), ElementsAre(HasSubstr("looks like counts of the range")));
  EXPECT_THAT(still("rad/s", 1.0).notes("somebody's box"), IsEmpty()) << "without a data sheet nothing is known";
}

// Five times the noise of the data sheet is a table that shakes.
TEST(UnitNotes, TakeNoVibrationForAUnit) {
  EXPECT_THAT(still("deg/s", 5.0).notes("MPU-6050"), IsEmpty());
  Rig knocked = still("deg/s", 1.0);
  for (std::size_t i = 0; i < knocked.samples[0].size(); i += 400) {
    knocked.samples[0][i] += 100.0;
  }
  EXPECT_THAT(knocked.notes("MPU-6050"), IsEmpty());
}

TEST(UnitNotes, TellReadingsBeyondEveryRange) {
  Rig moving = still("rad/s", 1.0);
  moving.samples[0][100] = 90.0;
  EXPECT_THAT(moving.notes("MPU-6050", false), ElementsAre(HasSubstr("largest range of the MPU-6050 is 2000 deg/s")));
}

TEST(UnitNotes, AreSilentOnShortAndStandingSeries) {
  Rig few;
  few.add(Quantity::AngularRate, "z", "rad/s", noise(0.0, 1.0, 5, 63));
  EXPECT_THAT(few.notes("MPU-6050"), IsEmpty());
  Rig standing;
  standing.add(Quantity::AngularRate, "z", "rad/s", std::vector<double>(5000, 0.25));
  EXPECT_THAT(standing.notes("MPU-6050"), IsEmpty());
  Rig empty;
  empty.add(Quantity::AngularRate, "z", "rad/s", {});
  EXPECT_THAT(empty.notes("MPU-6050"), IsEmpty());
}

}  // namespace
}  // namespace driftlab
