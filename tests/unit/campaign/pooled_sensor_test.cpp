#include "core/campaign/pooled_sensor.hpp"

#include "core/campaign/campaign_summary.hpp"
#include "core/fit/characterise.hpp"
#include "core/process/model.hpp"

#include <gtest/gtest.h>

#include <stop_token>

namespace driftlab {
namespace {

/// A channel of white noise of level `n` [deg/s sqrt(s)].
ReportedChannel channel(double n, std::uint64_t seed, const char* unit = "deg/s", double outliers = 0.0) {
  Random random(seed);
  std::vector<double> x = simulate({*make_process("white_noise", {n})}, random, 0.01, 4096);
  for (double& value : x) {
    if (outliers > 0.0 && random.uniform() < 0.002) {
      value += outliers * random.normal();
    }
  }
  const Unit meaning = *parse_unit(unit);
  const auto found = characterise_channel({x, 0.01, meaning.factor}, {.models = {"WN", "WN+RW"}});
  return reported("gz", ColumnRole{Quantity::AngularRate, "z", meaning}, *found);
}

std::vector<TableSource> two_conditions() {
  return {{"rec_a", "static", channel(0.02, 1), "chr_a"},
          {"rec_b", "static", channel(0.02, 2), "chr_b"},
          {"rec_c", "constant_rate:z:9:deg/s", channel(0.03, 3), "chr_c"}};
}

ParameterTable table_of(const std::vector<TableSource>& sources, const PooledSensor* pooled) {
  return *build_parameter_table({"phone-07", Quantity::AngularRate, "z", TableMethod::Gmwm, ""}, sources, pooled);
}

TEST(PooledSensor, FitsReplicatesJointlyAndTheTableShowsIt) {
  const auto sources = two_conditions();
  const PooledSensor pooled = *pool_sensor(sources, {}, {});
  EXPECT_EQ(pooled.model, "WN");
  ASSERT_EQ(pooled.conditions.size(), 2U);
  const PooledCondition& still = pooled.conditions[0];
  EXPECT_EQ(still.recordings, (std::vector<std::string>{"rec_a", "rec_b"}));
  ASSERT_TRUE(still.agreement);
  EXPECT_TRUE(still.agreement->agree());
  EXPECT_EQ(still.fits[0].intervals, "profile");
  EXPECT_FALSE(pooled.conditions[1].agreement);

  const ParameterTable table = table_of(sources, &pooled);
  EXPECT_EQ(table.rows[0].pooling, Pooling::Joint);
  EXPECT_EQ(table.rows[1].pooling, Pooling::Single);
  ASSERT_EQ(table.columns[0].key, "white_noise.N");
  const ReportedValue& joint = table.rows[0].cells[0].estimate;
  EXPECT_EQ(joint, still.fits[0].processes[0].parameters[0].second);
  // Without the pooled result the same row is an average, close to it and said to be one.
  const ParameterTable averaged = table_of(sources, nullptr);
  EXPECT_EQ(averaged.rows[0].pooling, Pooling::Average);
  EXPECT_NEAR(*averaged.rows[0].cells[0].estimate.value / *joint.value, 1.0, 0.005);
}

TEST(PooledSensor, EndsBetweenTwoModelsWhenItIsCancelled) {
  auto sources = two_conditions();
  sources.pop_back();  // of one condition: no other begins at which it could end
  std::stop_source stop;
  RunControl control{stop.get_token(), {}};
  control.progress = [&](std::string_view, double) { stop.request_stop(); };
  const auto pooled = pool_sensor(sources, {}, control);
  ASSERT_FALSE(pooled);
  EXPECT_EQ(pooled.error().code, ErrorCode::Cancelled);
}

TEST(PooledSensor, CountsOnlyForExactlyItsResults) {
  auto sources = two_conditions();
  const PooledSensor pooled = *pool_sensor(sources, {}, {});
  sources[1].result_id = "chr_new";  // characterised again in the meantime
  EXPECT_EQ(table_of(sources, &pooled).rows[0].pooling, Pooling::Average);
  EXPECT_EQ(find_pooled(&pooled, "static", {"chr_b", "chr_a"}), &pooled.conditions[0]);
  EXPECT_EQ(find_pooled(&pooled, "static", {"chr_a"}), nullptr);
  EXPECT_EQ(find_pooled(nullptr, "static", {"chr_a"}), nullptr);
}

TEST(PooledSensor, FlagsReplicatesThatDisagree) {
  const std::vector<TableSource> sources{{"rec_a", "static", channel(0.02, 1), "chr_a"},
                                         {"rec_b", "static", channel(0.03, 2), "chr_b"}};
  const PooledSensor pooled = *pool_sensor(sources, {}, {});
  ASSERT_TRUE(pooled.conditions[0].agreement);
  EXPECT_FALSE(pooled.conditions[0].agreement->agree());
  const ParameterTable table = table_of(sources, &pooled);
  ASSERT_TRUE(table.rows[0].agreement);
  EXPECT_EQ(table.rows[0].agreement->p, pooled.conditions[0].agreement->p);
}

TEST(PooledSensor, TakesRobustVariancesOfAContaminatedRecordingAndMarksIt) {
  const std::vector<TableSource> sources{{"rec_a", "static", channel(0.02, 1), "chr_a"},
                                         {"rec_b", "static", channel(0.02, 2, "deg/s", 10.0), "chr_b"}};
  ASSERT_TRUE(sources[1].channel.contaminated());
  const PooledSensor pooled = *pool_sensor(sources, {}, {});
  const PooledCondition& entry = pooled.conditions[0];
  EXPECT_TRUE(entry.robust);
  EXPECT_EQ(entry.contamination, "contaminated");
  // 0.2 % of errors of 50 sd: the classical variances are six times too large, the robust ones within a few percent.
  EXPECT_NEAR(*entry.fits[0].processes[0].parameters[0].second.value, 0.02 * 60.0, 0.1 * 0.02 * 60.0);
  const TableRow row = table_of(sources, &pooled).rows[0];
  EXPECT_TRUE(row.robust);
  EXPECT_EQ(row.contamination, "contaminated");
}

TEST(PooledSensor, TakesUntouchedConditionsFromAnEarlierResult) {
  auto sources = two_conditions();
  PooledSensor earlier = *pool_sensor(sources, {}, {});
  earlier.conditions[0].fits[0].status = "taken over";
  sources.push_back({"rec_d", "constant_rate:z:9:deg/s", channel(0.03, 4), "chr_d"});
  const std::vector<PooledSensor> previous{earlier};
  const PooledSensor pooled = *pool_sensor(sources, previous, {});
  EXPECT_EQ(pooled.conditions[0].fits[0].status, "taken over");
  EXPECT_EQ(pooled.conditions[1].recordings.size(), 2U);
  EXPECT_NE(pooled.conditions[1].fits[0].status, "taken over");
}

TEST(PooledSensor, PutsRecordingsInDifferentUnitsTogether) {
  const std::vector<TableSource> sources{
      {"rec_a", "static", channel(0.02, 1), "chr_a"},
      {"rec_b", "static", channel(0.02 * 0.017453292519943295, 2, "rad/s"), "chr_b"}};
  EXPECT_TRUE(pool_sensor(sources, {}, {})->conditions[0].agreement->agree());
}

TEST(PooledSensor, SaysWhichUnitsDoNotConvertInPlaceOfAFit) {
  // A recording whose column had no unit came to stand beside one in deg/s: the pooling error was swallowed, nothing
  // said why there was no joint fit, and the table averaged deg/sqrt(h) with sqrt(s).
  std::vector<TableSource> sources{{"rec_a", "static", channel(0.02, 1), "chr_a"},
                                   {"rec_b", "static", channel(0.02, 2), "chr_b"}};
  sources[1].channel.unit = "1";
  const auto pooled = pool_sensor(sources, {}, {});
  ASSERT_TRUE(pooled);
  const std::string conflict =
      "The channels of this axis are in units that do not convert into each other, deg/s and 1.";
  EXPECT_EQ(pooled->reason, conflict);
  EXPECT_TRUE(pooled->conditions.empty());
  const auto table =
      build_parameter_table({"phone-07", Quantity::AngularRate, "z", TableMethod::Av, ""}, sources, &*pooled);
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(table.error().message.substr(0, conflict.size()), conflict);
  const auto summary = summarise_campaign("phone-07", {{"angular_rate", "z", sources}}, {});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->replicates[0].reason, conflict);
  EXPECT_TRUE(summary->trends.empty());
}

TEST(PooledSensor, SaysInTheRowWhichRecordingHasTooFewVariancesForAJointFit) {
  // A contaminated recording whose robust estimator had a root at one scale alone could not be stacked: the condition
  // stayed without a joint fit, and nothing said so.
  std::vector<TableSource> sources = two_conditions();
  ReportedChannel& spoiled = sources[1].channel;
  spoiled.contamination = "contaminated";
  std::fill(spoiled.haar.robust_variance.begin() + 1, spoiled.haar.robust_variance.end(), 0.0);
  const auto pooled = pool_sensor(sources, {}, {});
  ASSERT_TRUE(pooled);
  EXPECT_NE(pooled->conditions[0].reason.find("fewer than two wavelet variances"), std::string::npos);
  EXPECT_EQ(pooled->conditions[1].reason, "");
  const ParameterTable table = table_of(sources, &*pooled);
  EXPECT_EQ(table.rows[0].pooling, Pooling::Average);
  ASSERT_FALSE(table.rows[0].warnings.empty());
  EXPECT_EQ(table.rows[0].warnings.back(),
            "The recordings could not be fitted together. " + pooled->conditions[0].reason);
}

TEST(PooledSensor, FailsOnVariancesThatAreNotWhatTheySay) {
  // A stored channel with a scale longer than its record is a fault of the store, not a result: it was taken for a
  // model without components, and the table fell back to averages without a word.
  std::vector<TableSource> sources = two_conditions();
  sources[1].channel.samples = 16;
  const auto pooled = pool_sensor(sources, {}, {});
  ASSERT_FALSE(pooled);
  EXPECT_EQ(pooled.error().code, ErrorCode::InvalidArgument);
  EXPECT_FALSE(summarise_campaign("phone-07", {{"angular_rate", "z", sources}}, {}));
}

TEST(PooledSensor, CanBeCancelled) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(pool_sensor(two_conditions(), {}, {stop.get_token(), nullptr}).error().code, ErrorCode::Cancelled);
  EXPECT_EQ(pool_sensor({}, {}, {}).error().code, ErrorCode::InvalidArgument);
}

