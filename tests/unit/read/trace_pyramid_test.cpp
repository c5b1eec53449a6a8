// What is shown of a long recording from the nodes is what its samples say.
#include "core/read/trace_pyramid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

namespace driftlab {
namespace {

namespace fs = std::filesystem;

/// Two columns of noise with a spike and holes. Every test has a folder of its own: tests of a suite run side by side.
class Pyramid : public testing::Test {
 protected:
  static constexpr std::size_t kRows = kPyramidRows + 12345;

  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "driftlab-pyramid-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    auto writer = ColumnFileWriter::create(folder_ / "columns", {"a", "b"});
    ASSERT_TRUE(writer);
    std::vector<double> rows;
    for (std::size_t i = 0; i < kRows; ++i) {
      const bool hole = i >= 300000 && i < 420000;
      rows.push_back(i == 777777 ? 1e6 : hole ? std::numeric_limits<double>::quiet_NaN() : normal(random));
      rows.push_back(static_cast<double>(i));
    }
    ASSERT_TRUE(writer->append_rows(rows));
    ASSERT_TRUE(writer->finish());
    columns_.emplace(*ColumnFile::open(folder_ / "columns"));
    ASSERT_TRUE(write_trace_pyramid(*columns_, folder_ / "pyramid"));
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
  std::optional<ColumnFile> columns_;
};

TEST_F(Pyramid, ShowsWhatEveryStretchHolds) {
  const auto pyramid = TracePyramid::open(folder_ / "pyramid", *columns_);
  ASSERT_TRUE(pyramid) << pyramid.error().message;
  for (const std::size_t first : {std::size_t{0}, std::size_t{1}, std::size_t{255}, std::size_t{4097}}) {
    for (const std::size_t most : {std::size_t{2}, std::size_t{100}, std::size_t{1200}}) {
      const std::size_t count = kRows - first - 3;
      for (const std::size_t column : {std::size_t{0}, std::size_t{1}}) {
        const auto samples = columns_->column(column);
        const auto buckets = pyramid->trace(*columns_, column, first, count, most);
        ASSERT_LE(buckets.size(), most);
        EXPECT_GE(2 * buckets.size(), most) << "half of the points asked for are not used";
        std::size_t next = first;
        for (std::size_t i = 0; i < buckets.size(); ++i) {
          const std::size_t end = i + 1 < buckets.size() ? buckets[i + 1].first : first + count;
          ASSERT_EQ(buckets[i].first, next);
          const auto direct = decimated_trace(samples.subspan(next, end - next), 1);
          EXPECT_EQ(buckets[i].present, direct.front().present);
          EXPECT_EQ(buckets[i].low, direct.front().low);
          EXPECT_EQ(buckets[i].high, direct.front().high);
          // Sums of the same numbers in another order: each of some 10^6 roundings is below 2^-53 of a sum of squares.
          EXPECT_NEAR(buckets[i].mean, direct.front().mean, 1e-9 * (1.0 + std::abs(direct.front().mean)));
          next = end;
        }
        EXPECT_EQ(next, first + count);
      }
    }
  }
}

TEST_F(Pyramid, OfOtherColumnsIsRefused) {
  auto writer = ColumnFileWriter::create(folder_ / "other", {"a"});
  ASSERT_TRUE(writer->append_column(0, std::vector<double>(kRows, 1.0)));
  ASSERT_TRUE(writer->finish());
  const auto other = ColumnFile::open(folder_ / "other");
  const auto pyramid = TracePyramid::open(folder_ / "pyramid", *other);
  ASSERT_FALSE(pyramid);
  EXPECT_EQ(pyramid.error().code, ErrorCode::ShapeMismatch);
}

TEST_F(Pyramid, TakesLittleSpace) {
  const auto nodes = static_cast<double>(fs::file_size(folder_ / "pyramid"));
  EXPECT_LT(nodes, 0.018 * static_cast<double>(fs::file_size(folder_ / "columns")));
}

TEST(PyramidStretch, IsNothingWhereTheSamplesThemselvesAreQuick) {
  EXPECT_EQ(pyramid_stretch(kPyramidRows - 1, 10), 0U);
  EXPECT_EQ(pyramid_stretch(kPyramidRows, 20000), 0U) << "53 samples each: shorter than a node";
  EXPECT_EQ(pyramid_stretch(kPyramidRows, 1), 0U);
  EXPECT_EQ(pyramid_stretch(100'000'000, 1200), 83456U) << "100e6 / 1199 in whole nodes of 256";
}

}  // namespace
}  // namespace driftlab
