#include "core/fit/model_search.hpp"

#include "core/fit/characterise.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stop_token>
#include <string>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

std::vector<std::string> names(const std::vector<ModelStructure>& structures) {
  std::vector<std::string> all;
  for (const ModelStructure& structure : structures) {
    all.push_back(model_name(structure));
  }
  return all;
}

TEST(ModelSearch, NeighboursAreOneProcessAway) {
  EXPECT_THAT(names(neighbouring_structures(*parse_model("WN+GM"), 20)),
              testing::ElementsAre("QN+WN+GM", "WN+FN+GM", "WN+2GM", "WN+GM+RW", "WN+GM+DR", "WN+GM+SIN",  // more
                                   "QN+GM", "FN+GM", "2GM", "GM+RW", "GM+DR", "GM+SIN", "GM",              // WN
                                   "QN+WN", "WN+FN", "WN+RW", "WN+DR", "WN+SIN", "WN"));                   // GM
  EXPECT_THAT(names(neighbouring_structures(*parse_model("3GM"), 7)),
              testing::ElementsAre("QN+3GM", "WN+3GM", "FN+3GM", "3GM+RW", "3GM+DR",  // three shapes are the most
                                   "QN+2GM", "WN+2GM", "FN+2GM", "2GM+RW", "2GM+DR", "2GM+SIN", "2GM"));
  EXPECT_THAT(names(neighbouring_structures(*parse_model("WN"), 1)), testing::ElementsAre("QN", "FN", "RW", "DR"));
}

TEST(ModelSearch, FindsAModelThatNobodyListed) {
  // Quantization, white and random walk, each well above the others over many scales.
  Model truth{*make_process("quantization_noise", {0.005}), *make_process("white_noise", {0.05}),
              *make_process("random_walk", {0.05})};
  Random random(12);
  const std::vector<double> x = simulate(truth, random, kDt, 90000);
  const CharacteriseOptions options{.models = {"WN", "WN+GM"}, .search = ModelSearch::Stepwise};
  const auto found = characterise_channel({.values = x, .dt_s = kDt}, options);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->fits.front().model, "QN+WN+RW");
  EXPECT_GT(found->fits.size(), 10U) << "everything looked at is reported";
}

TEST(ModelSearch, StopsWhenAsked) {
  Random random(1);
  const std::vector<double> x = simulate({*make_process("white_noise", {0.05})}, random, kDt, 4000);
  std::stop_source source;
  RunControl control;
  control.stop = source.get_token();
  control.progress = [&](std::string_view stage, double fraction) {
    if (stage.substr(0, 3) == "fit" && fraction >= 0.7) {
      source.request_stop();
    }
  };
  const auto stopped =
      characterise_channel({.values = x, .dt_s = kDt}, {.models = {"WN"}, .search = ModelSearch::Stepwise}, control);
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::Cancelled);
}

}  // namespace
}  // namespace driftlab
