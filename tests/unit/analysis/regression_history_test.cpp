/// Looks and releases as runs of a gate accumulate.
#include "core/analysis/regression_history.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

using Ids = std::vector<std::string>;

TEST(RegressionHistory, TheSameRecordingsAreTheSameLookInAnyOrder) {
  RegressionHistory history;
  EXPECT_EQ(history.look("1.5", {"a", "b"}), 1);
  history.add_run("1.5", {"a", "b"});
  EXPECT_EQ(history.look("1.5", {"b", "a"}), 1);
  EXPECT_EQ(history.look("1.5", {"a", "b", "c"}), 2);
  history.add_run("1.5", {"c", "b", "a"});
  history.add_run("1.5", {"b", "a"});  // the first look again takes no new one
  EXPECT_EQ(history.look("1.5", {"a"}), 3);
  EXPECT_EQ(history.look("1.6", {"a"}), 1) << "looks are those of one label";
}

TEST(RegressionHistory, ReleasesAreTheLabelsOfNeitherArmOldestFirst) {
  RegressionHistory history;
  for (const char* const label : {"1.2", "", "1.3", "1.4", "1.2", "1.5"}) {
    history.name(label);
  }
  EXPECT_EQ(history.labels(), (Ids{"1.2", "1.3", "1.4", "1.5"}));
  EXPECT_EQ(history.releases("1.3", "1.5"), (Ids{"1.2", "1.4"}));
}

TEST(RegressionHistory, CountsTheReleasesNamedBeforeTheBaseline) {
  RegressionHistory history;
  for (const char* const label : {"1.2", "1.3", "1.4", "1.5"}) {
    history.name(label);
  }
  EXPECT_EQ(history.before({"1.2", "1.4"}, "1.3"), 1);
  EXPECT_EQ(history.before({"1.4"}, "1.3"), 0);
  EXPECT_EQ(history.before({"1.2", "1.4"}, "unheard of"), 2);
}

TEST(RegressionHistory, AReleaseIsNotComparedWithItself) {
  const Status same = check_arms_differ("1.5", "1.5");
  ASSERT_FALSE(same);
  EXPECT_EQ(same.error().message, "Baseline and candidate have the same label, 1.5.");
  EXPECT_TRUE(check_arms_differ("1.4", "1.5"));
  EXPECT_TRUE(check_arms_differ("", "")) << "two arms without labels are two lists of files";
}

}  // namespace
}  // namespace driftlab
