/// One suite of damaged input over every registered format and compression: whatever the bytes, the answer is an error
/// or a decoded table, never a crash, and the same however the bytes arrive.
#include "core/read/column_file.hpp"
#include "core/read/text_shape.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <random>

namespace driftlab {
namespace {

using testing::decode_bytes;
using testing::kCompressions;
using testing::Outcome;

/// Every valid sample of every registered format, plain and compressed.
std::vector<std::pair<std::string, std::string>> all_samples() {
  std::vector<std::pair<std::string, std::string>> all;
  auto samples = testing::valid_samples();
  for (const Format* const format : all_formats()) {
    const auto& files = samples[std::string(format->name)];
    EXPECT_FALSE(files.empty()) << "format " << format->name << " has no sample in samples.hpp";
    for (std::size_t i = 0; i < files.size(); ++i) {
      for (const Compression kind : kCompressions) {
        all.emplace_back(std::string(format->name) + " " + std::to_string(i) + " " + std::string(name_of(kind)),
                         testing::compress(kind, files[i]));
      }
    }
  }
  return all;
}

/// Steps between the places at which a sample is damaged: HDF5 is read by a process for each.
std::size_t stride_of(const std::string& name) { return name.starts_with("hdf5") ? 41 : 1; }

bool is_utf8(const std::string& said) { return text::to_utf8(said) == said; }

/// An error says something and has a known code; a table is rectangular. Whatever is said is UTF-8, as documents are.
void expect_sound(const Outcome& outcome, const std::string& what) {
  if (outcome.error) {
    EXPECT_FALSE(outcome.message.empty()) << what;
    EXPECT_TRUE(is_utf8(outcome.message)) << what << ": " << outcome.message;
    EXPECT_NE(*outcome.error, ErrorCode::Internal) << what << ": " << outcome.message;
    return;
  }
  EXPECT_GT(outcome.decoded.rows, 0U) << what;
  EXPECT_EQ(outcome.decoded.names.size(), outcome.bits.size()) << what;
  for (const auto& column : outcome.bits) {
    EXPECT_EQ(column.size(), outcome.decoded.rows) << what;
  }
  for (const auto* const said : {&outcome.decoded.names, &outcome.decoded.notes}) {
    EXPECT_TRUE(std::all_of(said->begin(), said->end(), is_utf8)) << what;
  }
}

TEST(EveryFormat, ReadsItsSamplesUnderEveryCompression) {
  auto samples = testing::valid_samples();
  for (const Format* const format : all_formats()) {
    for (const std::string& file : samples[std::string(format->name)]) {
      const Outcome plain = decode_bytes(file);
      ASSERT_FALSE(plain.error) << plain.message;
      EXPECT_EQ(plain.decoded.format, format->name);
      for (const Compression kind : kCompressions) {
        const Outcome unpacked = decode_bytes(testing::compress(kind, file));
        EXPECT_EQ(unpacked.decoded.compression, kind);
        EXPECT_EQ(unpacked.decoded.format, format->name);
        EXPECT_EQ(unpacked.bits, plain.bits);
      }
    }
  }
}

TEST(EveryFormat, IsRecognisedByItselfAlone) {
  auto samples = testing::valid_samples();
  for (const Format* const format : all_formats()) {
    for (const std::string& file : samples[std::string(format->name)]) {
      for (const Format* const other : all_formats()) {
        EXPECT_EQ(other->sniff(file) > 0, other == format) << format->name << " sniffed by " << other->name;
      }
    }
  }
}

TEST(EveryFormat, SurvivesTruncationAtEveryByte) {
  for (const auto& [name, bytes] : all_samples()) {
    for (std::size_t length = 0; length < bytes.size(); length += stride_of(name)) {
      expect_sound(decode_bytes(std::string_view(bytes).substr(0, length)), name + " cut to " + std::to_string(length));
    }
  }
}

TEST(EveryFormat, RefusesEveryTruncationOfACompressedFile) {
  for (const auto& [name, bytes] : all_samples()) {
    if (sniff_compression(bytes) == Compression::None) {
      continue;
    }
    for (std::size_t length = 6; length < bytes.size(); ++length) {
      EXPECT_EQ(decode_bytes(std::string_view(bytes).substr(0, length)).error, ErrorCode::Truncated)
          << name << " cut to " << length;
    }
  }
}

TEST(EveryFormat, SurvivesEveryFlippedByte) {
  std::mt19937_64 random(3);
  for (const auto& [name, bytes] : all_samples()) {
    for (std::size_t i = 0; i < bytes.size(); i += stride_of(name)) {
      for (const unsigned mask : {0x01U, 0x80U, 0xFFU, static_cast<unsigned>(1 + random() % 255)}) {
        std::string damaged = bytes;
        damaged[i] = static_cast<char>(static_cast<unsigned char>(damaged[i]) ^ mask);
        expect_sound(decode_bytes(damaged), name + " byte " + std::to_string(i));
      }
    }
  }
}

TEST(EveryFormat, SurvivesInsertedDeletedAndRepeatedPieces) {
  std::mt19937_64 random(4);
  for (const auto& [name, bytes] : all_samples()) {
    for (std::size_t i = 0; i < 200; i += stride_of(name)) {
      std::string damaged = bytes;
      const std::size_t at = random() % damaged.size();
      const std::size_t length = 1 + random() % (damaged.size() - at);
      switch (random() % 3) {
        case 0:
          damaged.erase(at, length);
          break;
        case 1:
          damaged.insert(random() % damaged.size(), bytes.substr(at, length));
          break;
        default:
          damaged.insert(at, std::string(1 + random() % 40, static_cast<char>(random() % 256)));
          break;
      }
      expect_sound(decode_bytes(damaged), name + " edit " + std::to_string(i));
    }
  }
}

TEST(EveryFormat, AnswersTheSameHoweverTheBytesArrive) {
  std::mt19937_64 random(5);
  for (const auto& [name, bytes] : all_samples()) {
    std::vector<std::string> variants{bytes, bytes.substr(0, bytes.size() / 2), bytes + "x"};
    for (int i = 0; i < 20; ++i) {
      variants.push_back(bytes);
      variants.back()[random() % bytes.size()] = static_cast<char>(random() % 256);
    }
    for (const std::string& variant : variants) {
      const Outcome whole = decode_bytes(variant);
      EXPECT_EQ(decode_bytes(variant, 1), whole) << name;
      EXPECT_EQ(decode_bytes(variant, 7), whole) << name;
    }
  }
}

TEST(EveryFormat, AnswersTheSameAcrossBufferBorders) {
  // Longer than every buffer in the reader (256 KiB), so that lines and numbers straddle their ends.
  std::string csv = "t,gx,gy\n";
  for (int i = 0; i < 40000; ++i) {
    csv += std::to_string(i) + "," + std::to_string(i * 31 % 977) + ".25,-1e-" + std::to_string(i % 9) + "\n";
  }
  const std::string npy = testing::npy(testing::npy_dictionary("<f4", false, "(60000, 3)"),
                                       testing::number_bytes<float>(testing::ramp(180000)));
  for (const std::string& file : {csv, npy}) {
    for (const Compression kind : kCompressions) {
      const std::string packed = testing::compress(kind, file);
      const Outcome whole = decode_bytes(packed);
      ASSERT_FALSE(whole.error) << whole.message;
      EXPECT_EQ(decode_bytes(packed, 1), whole);
      EXPECT_EQ(decode_bytes(packed, 4093), whole);
    }
  }
}

TEST(EveryFormat, LeavesNoFileBehindWhenItFails) {
  const testing::TemporaryDirectory directory;
  std::mt19937_64 random(6);
  for (const auto& [name, bytes] : all_samples()) {
    for (int i = 0; i < 10; ++i) {
      std::string damaged = bytes.substr(0, 1 + random() % bytes.size());
      char& hit = damaged[random() % damaged.size()];
      hit = static_cast<char>(static_cast<unsigned char>(hit) ^ 0x55U);
      testing::write_file(directory / "in", damaged);
      const auto decoded = decode_file(directory / "in", directory / "out");
      if (decoded) {
        EXPECT_THAT(directory.entries(), ::testing::UnorderedElementsAre("in", "out")) << name;
        std::filesystem::remove(directory / "out");
      } else {
        EXPECT_THAT(directory.entries(), ::testing::ElementsAre("in")) << name;
      }
    }
  }
}

}  // namespace
}  // namespace driftlab
