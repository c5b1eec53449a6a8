// Tables on paper: a line that is aligned by blanks must not wrap.
#include "schema/figure/paper.hpp"

#include <gtest/gtest.h>

#include <string>

namespace driftlab::figure {
namespace {

/// A row of `characters` that is aligned by blanks.
std::string row(std::size_t characters) { return "N  " + std::string(characters - 3, '1'); }

TEST(AlignedType, ShrinksUntilTheLongestRowFitsBetweenTheMargins) {
  EXPECT_EQ(aligned_type_tenths(""), 110U);
  EXPECT_EQ(aligned_type_tenths(row(60)), 110U);
  for (const std::size_t characters : {101U, 120U, 150U, 183U}) {
    const std::size_t tenths = aligned_type_tenths("a sentence\n" + row(characters) + "\n");
    // 672 px between the margins, a character 0.61 of the size wide; a tenth larger would not fit.
    const auto width_px = [&](std::size_t size) { return 0.61 * static_cast<double>(size * characters) / 10.0; };
    EXPECT_LE(width_px(tenths), 672.0) << characters;
    EXPECT_GT(width_px(tenths + 1), 671.9) << characters;
  }
  EXPECT_EQ(aligned_type_tenths(row(400)), 60U) << "no smaller: it wraps";
  EXPECT_EQ(aligned_type_size(row(400)), "6.0px");
}

TEST(AlignedType, CountsCharactersAndLetsSentencesWrap) {
  EXPECT_EQ(aligned_type_tenths(std::string(400, 'a')), 110U);
  std::string greek = "N  ";
  for (int i = 0; i < 90; ++i) {
    greek += "τ";  // two bytes each
  }
  EXPECT_EQ(aligned_type_tenths(greek), 110U);
}

}  // namespace
}  // namespace driftlab::figure
