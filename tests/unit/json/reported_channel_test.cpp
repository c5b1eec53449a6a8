#include "schema/json/reported_channel.hpp"

#include "core/campaign/campaign_summary.hpp"
#include "core/fit/characterise.hpp"
#include "core/process/model.hpp"
#include "schema/json/campaign_summary.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/json/characterise.hpp"
#include "schema/json/parameter_table.hpp"
#include "schema/json/pooled_sensor.hpp"
#include "schema/json/trend_table.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

const ColumnRole kRole{Quantity::AngularRate, "z", *parse_unit("deg/s")};

/// White noise and a random walk, with gross errors where `outliers` says so.
ChannelCharacterisation characterised(double n, std::uint64_t seed, double outliers = 0.0) {
  Random random(seed);
  std::vector<double> x = simulate({*make_process("white_noise", {n})}, random, 0.01, 4096);
  for (double& value : x) {
    if (outliers > 0.0 && random.uniform() < 0.002) {
      value += outliers * random.normal();
    }
  }
  return *characterise_channel({x, 0.01, kRole.unit->factor}, {.models = {"WN", "WN+RW", "WN+GM"}});
}

/// What a store gives back of a document.
Json stored(const Json& document) { return *parse_json(to_text(document)); }

TEST(ReportedChannel, IsTheSameFromItsCharacterisationAndFromItsStoredDocument) {
  for (const double outliers : {0.0, 10.0}) {
    const ChannelCharacterisation channel = characterised(0.02, 1, outliers);
    const ReportedChannel told = reported("gz", kRole, channel);
    const Json document = stored(to_json(ChannelIdentity{"gz", kRole}, channel));
    const auto read = reported_channel_from_json(document);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->channel, "gz");
    EXPECT_EQ(read->quantity, told.quantity);
    EXPECT_EQ(read->axis, "z");
    EXPECT_EQ(read->unit, "deg/s");
    EXPECT_EQ(read->samples, 4096U);
    EXPECT_EQ(read->dt_s, told.dt_s);
    EXPECT_EQ(read->contamination, outliers > 0.0 ? "contaminated" : "clean");
    EXPECT_EQ(read->haar.scale, told.haar.scale);
    EXPECT_EQ(read->haar.variance, told.haar.variance);
    EXPECT_EQ(read->haar.robust_variance, told.haar.robust_variance);
    EXPECT_EQ(read->haar.robust_efficiency, told.haar.robust_efficiency);
    EXPECT_EQ(read->allan, told.allan);
    ASSERT_EQ(read->fits.size(), 3U);
    for (std::size_t f = 0; f < 3; ++f) {
      EXPECT_EQ(read->fits[f].processes, told.fits[f].processes);
      Json alone =
          document["fits"][f];  // how far it is from the closest is said of all fits together, and not read back
      EXPECT_EQ(alone.erase("distance_2p") + alone.erase("closest"), 2U);
      EXPECT_EQ(to_text(to_json(read->fits[f])), to_text(alone));
    }
  }
}

TEST(ReportedChannel, RefusesWhatDriftlabHasNotWritten) {
  for (const char* const text : {"null", "{}", R"({"samples": "many"})"}) {
    const auto read = reported_channel_from_json(*parse_json(text));
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, ErrorCode::Internal);
    EXPECT_FALSE(pooled_sensor_from_json(*parse_json(text))) << text;
  }
  EXPECT_FALSE(sensors_of(Json::object()));
}

Json campaign() {
  const auto recording = [](const char* id, const Json& condition, const ChannelCharacterisation& channel) {
    return Json{{"id", id}, {"condition", condition}, {"channels", {to_json(ChannelIdentity{"gz", kRole}, channel)}}};
  };
  return characterisation_document(
      {recording("a", {{"kind", "static"}}, characterised(0.02, 1)),
       recording("b", {{"kind", "static"}}, characterised(0.02, 2, 10.0)),
       recording("c", {{"kind", "constant_rate"}, {"axis", "z"}, {"value", 9.0}, {"unit", "deg/s"}},
                 characterised(0.03, 3))});
}

TEST(CampaignSummaryDocument, GivesBackWhatWasPutTogether) {
  Json document = campaign();
  const auto sensors = sensors_of(document);
  ASSERT_TRUE(sensors);
  const auto summary = summarise_campaign("phone-07", *sensors, {});
  ASSERT_TRUE(summary);
  EXPECT_TRUE(pooled_sensors_of(document)->empty());
  add_summary(document, *summary);
  ASSERT_EQ(document["replicates"].size(), 1U);
  const Json& replicates = document["replicates"][0];
  EXPECT_EQ(replicates["conditions"][0]["members"], Json::array({"a", "b"}));
  EXPECT_EQ(replicates["conditions"][0]["agreement"]["model"], replicates["model"]);
  EXPECT_TRUE(replicates["conditions"][1]["agreement"].is_null());
  EXPECT_EQ(document["trends"].size(), 2U);
  const auto pooled = pooled_sensors_of(stored(document));
  ASSERT_TRUE(pooled);
  const PooledSensor* const found = find_pooled(*pooled, sensors->front());
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(to_text(to_json(*found)), to_text(replicates));
  EXPECT_EQ(find_pooled(*pooled, {"angular_rate", "x", {}}), nullptr);
  EXPECT_FALSE(pooled_sensors_of(Json{{"replicates", {1}}}));
}

