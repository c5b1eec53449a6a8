#include "core/signal/unit.hpp"

#include "core/signal/column_unit.hpp"

#include <gmock/gmock.h>

#include <numbers>

namespace driftlab {
namespace {

using ::testing::HasSubstr;

TEST(Unit, ConvertsToSiAndBack) {
  const auto si = [](const char* symbol, double value) { return parse_unit(symbol)->to_si(value); };
  EXPECT_DOUBLE_EQ(si("deg/s", 180.0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(si("deg/h", 180.0 * 3600.0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(si("g", 1.0), 9.80665);
  EXPECT_DOUBLE_EQ(si("mg", 1000.0), 9.80665);
  EXPECT_DOUBLE_EQ(si("degC", 25.0), 298.15);
  EXPECT_DOUBLE_EQ(si("us", 1e6), 1.0);
  EXPECT_DOUBLE_EQ(si("ns", 1e9), 1.0);
  EXPECT_DOUBLE_EQ(si("uT", 1e6), 1.0);
  for (const Unit& unit : all_units()) {
    EXPECT_NEAR(unit.from_si(unit.to_si(12.5)), 12.5, 1e-12) << unit.symbol;  // a few ulp of 300 K
  }
}

TEST(Unit, ReadsItsOwnSymbolAndSpellingsPeopleUse) {
  for (const Unit& unit : all_units()) {
    EXPECT_EQ(parse_unit(unit.symbol)->symbol, unit.symbol);
  }
  EXPECT_EQ(parse_unit("°/s")->symbol, "deg/s");
  EXPECT_EQ(parse_unit("dps")->symbol, "deg/s");
  EXPECT_EQ(parse_unit("m/s2")->symbol, "m/s^2");
  EXPECT_EQ(parse_unit("m/s²")->symbol, "m/s^2");
  EXPECT_EQ(parse_unit("sec")->symbol, "s");
  EXPECT_EQ(parse_unit("")->symbol, "1");
}

TEST(Unit, ReadsProductsPrefixesAndScales) {
  // `[rad s^-1]`, `mdps`, `deg/s/131` were refused, though every data sheet writes them.
  for (const char* const symbol : {"rad s^-1", "rad s-1", "rad·s⁻¹", "rad*s^-1", "rad.s-1", "radians/second"}) {
    ASSERT_TRUE(parse_unit(symbol)) << symbol;
    EXPECT_EQ(parse_unit(symbol)->symbol, "rad/s");
  }
  for (const char* const symbol : {"m s^-2", "m s-2", "m·s⁻²", "m.s-2"}) {
    ASSERT_TRUE(parse_unit(symbol)) << symbol;
    EXPECT_EQ(parse_unit(symbol)->symbol, "m/s^2");
  }
  EXPECT_EQ(parse_unit("° s^-1")->symbol, "deg/s");
  EXPECT_DOUBLE_EQ(parse_unit("mdps")->to_si(180e3), std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse_unit("rpm")->to_si(30.0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse_unit("ug")->to_si(1e6), 9.80665);
  EXPECT_EQ(parse_unit("LSB")->symbol, "1");
  const auto scaled = parse_unit("deg/s/131");
  ASSERT_TRUE(scaled);
  EXPECT_EQ(scaled->dimension, Dimension::AngularRate);
  EXPECT_DOUBLE_EQ(scaled->to_si(131.0 * 180.0), std::numbers::pi);
  EXPECT_EQ(parse_unit(scaled->symbol), *scaled);
  EXPECT_DOUBLE_EQ(parse_unit("0.061 mg")->to_si(1.0), 0.061e-3 * 9.80665);
  for (const char* const symbol : {"deg/s/0", "deg/s/-3", "0.1 furlong", "deg/s/nan", "1 1e400 g"}) {
    EXPECT_FALSE(parse_unit(symbol)) << symbol;
  }
}

TEST(Unit, TakesAScaleAndAnOffsetInTheFormsOfDataSheets) {
  // The thermometer of an MPU-6050, register map 4.2 section 4.18: 340 LSB/degC, 36.53 degC at 0; a count of -3000.
  const double expected = -3000.0 / 340.0 + 36.53 + 273.15;
  for (const std::string symbol :
       {"degC/340+36.53", "degC / 340 + 36.53", "degC/340 36.53", "raw/340+36.53 degC", "raw / 340 + 36.53 degC",
        "raw/340 36.53 degC", "LSB/340+36.53 degC", "340 LSB/degC+36.53", "340 LSB/degC 36.53", "K/340+309.68"}) {
    const auto unit = parse_unit(symbol);
    ASSERT_TRUE(unit) << symbol;
    EXPECT_EQ(unit->dimension, Dimension::Temperature) << symbol;
    EXPECT_NEAR(unit->to_si(-3000.0), expected, 1e-10) << symbol;
    EXPECT_NEAR(unit->from_si(expected), -3000.0, 1e-7) << symbol;
    const auto again = parse_unit(unit->symbol);
    ASSERT_TRUE(again) << "a stored unit is read back: " << unit->symbol;
    EXPECT_EQ(again->to_si(-3000.0), unit->to_si(-3000.0)) << symbol;
  }
  EXPECT_EQ(parse_unit("degC/340 36.53")->symbol, "degC/340+36.53");
  const auto spaced = parse_unit("degC -\t 4");
  ASSERT_TRUE(spaced);
  EXPECT_EQ(parse_unit(spaced->symbol)->to_si(1.0), spaced->to_si(1.0)) << "no sign is put behind a sign";
  EXPECT_DOUBLE_EQ(parse_unit("degC*0.5-10")->to_si(4.0), 273.15 - 8.0);
  EXPECT_DOUBLE_EQ(parse_unit("degC/2")->to_si(4.0), 275.15);
  EXPECT_DOUBLE_EQ(parse_unit("raw*0.5 g")->to_si(4.0), 2.0 * 9.80665);
  EXPECT_DOUBLE_EQ(parse_unit("131 LSB/(deg/s)")->to_si(131.0 * 180.0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse_unit("0.061 mg/LSB+2")->to_si(1.0), 2.061e-3 * 9.80665);
  EXPECT_DOUBLE_EQ(parse_unit("m/s^2/2048-0.5")->to_si(2048.0), 0.5);
  EXPECT_DOUBLE_EQ(parse_unit("rad s^-1*1e-3")->to_si(2.0), 2e-3);
}

TEST(Unit, ReadsWhatToolsAndPeopleWriteInHeaders) {
  const std::vector<std::pair<const char*, const char*>> spellings{
      {"DPS", "deg/s"},       {"Deg/s", "deg/s"},   {"RAD/S", "rad/s"},   {"rads/s", "rad/s"},
      {"º/s", "deg/s"},       {"˚/s", "deg/s"},     {"°/hr", "deg/h"},    {"deg/hour", "deg/h"},
      {"deg/min", "deg/min"}, {"µrad/s", "urad/s"}, {"μrad/s", "urad/s"}, {"RPM", "rpm"},
      {"m/s**2", "m/s^2"},    {"m*s**-2", "m/s^2"}, {"mps2", "m/s^2"},    {"cm/s^2", "cm/s^2"},
      {"cm/s²", "cm/s^2"},    {"mGal", "mGal"},     {"g0", "g"},          {"gn", "g"},
      {"μg", "ug"},           {"msec", "ms"},       {"usec", "us"},       {"μs", "us"},
      {"Seconds", "s"},       {"deg C", "degC"},    {"Deg C", "degC"},    {"º C", "degC"},
      {"Celsius", "degC"},    {"μT", "uT"},         {"Counts", "1"},
  };
  for (const auto& [written, symbol] : spellings) {
    const auto unit = parse_unit(written);
    ASSERT_TRUE(unit) << unit.error().message;
    EXPECT_EQ(unit->symbol, symbol) << written;
  }
  EXPECT_DOUBLE_EQ(parse_unit("deg/min")->to_si(180.0 * 60.0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse_unit("urad/s")->to_si(2e6), 2.0);
  EXPECT_DOUBLE_EQ(parse_unit("cm/s^2")->to_si(980.665), 9.80665);
  EXPECT_DOUBLE_EQ(parse_unit("mGal")->to_si(1e5), 1.0) << "1 Gal is 1 cm/s^2";
}

TEST(Unit, TakesALetterForWhatItCanOnlyMeanThere) {
  EXPECT_EQ(parse_unit("G", Quantity::SpecificForce)->symbol, "g");
  EXPECT_EQ(parse_unit("mG", Quantity::ReferenceSpecificForce)->symbol, "mg");
  EXPECT_EQ(parse_unit("C", Quantity::Temperature)->symbol, "degC");
  EXPECT_EQ(parse_unit("mg", Quantity::SpecificForce)->symbol, "mg");
  EXPECT_FALSE(parse_unit("G", Quantity::MagneticField)) << "gauss";
  EXPECT_FALSE(parse_unit("G", Quantity::Unspecified));
  EXPECT_FALSE(parse_unit("Mg", Quantity::SpecificForce));
  EXPECT_FALSE(parse_unit("C", Quantity::AngularRate));
}

TEST(Unit, ReadsASensitivityWithoutABlankButNoRange) {
  EXPECT_DOUBLE_EQ(parse_unit("131LSB/dps")->to_si(131.0 * 180.0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse_unit("8.75mdps/LSB")->to_si(180e3 / 8.75), std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse_unit("16384LSB/g")->to_si(16384.0), 9.80665);
  EXPECT_DOUBLE_EQ(parse_unit("340LSB/degC+36.53")->to_si(0.0), 36.53 + 273.15);
  for (const char* const symbol : {"2g", "16g", "2000dps", "250deg/s"}) {
    EXPECT_FALSE(parse_unit(symbol)) << symbol << " may be the range";
  }
}

TEST(Unit, TakesThePluralOfACountForNoTime) {
  // 'LSB' or 'digit' and 's' were counts of a second.
  for (const char* const symbol : {"LSBs", "lsbs", "digits", "digit", "count", "counts", "LSb"}) {
    const auto unit = parse_unit(symbol);
    ASSERT_TRUE(unit) << symbol;
    EXPECT_EQ(unit->symbol, "1") << symbol;
  }
  for (const char* const symbol : {"raws", "LSBms", "digitg", "countsdeg/s", "rawmg"}) {
    EXPECT_FALSE(parse_unit(symbol)) << symbol;
  }
  EXPECT_DOUBLE_EQ(parse_unit("LSB s")->to_si(2.0), 2.0) << "apart from the word it is a unit";
  EXPECT_DOUBLE_EQ(parse_unit("digits/131 deg/s")->to_si(131.0 * 180.0), std::numbers::pi);
}

TEST(Unit, SaysWhatIsWrongWithAScaleAndHowToWriteIt) {
  for (const char* const symbol : {"degC/0+36.53", "deg/s*-2", "raw/nan degC", "deg/s/inf", "0 mg"}) {
    const auto unit = parse_unit(symbol);
    ASSERT_FALSE(unit) << symbol;
    EXPECT_THAT(unit.error().message, HasSubstr("must be a positive number; write")) << symbol;
  }
  EXPECT_THAT(parse_unit("raw/340+36.53").error().message, HasSubstr("names no unit in which it is"));
  EXPECT_THAT(parse_unit("us*10+5").error().message, HasSubstr("a time has none"));
  for (const char* const symbol : {"degC/340+", "degC/+3", "degC/340+x", "degC/340+1 2", "raw/340+36.53 furlong",
                                   "deg/s/1e400", "+3", "deg/s 500", "g 16", "raw 2 g"}) {
    EXPECT_FALSE(parse_unit(symbol)) << symbol;
  }
  EXPECT_FALSE(parse_unit("degC/" + std::string(100000, '1'))) << "a name of any length costs little";
}

TEST(Unit, NamesTheUnknownSymbolAndTheKnownOnes) {
  for (const char* const symbol :
       {"furlong", "G", "C", " s", "M/S^2", "kg", "Mg", "MG", "MS", "S", "Mdps", "MRAD/S", "UT", "t"}) {
    const auto unit = parse_unit(symbol);
    ASSERT_FALSE(unit) << symbol;
    EXPECT_EQ(unit.error().code, ErrorCode::UnknownUnit);
    EXPECT_EQ(unit.error().fields.front().value, symbol);
    EXPECT_THAT(unit.error().message, HasSubstr("rad/s"));
  }
}

TEST(Unit, GivesParametersTheUnitsOfTheTrade) {
  // 1 rad/sqrt(s) = 180/pi deg * 60 /sqrt(h); IEEE Std 952 appendix C.
  const ParameterUnit walk = lab_unit(Dimension::AngularRate, 1);
  EXPECT_EQ(walk.symbol, "deg/sqrt(h)");
  EXPECT_DOUBLE_EQ(walk.per_si, 180.0 / std::numbers::pi * 60.0);
  const ParameterUnit bias = lab_unit(Dimension::AngularRate, 0);
  EXPECT_EQ(bias.symbol, "deg/h");
  EXPECT_DOUBLE_EQ(bias.per_si, 180.0 / std::numbers::pi * 3600.0);
  EXPECT_EQ(lab_unit(Dimension::AngularRate, -1).symbol, "deg/h/sqrt(h)");
  EXPECT_DOUBLE_EQ(lab_unit(Dimension::AngularRate, -1).per_si, 180.0 / std::numbers::pi * 3600.0 * 60.0);
  EXPECT_DOUBLE_EQ(lab_unit(Dimension::SpecificForce, 1).per_si, 60.0);
  EXPECT_DOUBLE_EQ(lab_unit(Dimension::SpecificForce, 0).per_si, 1000.0 / 9.80665);
  EXPECT_EQ(lab_unit(Dimension::One, 1).symbol, "1*sqrt(s)");
  EXPECT_EQ(lab_unit(Dimension::One, 1).per_si, 1.0);
}

}  // namespace
}  // namespace driftlab
