/// What is printed of a local run was read back from its own document. It is made of the struct, and a daemon's
/// document must give the same to the bit.
#include "schema/json/told_characterisation.hpp"

#include "core/process/model.hpp"
#include "core/process/random.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/json/characterise.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace driftlab {
namespace {

const ColumnRole kTurning{Quantity::AngularRate, "z", *parse_unit("deg/s")};

CharacterisedRecording recording_of(const std::string& id, std::uint64_t seed, const FurtherRequest& also) {
  Random random(seed);
  const std::vector<double> x = simulate({*make_process("white_noise", {0.02})}, random, 0.01, 4096);
  CharacterisedRecording recording;
  recording.spec.id = id;
  recording.window.time.dt_s = 0.01;
  recording.channels.push_back(
      {"gz", kTurning,
       *characterise_channel({x, 0.01, kTurning.unit->factor}, {.models = {"WN", "WN+RW"}, .also = also}),
       std::nullopt});
  return recording;
}

Result<std::vector<ToldRecording>> stored(const std::vector<CharacterisedRecording>& recordings) {
  std::vector<Json> documents;
  for (const CharacterisedRecording& recording : recordings) {
    documents.push_back(to_json(recording));
  }
  return told_from_json(*parse_json(to_text(characterisation_document(std::move(documents)))));
}

void expect_same(const std::optional<ToldCurve>& here, const std::optional<ToldCurve>& there) {
  ASSERT_EQ(here.has_value(), there.has_value());
  if (here) {
    EXPECT_FALSE(here->at.empty());
    EXPECT_EQ(here->at, there->at);
    EXPECT_EQ(here->value, there->value);
    EXPECT_EQ(here->low, there->low);
    EXPECT_EQ(here->high, there->high);
  }
}

void expect_same(const ToldChannel& here, const ToldChannel& there) {
  EXPECT_EQ(here.channel, there.channel);
  EXPECT_EQ(here.unit, there.unit);
  ASSERT_TRUE(here.verdict && there.verdict);
  EXPECT_EQ(here.verdict->sentence, there.verdict->sentence);
  EXPECT_EQ(here.verdict->details, there.verdict->details);
  EXPECT_EQ(here.verdict->level, there.verdict->level);
  EXPECT_EQ(here.verdict->facts, there.verdict->facts);
  expect_same(here.allan, there.allan);
  expect_same(here.total, there.total);
  expect_same(here.theo1, there.theo1);
  ASSERT_EQ(here.psd.has_value(), there.psd.has_value());
  if (here.psd) {
    expect_same(here.psd->density, there.psd->density);
    ASSERT_EQ(here.psd->lines.size(), there.psd->lines.size());
    for (std::size_t i = 0; i < here.psd->lines.size(); ++i) {
      EXPECT_EQ(here.psd->lines[i].frequency_hz, there.psd->lines[i].frequency_hz);
      EXPECT_EQ(here.psd->lines[i].amplitude, there.psd->lines[i].amplitude);
      EXPECT_EQ(here.psd->lines[i].excess, there.psd->lines[i].excess);
    }
  }
}

TEST(ToldCharacterisation, IsTheSameFromWhatWasCharacterisedAndFromItsDocument) {
  std::vector<CharacterisedRecording> recordings{
      recording_of("a", 1, {.total = true, .theo1 = true, .psd = true, .taus = 40}), recording_of("b", 2, {})};
  ASSERT_TRUE(recordings[0].channels[0].result.further.psd);
  recordings[0].channels[0].result.further.psd->lines.push_back({12.5, 0.001, 40.0});
  const std::vector<ToldRecording> here = told_of(recordings);
  const auto there = stored(recordings);
  ASSERT_TRUE(there) << there.error().message;
  ASSERT_EQ(here.size(), 2U);
  ASSERT_EQ(there->size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(here[i].id, (*there)[i].id);
    ASSERT_EQ(here[i].channels.size(), 1U);
    ASSERT_EQ((*there)[i].channels.size(), 1U);
    expect_same(here[i].channels[0], (*there)[i].channels[0]);
  }
  EXPECT_TRUE(here[0].channels[0].allan && here[0].channels[0].total && here[0].channels[0].theo1);
  EXPECT_FALSE(here[1].channels[0].allan || here[1].channels[0].total || here[1].channels[0].psd);
}

TEST(ToldCharacterisation, RefusesWhatDriftlabHasNotWritten) {
  for (const char* const text : {"null", "{}", R"({"recordings": [{"id": "a"}]})",
                                 R"({"recordings": [{"id": "a", "channels": [{"channel": 1}]}]})"}) {
    const auto told = told_from_json(*parse_json(text));
    ASSERT_FALSE(told) << text;
    EXPECT_EQ(told.error().code, ErrorCode::Internal);
  }
}

}  // namespace
}  // namespace driftlab
