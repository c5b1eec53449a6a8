#include "core/signal/stretch.hpp"

#include <gmock/gmock.h>

namespace driftlab {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Stretch, TakesEverythingWhileNoMoreThanAFifthIsMissing) {
  const std::vector<RowRun> runs{{0, 400, 0}, {400, 400, 200}};  // 200 of 1000 places
  const Stretch stretch = choose_stretch(runs);
  EXPECT_EQ(stretch.rows(), 800U);
  EXPECT_EQ(stretch.missing(), 200U);
  EXPECT_THAT(stretch.gaps(), ElementsAre(Gap{400, 200}));
  EXPECT_EQ(choose_stretch(std::vector<RowRun>{{0, 400, 0}, {400, 400, 201}}).runs, (std::vector<RowRun>{{0, 400, 0}}));
}

TEST(Stretch, TakesThreeFifthsMissingOneByOne) {
  std::vector<RowRun> runs;
  for (std::size_t i = 0; i < 400; ++i) {
    runs.push_back({i, 1, i == 0 ? std::size_t{0} : 1 + i % 2});  // 599 or 600 of 1000 places
  }
  EXPECT_EQ(choose_stretch(runs).rows(), 400U);
  runs.push_back({400, 4, 5});  // a gap of more than a hundredth of 404 rows
  EXPECT_EQ(choose_stretch(runs).rows(), 400U);
}

TEST(Stretch, SplitsAtTheLargestGapAndGoesOnWithTheLongerPart) {
  const std::vector<RowRun> runs{{0, 300, 0}, {300, 100, 20}, {400, 350, 1000}};
  EXPECT_EQ(choose_stretch(runs).runs, (std::vector<RowRun>{{0, 300, 0}, {300, 100, 20}}));
}

TEST(Stretch, IsNeverShorterThanTheLongestRun) {
  // The part with more rows is full of gaps of its own: what is left of it is less than the run split off first.
  std::vector<RowRun> runs{{0, 100, 0}};
  for (std::size_t i = 0; i < 12; ++i) {
    runs.push_back({100 + 10 * i, 10, i == 0 ? std::size_t{90} : std::size_t{50}});
  }
  EXPECT_EQ(choose_stretch(runs).rows(), 100U);
  EXPECT_THAT(choose_stretch({}).runs, IsEmpty());
}

TEST(Stretch, CutsRowsAtTheGapsInside) {
  const std::vector<Gap> gaps{{10, 1}, {20, 2}, {30, 3}};
  EXPECT_THAT(cut_at_gaps(10, 30, gaps), ElementsAre(RowRun{10, 10, 0}, RowRun{20, 10, 2}));
  EXPECT_THAT(cut_at_gaps(5, 5, gaps), IsEmpty());
}

TEST(Stretch, CountsRemovedRowsAsMissing) {
  const std::vector<RowRun> runs{{0, 10, 0}, {10, 10, 7}};
  const std::vector<std::size_t> removed{0, 4, 5, 9, 10, 19};
  EXPECT_THAT(without_rows(runs, removed), ElementsAre(RowRun{1, 3, 1}, RowRun{6, 3, 2}, RowRun{11, 8, 9}));
  EXPECT_THAT(without_rows(runs, removed, {2, 12}), ElementsAre(RowRun{1, 1, 1}, RowRun{12, 7, 17}));
  EXPECT_THAT(without_rows(runs, {}, {0, 20}), IsEmpty());
  EXPECT_EQ(without_rows(runs, {}), runs);
}

TEST(Stretch, SharesTheRowsOfBoth) {
  const std::vector<RowRun> a{{0, 10, 0}, {10, 10, 7}, {25, 5, 5}};
  const std::vector<RowRun> b{{2, 5, 0}, {9, 3, 2}, {26, 10, 21}};
  EXPECT_THAT(shared_runs(a, b), ElementsAre(RowRun{2, 5, 0}, RowRun{9, 1, 2}, RowRun{10, 2, 7}, RowRun{26, 4, 14}));
  EXPECT_EQ(shared_runs(a, a), a);
  EXPECT_THAT(shared_runs(a, {}), IsEmpty());
}

}  // namespace
}  // namespace driftlab
