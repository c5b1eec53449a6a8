#include "schema/json/pooled_sensor.hpp"

#include "core/fit/characterise.hpp"
#include "core/process/model.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/json/trend_table.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

/// A channel document of white noise of level `n` [deg/s sqrt(s)].
Json channel(double n, std::uint64_t seed, const char* unit = "deg/s", double outliers = 0.0) {
  Random random(seed);
  std::vector<double> x = simulate({*make_process("white_noise", {n})}, random, 0.01, 4096);
  for (double& value : x) {
    if (outliers > 0.0 && random.uniform() < 0.002) {
      value += outliers * random.normal();
    }
  }
  const Unit meaning = *parse_unit(unit);
  const auto found = characterise_channel({x, 0.01, meaning.factor}, {.models = {"WN", "WN+RW"}});
  ColumnRole role{Quantity::AngularRate, "z", meaning};
  return to_json(ChannelIdentity{"gz", role}, *found);
}

std::vector<TableSource> two_conditions() {
  return {{"rec_a", "static", channel(0.02, 1), "chr_a"},
          {"rec_b", "static", channel(0.02, 2), "chr_b"},
          {"rec_c", "constant_rate:z:9:deg/s", channel(0.03, 3), "chr_c"}};
}

Json table_of(const std::vector<TableSource>& sources, const Json* pooled) {
  return *build_parameter_table({"phone-07", Quantity::AngularRate, "z", TableMethod::Gmwm, ""}, sources, pooled);
}

TEST(PooledSensor, FitsReplicatesJointlyAndTheTableShowsIt) {
  const auto sources = two_conditions();
  const Json pooled = *pool_sensor(sources, {}, {});
  EXPECT_EQ(pooled["model"], "WN");
  ASSERT_EQ(pooled["conditions"].size(), 2U);
  const Json& still = pooled["conditions"][0];
  EXPECT_EQ(still["recordings"], Json::array({"rec_a", "rec_b"}));
  EXPECT_TRUE(still["agreement"]["agree"].get<bool>());
  EXPECT_EQ(still["fits"][0]["intervals"], "profile");
  EXPECT_TRUE(pooled["conditions"][1]["agreement"].is_null());

  const Json table = table_of(sources, &pooled);
  EXPECT_EQ(table["rows"][0]["pooling"], "joint");
  EXPECT_EQ(table["rows"][1]["pooling"], "single");
  const Json& joint = table["rows"][0]["values"]["white_noise.N"];
  const Json& stored = still["fits"][0]["processes"][0]["params"]["N"];
  EXPECT_EQ(joint["value"], stored["value"]);
  // Without the pooled document the same row is an average, close to it and said to be one.
  const Json averaged = table_of(sources, nullptr);
  EXPECT_EQ(averaged["rows"][0]["pooling"], "average");
  EXPECT_NEAR(averaged["rows"][0]["values"]["white_noise.N"]["value"].get<double>() / joint["value"].get<double>(), 1.0,
              0.005);
}

TEST(PooledSensor, CountsOnlyForExactlyItsResults) {
  auto sources = two_conditions();
  const Json pooled = *pool_sensor(sources, {}, {});
  sources[1].result_id = "chr_new";  // characterised again in the meantime
  EXPECT_EQ(table_of(sources, &pooled)["rows"][0]["pooling"], "average");
  EXPECT_EQ(find_pooled(&pooled, "static", {"chr_b", "chr_a"}), &pooled["conditions"][0]);
  EXPECT_EQ(find_pooled(&pooled, "static", {"chr_a"}), nullptr);
  EXPECT_EQ(find_pooled(nullptr, "static", {"chr_a"}), nullptr);
}

TEST(PooledSensor, FlagsReplicatesThatDisagree) {
  const std::vector<TableSource> sources{{"rec_a", "static", channel(0.02, 1), "chr_a"},
                                         {"rec_b", "static", channel(0.03, 2), "chr_b"}};
  const Json pooled = *pool_sensor(sources, {}, {});
  EXPECT_FALSE(pooled["conditions"][0]["agreement"]["agree"].get<bool>());
  const Json table = table_of(sources, &pooled);
  EXPECT_NE(table_to_text(table).find("! static: its recordings disagree"), std::string::npos);
  EXPECT_NE(table_to_markdown(table).find("| static * |"), std::string::npos);
}