TEST(CampaignSummary, HoldsReplicatesAndTrendsOfEveryAxisAndItsProgressEndsAtOne) {
  const std::vector<TableSource> sources{{"a", "static", channel(0.02, 1)},
                                         {"b", "constant_rate:z:9:deg/s", channel(0.03, 2)}};
  double last = 0.0;
  const RunControl control{{}, [&](std::string_view, double fraction) {
                             EXPECT_GE(fraction, last);
                             EXPECT_LE(fraction, 1.0);
                             last = fraction;
                           }};
  const auto summary = summarise_campaign(
      "phone-07", {{"angular_rate", "z", sources}, {"angular_rate", "x", {sources[0]}}, {"angular_rate", "y", sources}},
      control);
  ASSERT_TRUE(summary);
  ASSERT_EQ(summary->replicates.size(), 2U);
  EXPECT_EQ(summary->replicates[1].sensor_axis, "y");
  ASSERT_EQ(summary->trends.size(), 4U);  // av and gmwm of both
  EXPECT_EQ(summary->trends[1].trends[0].column.key, "N");
  const ColumnTrend& trend = summary->trends[1].trends[1];
  EXPECT_EQ(trend.column.key, "white_noise.N");
  EXPECT_EQ(trend.against, Dynamics::Rate);
  EXPECT_EQ(trend.trend.direction, 1);
}

}  // namespace
}  // namespace driftlab
