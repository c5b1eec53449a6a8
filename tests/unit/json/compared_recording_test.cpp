/// A local regression run read its own characterisation back from a document. It reads the struct, and must say the
/// same to the bit: what is stored in a state is compared with what was just characterised.
#include "schema/json/compared_recording.hpp"

#include "core/analysis/compared_recording.hpp"
#include "core/process/model.hpp"
#include "core/process/random.hpp"
#include "schema/json/characterise.hpp"
#include "schema/json/reported_channel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A turning gyroscope in deg/s and a column of no unit, with a temperature and facts of the file.
CharacterisedRecording turning() {
  CharacterisedRecording recording;
  recording.spec.id = "a/turning.csv";
  recording.spec.condition = *parse_condition("constant_rate:z:9.1:deg/s");
  recording.window.time.dt_s = 0.01;
  Quality& quality = recording.window.quality;
  quality.samples = 4100;
  quality.analysed = 4096;
  quality.missing = 4;
  quality.jitter_s = 1.0 / 3.0e4;
  quality.measured_rate_hz = 99.7;
  quality.clock_ratio = 0.997;
  quality.channels.resize(2);
  quality.channels[0].column = "gz";
  quality.channels[0].missing = 3;
  quality.channels[0].implausible = 2;
  quality.channels[0].repeated = 11;
  quality.channels[0].saturated = 5;
  quality.channels[0].frozen = 7;
  quality.channels[0].resolution = 1.0 / 131.0;
  quality.channels[1].column = "raw";
  recording.temperature = MeasuredTemperature{"temp", 100.0 / 3.0, 30.0, 35.0};
  const ColumnRole rate{Quantity::AngularRate, "z", *parse_unit("deg/s")};
  const ColumnRole plain{Quantity::Unspecified, "", std::nullopt};
  Random random(20261126);
  for (const auto& [column, role] : {std::pair{"gz", rate}, {"raw", plain}}) {
    std::vector<double> x = simulate({*make_process("white_noise", {0.02})}, random, 0.01, 4096);
    for (double& value : x) {
      value += 9.1 + (random.uniform() < 0.002 ? 3.0 * random.normal() : 0.0);
    }
    const double factor = role.unit.value_or(Unit{}).factor;
    recording.channels.push_back(
        {column, role, *characterise_channel({x, 0.01, factor}, {.models = {"WN", "WN+RW"}}), std::nullopt});
  }
  recording.channels[0].reference = ReferenceAlignment{};
  return recording;
}

regression::ComparedRecording stored(const CharacterisedRecording& recording) {
  return *compared_recording_from_json(*parse_json(to_text(to_json(recording))));
}

void expect_same(const regression::ChannelFacts& here, const regression::ChannelFacts& there) {
  EXPECT_EQ(here.samples, there.samples);
  EXPECT_EQ(here.missing, there.missing);
  EXPECT_EQ(here.frozen, there.frozen);
  EXPECT_EQ(here.repeated, there.repeated);
  EXPECT_EQ(here.saturated, there.saturated);
  EXPECT_EQ(here.bursts, there.bursts);
  EXPECT_EQ(here.resolution, there.resolution);
  EXPECT_EQ(here.mean, there.mean);
  EXPECT_EQ(here.mean_of_error, there.mean_of_error);
}

void expect_same(const ReportedChannel& here, const ReportedChannel& there) {
  EXPECT_EQ(here.channel, there.channel);
  EXPECT_EQ(here.quantity, there.quantity);
  EXPECT_EQ(here.axis, there.axis);
  EXPECT_EQ(here.unit, there.unit);
  EXPECT_EQ(here.samples, there.samples);
  EXPECT_EQ(here.missing, there.missing);
  EXPECT_EQ(here.dt_s, there.dt_s);
  EXPECT_EQ(here.haar, there.haar);
  EXPECT_EQ(here.contamination, there.contamination);
  EXPECT_EQ(here.allan, there.allan);
  EXPECT_EQ(here.discrepancy, there.discrepancy);
  EXPECT_EQ(here.from_tau_s, there.from_tau_s);
  EXPECT_EQ(here.description, there.description);
  ASSERT_EQ(here.fits.size(), there.fits.size());
  for (std::size_t f = 0; f < here.fits.size(); ++f) {
    EXPECT_EQ(here.fits[f].processes, there.fits[f].processes);
    EXPECT_EQ(to_text(to_json(here.fits[f])), to_text(to_json(there.fits[f])));
  }
}

void expect_same(const regression::ComparedRecording& here, const regression::ComparedRecording& there) {
  EXPECT_EQ(here.id, there.id);
  EXPECT_EQ(here.session, there.session);
  EXPECT_EQ(here.began_s, there.began_s);
  EXPECT_EQ(here.condition, there.condition);
  EXPECT_EQ(here.duration_s, there.duration_s);
  EXPECT_EQ(here.rate_hz, there.rate_hz);
  EXPECT_EQ(here.declared_hz, there.declared_hz);
  EXPECT_EQ(here.jitter_s, there.jitter_s);
  EXPECT_EQ(here.samples, there.samples);
  EXPECT_EQ(here.missing, there.missing);
  EXPECT_EQ(here.temperature_degc, there.temperature_degc);
  EXPECT_EQ(here.investigated, there.investigated);
  EXPECT_EQ(here.causes, there.causes);
  ASSERT_EQ(here.channels.size(), there.channels.size());
  for (std::size_t c = 0; c < here.channels.size(); ++c) {
    expect_same(here.channels[c].result, there.channels[c].result);
    expect_same(here.channels[c].facts, there.channels[c].facts);
  }
}

TEST(ComparedRecording, IsTheSameFromItsCharacterisationAndFromItsStoredDocument) {
  const CharacterisedRecording recording = turning();
  const regression::ComparedRecording here = compared_recording(recording);
  EXPECT_EQ(here.condition, "constant_rate:z:9.1:deg/s");
  EXPECT_EQ(here.channels.size(), 2U);
  EXPECT_TRUE(here.channels[0].facts.mean_of_error);
  expect_same(here, stored(recording));
}

TEST(ComparedRecording, HasOfWhatIsNotFiniteWhatADocumentHas) {
  CharacterisedRecording recording = turning();
  recording.temperature->median_degc = kInfinite;
  recording.window.quality.jitter_s = kInfinite;
  recording.window.quality.clock_ratio = kInfinite;
  recording.window.quality.channels[0].resolution = kInfinite;
  ChannelCharacterisation& channel = recording.channels[0].result;
  channel.mean = kInfinite;
  channel.fits[0].wic = kInfinite;
  channel.fits[0].objective = kInfinite;
  const regression::ComparedRecording here = compared_recording(recording);
  EXPECT_FALSE(here.temperature_degc || here.declared_hz || here.channels[0].facts.mean);
  EXPECT_TRUE(std::isnan(here.channels[0].result.fits[0].wic));
  expect_same(here, stored(recording));
}

}  // namespace
}  // namespace driftlab
