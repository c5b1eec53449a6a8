// What a decoding process says, which a file may have taken over: read whole, or refused within the limits.
#include "core/read/variable_stream.hpp"

#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::size_t kBudget = std::size_t{1} << 20;
constexpr std::size_t kMostText = 256;

/// What a process wrote with `write`.
std::string written(const std::function<void(VariableWriter&)>& write) {
  const int fd = ::memfd_create("stream", MFD_CLOEXEC);
  VariableWriter writer(fd);
  write(writer);
  std::string bytes(static_cast<std::size_t>(::lseek(fd, 0, SEEK_CUR)), '\0');
  EXPECT_EQ(::pread(fd, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  ::close(fd);
  return bytes;
}

Result<VariableStream> read_back(std::string_view bytes, std::size_t budget = kBudget, std::size_t piece = 5) {
  return read_variables(
      [&](std::span<char> into) -> Result<std::size_t> {
        const std::size_t size = std::min({into.size(), bytes.size(), piece});
        std::memcpy(into.data(), bytes.data(), size);
        bytes.remove_prefix(size);
        return size;
      },
      budget, kMostText);
}

std::string array_of(const std::string& name, std::uint64_t rows, std::uint64_t columns) {
  return "V" + word(name.size(), 4) + name + word(rows, 8) + word(columns, 8);
}

const std::vector<std::vector<double>> kGyro{{1.0, -2.5, 3.0}, {0.125, 0.0, 1e300}};

std::string sound() {
  return written([](VariableWriter& writer) {
    EXPECT_TRUE(writer.variable("gyro", kGyro));
    EXPECT_TRUE(writer.note("'text' is left out: it holds no real numbers."));
    EXPECT_TRUE(writer.end());
  });
}

TEST(VariableStream, GivesBackWhatWasWrittenToTheBit) {
  const auto stream = read_back(sound());
  ASSERT_TRUE(stream) << stream.error().message;
  EXPECT_TRUE(stream->whole);
  ASSERT_EQ(stream->variables.size(), 1U);
  EXPECT_EQ(stream->variables[0].name, "gyro");
  EXPECT_EQ(stream->variables[0].columns, kGyro);
  EXPECT_THAT(stream->notes, ElementsAre("'text' is left out: it holds no real numbers."));
}

TEST(VariableStream, IsNotWholeWhereItBreaksOffAtAnyByte) {
  const std::string bytes = sound();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const auto stream = read_back(std::string_view(bytes).substr(0, length));
    ASSERT_TRUE(stream) << length;
    EXPECT_FALSE(stream->whole) << length;
  }
  const auto other = read_back("?" + bytes);
  ASSERT_TRUE(other);
  EXPECT_FALSE(other->whole) << "no letter of a record";
}

TEST(VariableStream, HandsOnAnErrorOfTheFileAndTakesAnyOtherForDamage) {
  const std::string said = written(
      [](VariableWriter& writer) { EXPECT_TRUE(writer.error({ErrorCode::LimitExceeded, "It takes too much.", {}})); });
  const auto refused = read_back(said);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::LimitExceeded);
  EXPECT_EQ(refused.error().message, "It takes too much.");
  // It knows of the file alone: an internal error, a full disk or a request to stop are not its to state.
  for (const std::uint64_t code : {std::uint64_t{4'000'000'000U}, static_cast<std::uint64_t>(ErrorCode::Internal),
                                   static_cast<std::uint64_t>(ErrorCode::DiskFull)}) {
    const auto other = read_back("E" + word(code, 4) + word(2, 4) + "x.");
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().code, ErrorCode::ShapeMismatch);
  }
}

TEST(VariableStream, AllocatesNothingThatItsCountsMerelyClaim) {
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  for (const std::string& claim :
       {array_of("a", most, 1), array_of("a", 1, most), array_of("a", most, most), array_of("a", most / 8, 8),
        array_of("a", (std::uint64_t{1} << 61U) + 1, 8), array_of("a", kBudget / 8 + 1, 1), array_of("a", 0, 4097),
        array_of("a", kBudget / 8, 2), "V" + word(kMostText + 1, 4), "N" + word(0xFFFFFFFFU, 4),
        "E" + word(0, 4) + word(0xFFFFFFFFU, 4)}) {
    const auto stream = read_back(claim);
    ASSERT_FALSE(stream);
    EXPECT_EQ(stream.error().code, ErrorCode::LimitExceeded) << stream.error().message;
    EXPECT_THAT(stream.error().message, ::testing::EndsWith("."));
  }
}

TEST(VariableStream, EndsAtItsLimitWhereItIsMadeOfArraysWithoutSamples) {
  // They cost no budget: a process that a file had taken over could have filled the memory of the daemon with them.
  for (const std::string& empty : {array_of("", 0, 0), array_of("", 1'000'000'000, 0), array_of("", 0, 4096)}) {
    std::string endless;
    for (int i = 0; i < 30'000; ++i) {
      endless += empty;
    }
    const auto stream = read_back(endless, kBudget, 4096);
    ASSERT_FALSE(stream);
    EXPECT_EQ(stream.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(stream.error().message, HasSubstr("more memory"));
  }
}

TEST(VariableStream, KeepsSixtyFourNotesOfAsManyAsCome) {
  const std::string bytes = written([](VariableWriter& writer) {
    for (int i = 0; i < 1000; ++i) {
      EXPECT_TRUE(writer.note("Again."));
    }
    EXPECT_TRUE(writer.end());
  });
  const auto stream = read_back(bytes);
  ASSERT_TRUE(stream) << stream.error().message;
  EXPECT_TRUE(stream->whole);
  EXPECT_EQ(stream->notes.size(), 64U);
}

}  // namespace
}  // namespace driftlab
