#include "core/signal/name_list.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(NameList, CountsTheNamesBehindTheFirst) {
  NameList names(2);
  EXPECT_TRUE(names.empty());
  EXPECT_EQ(names.text(), "");
  names.add("a");
  names.add("b");
  EXPECT_EQ(names.text(), "a, b");
  names.add("c");
  names.add("d");
  EXPECT_FALSE(names.empty());
  EXPECT_EQ(names.text(), "a, b and 2 more");
}

}  // namespace
}  // namespace driftlab