TEST(CampaignSummaryDocument, HasTheRemarksAndFrozenSamplesOfItsRecordings) {
  CharacterisedRecording recording;
  recording.spec.id = "a";
  recording.window.time.dt_s = 0.01;
  recording.window.quality.notes = {"The column t has no unit."};
  recording.window.quality.channels.resize(1);
  recording.window.quality.channels[0].column = "gz";
  recording.window.quality.channels[0].frozen = 7;
  recording.channels.push_back({"gz", kRole, characterised(0.02, 1), std::nullopt});
  recording.channels[0].result.warnings = {"A sentence."};
  const auto remarks = remarks_of(std::vector{recording});
  EXPECT_EQ(remarks, (std::vector<Remark>{{"a", "The column t has no unit."}, {"a, gz", "A sentence."}}));
  const Json document = stored(characterisation_document({to_json(recording)}));
  const auto read = remarks_of(document);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, remarks);
  EXPECT_EQ(sensors_of(document)->front().sources.front().frozen, 7U);
  EXPECT_FALSE(remarks_of(Json{{"recordings", {{{"id", "a"}}}}}));
}

TEST(CampaignSummaryDocument, SaysWhyNothingCouldBePutTogether) {
  Json document = campaign();
  document["recordings"][1]["channels"][0]["unit"] = "1";
  const auto summary = summarise_campaign("phone-07", *sensors_of(document), {});
  ASSERT_TRUE(summary);
  add_summary(document, *summary);
  EXPECT_EQ(
      document["replicates"][0],
      (Json{{"quantity", "angular_rate"},
            {"axis", nullptr},
            {"model", nullptr},
            {"structure", nullptr},
            {"conditions", Json::array()},
            {"reason", "The channels of this axis are in units that do not convert into each other, deg/s and 1."},
            {"sensor_axis", "z"}}));
  EXPECT_EQ(to_json(*pooled_sensor_from_json(document["replicates"][0])), document["replicates"][0]);
}

TEST(ParameterTableDocument, HasACellOrAReasonPerColumn) {
  TableRow row;
  row.label = "static";
  row.recordings = {"rec_a", "rec_b"};
  row.pooling = Pooling::Average;
  row.agreement = RecordingAgreement{"", 1.5, 1.0, 0.22};
  row.density = {{1.4, 1.25, 1.5, "deg/sqrt(h)", ""}, Change::None};
  row.cells = {{{1.5, 1.0, {}, "deg/sqrt(h)", ""}, Change::Up, {1.25, 1.1, {}, "1", ""}},
               {{{}, {}, {}, "deg/h", "No B."}, {}}};
  const Json document = to_json(ParameterTable{
      "phone-07", Quantity::AngularRate, "", TableMethod::Av, "", {{"N", "deg/sqrt(h)"}, {"B", ""}}, {row}});
  const Json wanted = *parse_json(R"json({"device": "phone-07", "sensor": "gyroscope", "axis": null, "method": "av",
    "model": null, "columns": [{"key": "N", "unit": "deg/sqrt(h)"}, {"key": "B", "unit": null}],
    "rows": [{"condition": {"kind": "static"}, "label": "static",
              "density": {"value": 1.4, "unit": "deg/sqrt(h)", "ci95": [1.25, 1.5], "change": "none", "ratio": null},
              "recordings": ["rec_a", "rec_b"], "duration_s": 0.0, "fits": null, "j_test_p": null, "contamination": null, "pooling": "average", "robust": false,
              "agreement": {"model": null, "statistic": 1.5, "dof": 1, "p": 0.22, "agree": true}, "warnings": [],
              "values": {"N": {"value": 1.5, "unit": "deg/sqrt(h)", "ci95": [1.0, null], "change": "up",
                               "ratio": {"value": 1.25, "unit": "1", "ci95": [1.1, null]}}, "B": null},
              "reasons": {"B": "No B."}, "why": {"B": "not_identifiable"}}],
    "reference": "static", "model_note": null})json");
  EXPECT_EQ(document, wanted);
}

TEST(TrendDocument, HasPointsTestsAndRelation) {
  TableRow still;
  still.label = "static";
  still.cells = {{{1.0, 0.98, 1.02, "1/s", ""}, {}}};
  TableRow turning = still;
  turning.condition = *parse_condition("constant_rate:z:9:deg/s");
  turning.label = "9";
  const ParameterTable table{"phone",           Quantity::AngularRate, "z", TableMethod::Gmwm, "WN+GM",
                             {{"beta", "1/s"}}, {still, turning}};
  const Json document = to_json(build_trends(table));
  ASSERT_EQ(document["trends"].size(), 1U);
  const Json& trend = document["trends"][0];
  EXPECT_EQ(trend["against"], (Json{{"kind", "rate"}, {"unit", "deg/s"}}));
  EXPECT_EQ(trend["points"][0]["ci95"], (Json{0.98, 1.02}));
  EXPECT_EQ(trend["equal"]["dof"], 1);
  EXPECT_EQ(trend["monotone"]["direction"], "none");
  EXPECT_EQ(trend["relation"]["kind"], "constant");
  EXPECT_EQ(trend["statement"], "Does not move.");
}

}  // namespace
}  // namespace driftlab