TEST(PooledSensor, TakesRobustVariancesOfAContaminatedRecordingAndMarksIt) {
  const std::vector<TableSource> sources{{"rec_a", "static", channel(0.02, 1), "chr_a"},
                                         {"rec_b", "static", channel(0.02, 2, "deg/s", 10.0), "chr_b"}};
  ASSERT_EQ(sources[1].channel["contamination"]["verdict"], "contaminated");
  const Json pooled = *pool_sensor(sources, {}, {});
  const Json& entry = pooled["conditions"][0];
  EXPECT_TRUE(entry["robust"].get<bool>());
  EXPECT_EQ(entry["contamination"], "contaminated");
  // 0.2 % of errors of 50 sd: the classical variances are six times too large, the robust ones within a few percent.
  const double n = entry["fits"][0]["processes"][0]["params"]["N"]["value"].get<double>();
  EXPECT_NEAR(n, 0.02 * 60.0, 0.1 * 0.02 * 60.0);
  const std::string text = table_to_text(table_of(sources, &pooled));
  EXPECT_NE(text.find("static *"), std::string::npos);
  EXPECT_NE(text.find("robust variances"), std::string::npos);
}

TEST(PooledSensor, TakesUntouchedConditionsFromAnEarlierDocument) {
  auto sources = two_conditions();
  Json earlier = *pool_sensor(sources, {}, {});
  earlier["conditions"][0]["fits"][0]["status"] = "taken over";
  sources.push_back({"rec_d", "constant_rate:z:9:deg/s", channel(0.03, 4), "chr_d"});
  const std::vector<Json> previous{earlier};
  const Json pooled = *pool_sensor(sources, previous, {});
  EXPECT_EQ(pooled["conditions"][0]["fits"][0]["status"], "taken over");
  EXPECT_EQ(pooled["conditions"][1]["recordings"].size(), 2U);
  EXPECT_NE(pooled["conditions"][1]["fits"][0]["status"], "taken over");
}

TEST(PooledSensor, PutsRecordingsInDifferentUnitsTogetherAndRefusesOthers) {
  std::vector<TableSource> sources{{"rec_a", "static", channel(0.02, 1), "chr_a"},
                                   {"rec_b", "static", channel(0.02 * 0.017453292519943295, 2, "rad/s"), "chr_b"}};
  EXPECT_TRUE((*pool_sensor(sources, {}, {}))["conditions"][0]["agreement"]["agree"].get<bool>());
  sources[1].channel["unit"] = "g";
  EXPECT_EQ(pool_sensor(sources, {}, {}).error().code, ErrorCode::InvalidArgument);
}

TEST(PooledSensor, SummaryOfADocumentHoldsReplicatesAndTrends) {
  const auto recording = [](const char* id, const Json& condition, const Json& one) {
    return Json{{"id", id}, {"condition", condition}, {"channels", {one}}};
  };
  Json document = characterisation_document(
      {recording("a", {{"kind", "static"}}, channel(0.02, 1)),
       recording("b", {{"kind", "constant_rate"}, {"axis", "z"}, {"value", 9.0}, {"unit", "deg/s"}},
                 channel(0.03, 2))});
  ASSERT_TRUE(add_summary(document, "phone-07", sensors_of(document), {}));
  ASSERT_EQ(document["replicates"].size(), 1U);
  EXPECT_EQ(pooled_of(document, sensors_of(document)[0]), &document["replicates"][0]);
  ASSERT_EQ(document["trends"].size(), 2U);  // av and gmwm
  const Json& trend = document["trends"][1]["trends"][0];
  EXPECT_EQ(trend["parameter"], "white_noise.N");
  EXPECT_EQ(trend["against"]["kind"], "rate");
  EXPECT_EQ(trend["monotone"]["direction"], "up");
  EXPECT_NE(trends_to_text(document["trends"][1]).find("white_noise.N ↑ against |rate|"), std::string::npos);
}

TEST(PooledSensor, CanBeCancelled) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(pool_sensor(two_conditions(), {}, {stop.get_token(), nullptr}).error().code, ErrorCode::Cancelled);
}

}  // namespace
}  // namespace driftlab
