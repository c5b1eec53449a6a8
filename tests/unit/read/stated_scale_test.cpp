#include "core/read/stated_scale.hpp"

#include "core/signal/missing.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <bit>

namespace driftlab {
namespace {

using ::testing::Contains;
using testing::decode_bytes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(StatedScale, IsReadAsDataSheetsAndLoggersWriteIt) {
  const std::vector<std::tuple<std::string, std::string, double, double>> cases{
      {"gx [131 LSB/(deg/s)]", "gx [deg/s]", 131, 1},     {"gx (16.4 LSB/dps)", "gx [deg/s]", 16.4, 1},
      {"ax [16384 counts/g]", "ax [g]", 16384, 1},        {"ax [0.061 mg/LSB]", "ax [mg]", 1, 0.061},
      {"gz (8.75 mdps/digit)", "gz [deg/s]", 1, 8.75e-3}, {"g z [0.001 (rad/s)/LSB]", "g z [rad/s]", 1, 0.001},
  };
  for (const auto& [name, renamed, per_unit, per_count] : cases) {
    const auto scale = stated_scale(name);
    ASSERT_TRUE(scale) << name;
    EXPECT_EQ(scale->name, renamed);
    EXPECT_DOUBLE_EQ(scale->counts_per_unit, per_unit);
    EXPECT_DOUBLE_EQ(scale->units_per_count, per_count);
  }
  for (const std::string name : {"", "gx", "gx [LSB]", "gx [deg/s]", "gx (131)", "gx [131 LSB]", "gx [131 LSB/furlong]",
                                 "gx [0 LSB/g]", "gx [g/LSB]", "gx 131 LSB/g]", "]", "()", "gx [1e999 LSB/g]"}) {
    EXPECT_FALSE(stated_scale(name)) << name;
  }
}

TEST(StatedScale, TurnsCountsOfATableIntoItsUnits) {
  const auto counts = decode_bytes("t [s],gx [131 LSB/(deg/s)],ax [0.5 mg/LSB]\n0,262,-4\n0.01,,8\n");
  ASSERT_FALSE(counts.error) << counts.message;
  EXPECT_THAT(counts.decoded.names, ElementsAre("t [s]", "gx [deg/s]", "ax [mg]"));
  EXPECT_EQ(counts.bits[1][0], std::bit_cast<std::uint64_t>(2.0));
  EXPECT_EQ(counts.bits[2][1], std::bit_cast<std::uint64_t>(4.0));
  const MissingSample hole = why_missing(std::bit_cast<double>(counts.bits[1][1]));
  EXPECT_EQ(hole.why, Missing::Empty) << "a hole still says what it was";
  EXPECT_EQ(hole.row, 3U);
  EXPECT_THAT(counts.decoded.notes, Contains(HasSubstr("'gx [131 LSB/(deg/s)]' holds counts")));
}

TEST(StatedScale, LeavesATableWithoutOneToTheBit) {
  const auto plain = decode_bytes("gx [LSB],gy [deg/s]\n262,0.1\n-1,0.3\n");
  ASSERT_FALSE(plain.error) << plain.message;
  EXPECT_EQ(plain.bits[0][0], std::bit_cast<std::uint64_t>(262.0));
  EXPECT_EQ(plain.bits[1][1], std::bit_cast<std::uint64_t>(0.3));
  EXPECT_THAT(plain.decoded.notes, IsEmpty());
}

}  // namespace
}  // namespace driftlab
