#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

namespace driftlab {
namespace {

using testing::compress;
using testing::decode_bytes;
using ::testing::HasSubstr;
using testing::kCompressions;
using testing::Outcome;

constexpr std::string_view kTable = "gx,gy\n1,2\n3,4\n";

std::vector<Compression> packed_kinds() { return {Compression::Gzip, Compression::Xz, Compression::Zstd}; }

/// Everything a compressed stream holds, or its error.
Result<std::string> unpack(Compression kind, std::string_view bytes, const DecodeLimits& limits = {},
                           std::size_t piece_bytes = std::size_t{1} << 16) {
  auto reader = make_decompressor(kind, ByteSource(make_memory_reader(bytes, piece_bytes)), limits);
  if (!reader) {
    return fail(reader.error());
  }
  std::string plain;
  std::vector<char> piece(10007);
  while (true) {
    auto got = (*reader)->read(piece);
    if (!got) {
      return fail(got.error());
    }
    if (*got == 0) {
      return plain;
    }
    plain.append(piece.data(), *got);
  }
}

TEST(Decompress, ReadsConcatenatedMembersAsOne) {
  for (const Compression kind : packed_kinds()) {
    const std::string members = compress(kind, "gx,gy\n1,") + compress(kind, "") + compress(kind, "2\n3,4\n");
    EXPECT_EQ(decode_bytes(members).bits, decode_bytes(kTable).bits) << name_of(kind);
    EXPECT_EQ(decode_bytes(members, 1).bits, decode_bytes(kTable).bits) << name_of(kind);
  }
}

TEST(Decompress, IgnoresZeroPaddingAndRefusesOtherTails) {
  for (const Compression kind : packed_kinds()) {
    const std::string packed = compress(kind, kTable);
    EXPECT_EQ(decode_bytes(packed + std::string(512, '\0')).bits, decode_bytes(kTable).bits) << name_of(kind);
    EXPECT_EQ(decode_bytes(packed + "tail").error, ErrorCode::CorruptCompression) << name_of(kind);
    EXPECT_EQ(decode_bytes(packed + packed.substr(0, 1)).error, ErrorCode::Truncated) << name_of(kind);
    EXPECT_EQ(decode_bytes(packed + packed.substr(0, packed.size() - 1)).error, ErrorCode::Truncated) << name_of(kind);
  }
}

TEST(Decompress, ChecksTheChecksum) {
  for (const Compression kind : packed_kinds()) {
    std::string packed = compress(kind, kTable);
    // gzip: CRC-32 eight bytes from the end; zstd: last four; xz: inside the block, before index and footer.
    const std::size_t at =
        kind == Compression::Xz ? packed.size() - 12 - 8 - 4 : packed.size() - (kind == Compression::Gzip ? 8 : 4);
    packed[at] = static_cast<char>(packed[at] + 1);
    EXPECT_EQ(decode_bytes(packed).error, ErrorCode::CorruptCompression) << name_of(kind);
  }
}

TEST(Decompress, SaysTheSameOfADamagedStreamHoweverItArrives) {
  const auto told = [](const Result<std::string>& outcome) { return outcome ? *outcome : outcome.error().message; };
  const auto same = [&](Compression kind, const std::string& bytes) {
    const std::string at_once = told(unpack(kind, bytes));
    for (const std::size_t piece : {1, 13}) {
      EXPECT_EQ(told(unpack(kind, bytes, {}, piece)), at_once) << name_of(kind) << " in pieces of " << piece;
    }
  };
  for (const Compression kind : packed_kinds()) {
    const std::string packed = compress(kind, kTable);
    for (std::size_t at = 0; at < packed.size(); ++at) {
      for (const int change : {1, 8, 64, 255}) {
        std::string damaged = packed;
        damaged[at] = static_cast<char>(static_cast<unsigned char>(damaged[at]) ^ change);
        same(kind, damaged);
      }
    }
  }
  // A frame that says it holds 256 bytes, and holds none; behind it lies something else.
  using namespace std::string_literals;
  same(Compression::Zstd, "\x28\xB5\x2F\xFD\x40\0\0\0\1\0\0tail"s);
}

TEST(Decompress, StopsABombAtItsBudget) {
  // 600 MiB of zeros in about 600 kB: over 256 MiB + 200 times its size, so it must stop, and early.
  const std::string piece = testing::gzip(std::string(std::size_t{20} << 20, '0'));
  std::string bomb;
  for (int i = 0; i < 30; ++i) {
    bomb += piece;
  }
  const std::uint64_t budget = DecodeLimits{}.expanded_budget(bomb.size());
  ASSERT_LT(budget, std::uint64_t{600} << 20);
  const auto plain = unpack(Compression::Gzip, bomb);
  ASSERT_FALSE(plain);
  EXPECT_EQ(plain.error().code, ErrorCode::DecompressionLimit);
  EXPECT_EQ(plain.error().fields.front().value, std::to_string(budget));
}

TEST(Decompress, SpendsExactlyItsBudget) {
  DecodeLimits limits;
  limits.expansion_ratio = 0;
  for (const Compression kind : packed_kinds()) {
    const std::string packed = compress(kind, std::string(100000, 'x'));
    limits.expansion_allowance = 100000;
    EXPECT_TRUE(unpack(kind, packed, limits));
    limits.expansion_allowance = 99999;
    EXPECT_EQ(unpack(kind, packed, limits).error().code, ErrorCode::DecompressionLimit);
    limits.expansion_allowance = 200000;
    limits.max_expanded_bytes = 99999;
    EXPECT_EQ(unpack(kind, packed, limits).error().code, ErrorCode::DecompressionLimit);
    limits.max_expanded_bytes = 100000;
    EXPECT_TRUE(unpack(kind, packed, limits));
  }
}

TEST(Decompress, GivesNoStreamMoreMemoryThanAllowed) {
  DecodeLimits limits;
  limits.max_decoder_memory = std::uint64_t{1} << 20;
  // xz -6 declares an 8 MiB dictionary whatever the size of its input; zstd's window is as large as its frame.
  EXPECT_EQ(unpack(Compression::Xz, testing::xz(kTable), limits).error().code, ErrorCode::DecompressionLimit);
  std::string frame = "\x28\xb5\x2f\xfd";
  frame += '\x00';                             // no content size, no checksum, window descriptor follows
  frame += static_cast<char>((31 - 10) << 3);  // window of 2^31 bytes (RFC 8878, 3.1.1.1.2)
  frame += std::string("\x01\x00\x00", 3);     // an empty last block
  EXPECT_EQ(unpack(Compression::Zstd, frame, limits).error().code, ErrorCode::DecompressionLimit);
}

TEST(Decompress, BudgetDoesNotOverflow) {
  const DecodeLimits limits;
  EXPECT_EQ(limits.expanded_budget(0), std::uint64_t{256} << 20);
  EXPECT_EQ(limits.expanded_budget(1'000'000), (std::uint64_t{256} << 20) + 200'000'000);
  EXPECT_EQ(limits.expanded_budget(~std::uint64_t{0}), std::uint64_t{32} << 30);
}

TEST(Decompress, UnwrapsOnce) {
  for (const Compression outer : packed_kinds()) {
    for (const Compression inner : packed_kinds()) {
      const Outcome outcome = decode_bytes(compress(outer, compress(inner, kTable)));
      EXPECT_EQ(outcome.error, ErrorCode::UnsupportedFormat);
      EXPECT_THAT(outcome.message, HasSubstr(std::string(name_of(inner)) + " file inside a compressed file"));
    }
  }
}

TEST(Decompress, TellsAnEmptyContentFromAnEmptyFile) {
  for (const Compression kind : kCompressions) {
    EXPECT_EQ(decode_bytes(compress(kind, "")).error, ErrorCode::EmptyInput) << name_of(kind);
  }
}

}  // namespace
}  // namespace driftlab
