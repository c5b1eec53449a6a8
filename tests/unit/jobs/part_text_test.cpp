#include "server/jobs/part_text.hpp"

#include "core/analysis/characterise.hpp"
#include "core/navigate/outage_evaluation.hpp"
#include "core/process/model.hpp"
#include "core/process/random.hpp"
#include "schema/json/characterise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace driftlab::server {
namespace {

enum class Colour { Red, Green };

struct Leaf {
  double value = 0.0;
  Colour colour = Colour::Red;
  friend bool operator==(const Leaf&, const Leaf&) = default;
};

struct Tree {
  std::string name;
  std::vector<Leaf> leaves;
  std::optional<Leaf> top;
  std::map<std::string, std::vector<std::size_t>> rings;
  bool dead = false;
  friend bool operator==(const Tree&, const Tree&) = default;
};

Tree tree() {
  return {
      std::string("oak\0\n", 5), {{1.0 / 3.0, Colour::Green}, {-0.0}}, Leaf{1e-310}, {{"a", {1, 2}}, {"", {}}}, true};
}

TEST(PartText, AValueComesBackToTheLastBit) {
  EXPECT_EQ(*from_part_text<Tree>(part_text(tree())), tree());
  EXPECT_EQ(*from_part_text<Tree>(part_text(Tree{})), Tree{});
  const Leaf none{std::numeric_limits<double>::quiet_NaN()};
  EXPECT_TRUE(std::isnan(from_part_text<Leaf>(part_text(none))->value));
  EXPECT_TRUE(std::signbit(from_part_text<Leaf>(part_text(Leaf{-0.0}))->value));
}

TEST(PartText, ADamagedTextIsRefused) {
  const std::string text = part_text(tree());
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string damaged = text;
    damaged[i] = damaged[i] == 'A' ? 'B' : 'A';
    EXPECT_FALSE(from_part_text<Tree>(damaged)) << i;
    EXPECT_FALSE(from_part_text<Tree>(text.substr(0, i))) << i;
  }
  EXPECT_FALSE(from_part_text<Tree>(""));
}

struct Shrub {  // the bytes of a Leaf
  double value = 0.0;
  int colour = 0;
};
struct Hedge {  // the members of a Leaf, the other way round
  Colour colour = Colour::Red;
  double value = 0.0;
};

TEST(PartText, ATextOfAnotherShapeIsRefused) {
  const std::string leaf = part_text(Leaf{1.0});
  EXPECT_FALSE(from_part_text<Hedge>(leaf));
  EXPECT_FALSE(from_part_text<Tree>(leaf));
  EXPECT_FALSE(from_part_text<std::optional<Leaf>>(leaf));
  EXPECT_FALSE(from_part_text<std::vector<Leaf>>(part_text(std::vector<Hedge>{})));
  EXPECT_TRUE(from_part_text<Shrub>(leaf)) << "an enumeration is a number";
}

/// What a reader makes of bytes that no writer wrote: nothing, and no more memory than they take.
TEST(PartText, BytesOfChanceAreNoValue) {
  std::mt19937_64 random(20261129);
  for (int round = 0; round < 20'000; ++round) {
    std::string bytes(random() % 64, '\0');
    for (char& byte : bytes) {
      byte = static_cast<char>(random() % (round % 2 == 0 ? 3 : 256));
    }
    SnapshotReader reader(bytes);
    Tree value;
    reader.get(value);
    std::vector<FittedProcess> processes;
    SnapshotReader(bytes).get(processes);
    EXPECT_LE(value.leaves.size(), bytes.size());
  }
}

TEST(PartText, ACharacterisedRecordingComesBackWhole) {
  Random random(1);
  std::vector<double> time, values;
  for (std::size_t i = 0; i < 20000; ++i) {
    if (i % 5000 != 4321) {  // gaps
      time.push_back(0.01 * static_cast<double>(i));
      values.push_back(0.02 * random.normal());
    }
  }
  values[777] += 3.0;
  const RecordingSpec spec;
  auto view = view_recording(spec, {"time (s)", "gz (deg/s)"}, time.size(),
                             [&](std::size_t i) { return std::span<const double>(i == 0 ? time : values); });
  ASSERT_TRUE(view) << view.error().message;
  const auto prepared = PreparedRecording::make(spec, std::move(*view), {});
  ASSERT_TRUE(prepared);
  CharacteriseOptions options;
  options.also = {true, true, true, 20};
  const auto found = characterise_recording(*prepared, options, {});
  ASSERT_TRUE(found) << found.error().message;
  const std::string text = part_text(*found);
  const auto back = from_part_text<CharacterisedRecording>(text);
  ASSERT_TRUE(back);
  EXPECT_EQ(part_text(*back), text);
  EXPECT_EQ(to_json(*back).dump(), to_json(*found).dump());
  EXPECT_GT(found->channels[0].result.fits.size(), 3U);
}

}  // namespace
}  // namespace driftlab::server
