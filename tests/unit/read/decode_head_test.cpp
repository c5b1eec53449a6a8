// The beginning of a file tells what the whole would.
#include "core/read/decode_head.hpp"

#include <gtest/gtest.h>

#include <string>

namespace driftlab {
namespace {

std::string csv(std::size_t rows) {
  std::string text = "t,gz\n";
  for (std::size_t i = 0; i < rows; ++i) {
    text += std::to_string(i) + "," + std::to_string(i % 7) + "\n";
  }
  return text;
}

TEST(DecodeHead, OfTextEndsWithTheLastWholeLine) {
  const std::string text = csv(100) + "100,";
  const auto head = decode_head(text, HeadExtent::Beginning);
  ASSERT_TRUE(head) << head.error().message;
  EXPECT_EQ(head->rows(), 100U);
  EXPECT_TRUE(head->notes.empty()) << "that the end is torn is no fault of the file: " << head->notes.front();
  EXPECT_EQ(head->format, "csv");
  EXPECT_EQ(head->names, (ColumnNames{"t", "gz"}));
}

TEST(DecodeHead, StopsAtSoManyRows) {
  const std::string text = csv(30000);
  const auto head = decode_head(text, HeadExtent::WholeFile);
  ASSERT_TRUE(head) << head.error().message;
  EXPECT_EQ(head->rows(), 20000U);
  EXPECT_EQ(head->columns[0].back(), 19999.0);
}

TEST(DecodeHead, OfAFileThatEndsEarlyIsAnErrorOnlyWhereItIsAllOfIt) {
  std::string npy = "\x93NUMPY";
  npy += std::string("\x01\x00\x76\x00", 4);
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1000, 2), }";
  header.resize(117, ' ');
  npy += header + "\n" + std::string(160, '\0');
  const auto beginning = decode_head(npy, HeadExtent::Beginning);
  ASSERT_TRUE(beginning) << beginning.error().message;
  EXPECT_EQ(beginning->rows(), 10U);
  EXPECT_FALSE(beginning->has_header);
  const auto whole = decode_head(npy, HeadExtent::WholeFile);
  ASSERT_FALSE(whole);
  EXPECT_EQ(whole.error().code, ErrorCode::Truncated);
}

TEST(DecodeHead, RefusesWhatNoLaterByteMends) {
  const auto twice = decode_head("gz,gz\n1,2\n3,4\n", HeadExtent::Beginning);
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().code, ErrorCode::DuplicateColumn);
  const auto foreign = decode_head("%PDF-1.7\n0123456789", HeadExtent::Beginning);
  ASSERT_FALSE(foreign);
  EXPECT_EQ(foreign.error().code, ErrorCode::UnsupportedFormat);
}

}  // namespace
}  // namespace driftlab
