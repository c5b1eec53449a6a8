#include "schema/figure/printed_names.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(PrintedNames, AreThoseOfTheListElseTheNamesWithBlanks) {
  EXPECT_EQ(process_name("gauss_markov"), "Gauss-Markov");
  EXPECT_EQ(process_name("low_pass_1"), "low-pass noise");
  EXPECT_EQ(process_name("white_noise"), "white noise");
  EXPECT_EQ(parameter_name("sigma"), "σ");
  EXPECT_EQ(parameter_name("frequency_hz"), "frequency");
  EXPECT_EQ(parameter_name("N"), "N");
}

TEST(PrintedNames, OfColumnsNumberWhatRepeatsFromTheSecondOn) {
  EXPECT_EQ(column_name("N"), "N");
  EXPECT_EQ(column_name("white_noise.N"), "white noise N");
  EXPECT_EQ(column_name("gauss_markov_1.beta"), "Gauss-Markov β");
  EXPECT_EQ(column_name("gauss_markov_2.sigma"), "Gauss-Markov 2 σ");
  EXPECT_EQ(column_name("low_pass_1.corner_hz"), "low-pass noise corner") << "1 is a part of its name";
}

TEST(PrintedNames, UnitsHaveRootsAndPowers) {
  EXPECT_EQ(printed_unit("deg/h/sqrt(h)"), "deg/h/√h");
  EXPECT_EQ(printed_unit("m/s^2"), "m/s²");
}

}  // namespace
}  // namespace driftlab
