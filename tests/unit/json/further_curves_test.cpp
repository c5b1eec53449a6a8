#include "core/process/random.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/json/characterise.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

using testing::HasSubstr;

TEST(CharacteriseRequest, NamesFurtherCurvesAndStoresWhatWasAskedFor) {
  Faults faults;
  const Json asked = Json::parse(R"({"models": ["WN"], "also": ["psd", "total"]})");
  const CharacteriseOptions options = characterise_options_from_json(asked, "/parameters", faults);
  EXPECT_TRUE(faults.none());
  EXPECT_TRUE(options.also.total);
  EXPECT_FALSE(options.also.theo1);
  EXPECT_TRUE(options.also.psd);
  EXPECT_EQ(to_json(options)["also"], (Json{"total", "psd"}));
  EXPECT_FALSE(to_json(CharacteriseOptions{}).contains("also")) << "settings of before keep their bytes";
}

TEST(CharacteriseRequest, RefusesACurveThatThereIsNot) {
  for (const char* text : {R"({"also": ["hadamard"]})", R"({"also": [3]})", R"({"also": {}})", R"({"also": null})"}) {
    Faults faults;
    (void)characterise_options_from_json(Json::parse(text), "/parameters", faults);
    EXPECT_FALSE(faults.none()) << text;
  }
}

TEST(CharacterisationDocument, HoldsFurtherCurvesInTheChannelsUnitWhereAskedFor) {
  Random random(3);
  std::vector<double> x(4096);
  for (double& value : x) {
    value = random.normal();
  }
  const ColumnRole role{.quantity = Quantity::AngularRate, .axis = "z", .unit = *parse_unit("deg/s")};
  const double factor = role.unit->factor;
  const auto document = [&](FurtherRequest also) {
    const auto found =
        characterise_channel({.values = x, .dt_s = 0.01, .si_factor = factor}, {.models = {"WN"}, .also = also});
    return to_json(ChannelIdentity{"gz", role}, *found);
  };
  const Json plain = document({});
  EXPECT_FALSE(plain.contains("total") || plain.contains("theo1") || plain.contains("psd"));
  const Json all = document({.total = true, .theo1 = true, .psd = true});
  // White noise of 1 deg/s at 100 Hz: deviation sqrt(dt/tau), density 2 dt. The shortest tau have 50 degrees and more.
  const double tau = all["total"]["tau_s"][0];
  EXPECT_NEAR(all["total"]["deviation"][0].get<double>(), std::sqrt(0.01 / tau), 0.4 * std::sqrt(0.01 / tau));
  const double shifted = all["theo1"]["tau_s"][0];
  EXPECT_NEAR(all["theo1"]["deviation"][0].get<double>(), std::sqrt(0.01 / shifted), 0.4 * std::sqrt(0.01 / shifted));
  EXPECT_NEAR(all["psd"]["density"].back().get<double>(), 0.02, 0.008);
  EXPECT_EQ(all["psd"]["density"].size(), all["psd"]["ci95"].size());
  EXPECT_EQ(all["allan"], plain["allan"]);
  EXPECT_EQ(all["fits"], plain["fits"]);
}

TEST(CharacteriseRequest, TakesANumberOfAveragingTimesWithinBounds) {
  for (const auto& [asked, taken] :
       {std::pair{2, true}, {500, true}, {0, true}, {1, false}, {501, false}, {-3, false}}) {
    Faults faults;
    const CharacteriseOptions options = characterise_options_from_json(Json{{"taus", asked}}, "/parameters", faults);
    EXPECT_EQ(faults.none(), taken) << asked;
    EXPECT_EQ(to_json(options).contains("taus"), asked != 0) << asked;
  }
}

/// Whoever plots 120 tau gets the octaves' values and intervals wherever the two meet.
TEST(CharacterisationDocument, HoldsAFinerAllanCurveThatPassesThroughTheOctaves) {
  Random random(5);
  std::vector<double> x(8192);
  double walk = 0.0;
  for (double& value : x) {
    walk += 0.01 * random.normal();
    value = walk + random.normal();
  }
  const ColumnRole role{.quantity = Quantity::AngularRate, .axis = "z", .unit = *parse_unit("deg/s")};
  const auto found = characterise_channel({.values = x, .dt_s = 0.25, .si_factor = role.unit->factor},
                                          {.models = {"WN+RW"}, .also = {.taus = 120}});
  const Json document = to_json(ChannelIdentity{"gz", role}, *found);
  const Json& fine = document["allan_fine"];
  const Json& octaves = document["allan"];
  EXPECT_GT(fine["tau_s"].size(), 80U);
  std::size_t met = 0;
  for (std::size_t i = 0; i < fine["tau_s"].size(); ++i) {
    for (std::size_t j = 0; j < octaves["tau_s"].size(); ++j) {
      if (fine["tau_s"][i] == octaves["tau_s"][j]) {
        const double deviation = octaves["deviation"][j];
        EXPECT_NEAR(fine["deviation"][i].get<double>(), deviation, 1e-9 * deviation);
        EXPECT_NEAR(fine["ci95"][i][0].get<double>(), octaves["ci95"][j][0].get<double>(), 1e-6 * deviation);
        EXPECT_NEAR(fine["ci95"][i][1].get<double>(), octaves["ci95"][j][1].get<double>(), 1e-6 * deviation);
        ++met;
      }
    }
  }
  EXPECT_GE(met, 4U);
}

}  // namespace
}  // namespace driftlab
