// Names that are no UTF-8, and names that a limit cuts within a letter: `driftlab characterise --json` ended with an
// uncaught exception over a file that held one.
#include "core/read/decode_head.hpp"
#include "core/read/text_shape.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

bool is_utf8(const std::string& said) { return text::to_utf8(said) == said; }

TEST(MendedUtf8, KeepsCharactersAndReadsOtherBytesAsLatinOne) {
  EXPECT_EQ(text::mended_utf8("a\xC3\xA9\xE2\x82\xAC"), "a\xC3\xA9\xE2\x82\xAC");
  EXPECT_EQ(text::mended_utf8("\xC3\xA9 \xE9\xFF"), "\xC3\xA9 \xC3\xA9\xC3\xBF");
  EXPECT_EQ(text::mended_utf8("\xE2\x82"), "\xC3\xA2\xC2\x82") << "a torn character";
  EXPECT_EQ(text::mended_utf8(""), "");
}

TEST(FrontOf, CutsBetweenCharacters) {
  EXPECT_EQ(text::front_of("abc", 5), "abc");
  EXPECT_EQ(text::front_of("abc", 2), "ab");
  EXPECT_EQ(text::front_of("a\xC3\xA9", 2), "a");
  EXPECT_EQ(text::front_of("a\xC3\xA9", 3), "a\xC3\xA9");
  EXPECT_EQ(text::front_of("\xE2\x82\xAC", 2), "");
}

TEST(ForeignNames, OfColumnsAndNotesAreUtf8) {
  const std::string array = npy(npy_dictionary("<f8", false, "(4,)"), number_bytes<double>(ramp(4)));
  const std::string other = npy(npy_dictionary("<f8", false, "(7,)"), number_bytes<double>(ramp(7)));
  const std::string file = zip({{"gx\xE9.npy", array}, {"gy\xC3\xA9.npy", array}, {"im\xFF.npy", other}});
  const Outcome outcome = decode_bytes(file);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names, ElementsAre("gx\xC3\xA9", "gy\xC3\xA9"));
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("'im\xC3\xBF' (7 x 1)")));
  const auto head = decode_head(file, HeadExtent::WholeFile);
  ASSERT_TRUE(head) << head.error().message;
  EXPECT_EQ(head->names, outcome.decoded.names);
  EXPECT_EQ(head->notes, outcome.decoded.notes);
}

TEST(ForeignNames, ThatBecomeOneAreRefused) {
  const std::string array = npy(npy_dictionary("<f8", false, "(4,)"), number_bytes<double>(ramp(4)));
  const Outcome outcome = decode_bytes(zip({{"gx\xE9.npy", array}, {"gx\xC3\xA9.npy", array}}));
  EXPECT_EQ(outcome.error, ErrorCode::DuplicateColumn);
  EXPECT_TRUE(is_utf8(outcome.message));
  EXPECT_EQ(outcome.field("column"), "gx\xC3\xA9");
}

TEST(ForeignNames, OfManyArraysAreCutBetweenLetters) {
  for (const std::size_t shift : {0U, 1U}) {
    std::vector<std::string> arrays{mat_matrix("gx", 4, 1, ramp(4))};
    for (int i = 0; i < 60; ++i) {
      std::string name = std::string(shift, 'a') + "m" + std::to_string(100 + i);
      for (int letter = 0; letter < 10; ++letter) {
        name += "\xC3\xA9";
      }
      arrays.push_back(mat_matrix(name, 7, 1, ramp(7)));
    }
    const Outcome outcome = decode_bytes(mat_file(arrays));
    ASSERT_FALSE(outcome.error) << outcome.message;
    ASSERT_EQ(outcome.decoded.notes.size(), 1U);
    EXPECT_TRUE(is_utf8(outcome.decoded.notes[0])) << outcome.decoded.notes[0];
    EXPECT_TRUE(outcome.decoded.notes[0].ends_with("..."));
    EXPECT_LE(outcome.decoded.notes[0].size(), DecodeLimits{}.max_note_bytes + 3);
  }
}

TEST(ForeignNames, InARefusalAreUtf8) {
  const Outcome outcome = decode_bytes(zip({{"Gyroscope\xFF.csv", "one,two\nthree,four\n"}}));
  ASSERT_TRUE(outcome.error);
  EXPECT_THAT(outcome.message, HasSubstr("In 'Gyroscope\xC3\xBF.csv'"));
}

}  // namespace
}  // namespace driftlab
