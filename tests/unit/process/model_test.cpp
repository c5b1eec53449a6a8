#include "core/process/model.hpp"

#include "core/process/registry.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

TEST(ModelName, CanonicalNamesComeBackAsTheyWere) {
  for (const char* name : {"WN", "WN+GM", "WN+GM+RW", "WN+GM+DR", "WN+2GM+RW+DR", "QN+WN+FN+RW", "WN+3GM", "WN+SIN"}) {
    EXPECT_EQ(model_name(*parse_model(name)), name);
  }
}

TEST(ModelName, OrderAndSplitCountsDoNotMatter) {
  EXPECT_EQ(model_name(*parse_model("RW+GM+WN+GM")), "WN+2GM+RW");
  EXPECT_EQ(*parse_model("GM+WN+GM"), *parse_model("WN+2GM"));
}

TEST(ModelName, CountsParametersAndShapes) {
  EXPECT_EQ(parse_model("WN+2GM+RW+DR")->parameter_count(), 7U);
  EXPECT_EQ(parse_model("WN+2GM+RW+DR")->shape_count(), 2U);
}

TEST(ModelName, NestingIsByProcesses) {
  EXPECT_TRUE(is_nested(*parse_model("WN+GM"), *parse_model("WN+2GM+RW")));
  EXPECT_FALSE(is_nested(*parse_model("WN+2GM"), *parse_model("WN+GM+RW")));
}

TEST(Process, RefusesWrongValues) {
  EXPECT_FALSE(make_process("white_noise", {}).has_value());
  EXPECT_FALSE(make_process("white_noise", {-1.0}).has_value());
  EXPECT_FALSE(make_process("white_noise", {std::nan("")}).has_value());
  EXPECT_FALSE(make_process("pink", {1.0}).has_value());
  EXPECT_TRUE(make_process("linear_drift", {-1.0}).has_value());
}

TEST(Random, NormalHasTheMomentsAndTailsOfANormal) {
  Random random(42);
  constexpr int kDraws = 2000000;
  double m2 = 0.0;
  double m4 = 0.0;
  double mean = 0.0;
  int beyond_tail = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double z = random.normal();
    mean += z;
    m2 += z * z;
    m4 += z * z * z * z;
    beyond_tail += std::fabs(z) > 3.442619855899 ? 1 : 0;
  }
  // Standard errors: 1/sqrt(n), sqrt(2/n), sqrt(96/n); four of each.
  const double root = std::sqrt(1.0 / kDraws);
  EXPECT_NEAR(mean / kDraws, 0.0, 4.0 * root);
  EXPECT_NEAR(m2 / kDraws, 1.0, 4.0 * std::sqrt(2.0) * root);
  EXPECT_NEAR(m4 / kDraws, 3.0, 4.0 * std::sqrt(96.0) * root);
  const double p = std::erfc(3.442619855899 / std::sqrt(2.0));
  EXPECT_NEAR(beyond_tail, kDraws * p, 4.0 * std::sqrt(kDraws * p));
}

TEST(Random, SeedAndStreamFixEveryBit) {
  Random a(7, 1);
  Random b(7, 1);
  Random other(7, 2);
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    const double value = a.normal();
    EXPECT_EQ(value, b.normal());
    differs = differs || value != other.normal();
  }
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace driftlab
