// Ends of outages on a map: in which ellipse of the filter they lie, and the strokes that show it.
#include "core/analysis/drawn_drive.hpp"

#include "tests/unit/navigate/drive_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::drive {
namespace {

TEST(EllipseClass, ChangesAtTheQuantilesOfChiSquareWithTwoDegreesOfFreedom) {
  // The quantiles are written to four decimals, which is 4e-5 at most beside -2 ln(1 - p).
  constexpr double kWritten = 5e-5;
  EXPECT_EQ(ellipse_class(0.0), EllipseClass::Within50);
  EXPECT_EQ(ellipse_class(nees_of_share(0.50) - kWritten), EllipseClass::Within50);
  EXPECT_EQ(ellipse_class(nees_of_share(0.50) + kWritten), EllipseClass::Within95);
  EXPECT_EQ(ellipse_class(nees_of_share(0.95) - kWritten), EllipseClass::Within95);
  EXPECT_EQ(ellipse_class(nees_of_share(0.95) + kWritten), EllipseClass::Outside);
}

TEST(EllipseClass, OfWhatHasNoNeesIsOutside) {
  EXPECT_EQ(ellipse_class(std::nullopt), EllipseClass::Outside);
  EXPECT_EQ(ellipse_class(std::nan("")), EllipseClass::Outside);
}

TEST(MapOf, SortsOutagesInTheirOrderAndDrawsErrorAndEllipseOfEach) {
  const std::vector<MappedOutage> outages{
      {.truth_m = {10.0, 20.0}, .error_m = {3.0, 4.0}, .covariance_m2 = {4.0, 0.0, 9.0}, .nees = 5.0},
      {.truth_m = {0.0, 0.0}, .error_m = {0.0, -6.0}, .covariance_m2 = {1.0, 0.0, 1.0}, .nees = 36.0},
      {.truth_m = {1.0, 1.0}, .error_m = {1.0, 0.0}, .covariance_m2 = {4.0, 0.0, 4.0}, .nees = 2.0}};
  const OutageMap map = map_of(outages);
  EXPECT_TRUE(map.of(EllipseClass::Within50).truths_m.empty());
  EXPECT_EQ(map.of(EllipseClass::Outside).truths_m, (std::vector<MapPlace>{{0.0, 0.0}}));
  const MapClass& between = map.of(EllipseClass::Within95);
  EXPECT_EQ(between.truths_m, (std::vector<MapPlace>{{10.0, 20.0}, {1.0, 1.0}}));
  ASSERT_EQ(between.strokes_m.size(), 4U);
  EXPECT_EQ(between.strokes_m[0], (std::vector<MapPlace>{{10.0, 20.0}, {13.0, 24.0}}));
  EXPECT_EQ(map.largest_error_m, 6.0);
  // Half axes of the 95 % ellipse about the estimate: sqrt(5.9915) times 3 m to the east and 2 m to the north.
  double east = 0.0;
  double north = 0.0;
  for (const MapPlace& place : between.strokes_m[1]) {
    east = std::max(east, place[0] - 13.0);
    north = std::max(north, place[1] - 24.0);
  }
  EXPECT_NEAR(east, 3.0 * std::sqrt(nees_of_share(0.95)), 1e-12);
  EXPECT_NEAR(north, 2.0 * std::sqrt(nees_of_share(0.95)), 1e-12);
  EXPECT_EQ(map_of({}).largest_error_m, 0.0);
}

TEST(MapOf, TakesAnOutageAsADocumentKeepsIt) {
  const Drive drive = simulated_drive(51);
  DriveOutage outage;
  outage.reference_ecef_m = drive.reference.front().position_ecef_m;
  outage.error_ned_m = {3.0, 4.0, 50.0};
  outage.covariance_ned.diagonal() << 9.0, 4.0, 1.0;
  outage.covariance_ned(0, 1) = outage.covariance_ned(1, 0) = 1.0;
  const MappedOutage kept = mapped(outage, drive);
  EXPECT_EQ(kept.truth_m, (MapPlace{0.0, 0.0})) << "the map begins where the reference does";
  EXPECT_EQ(kept.error_m, (MapPlace{4.0, 3.0})) << "east and north";
  EXPECT_EQ(kept.covariance_m2, (std::array<double, 3>{9.0, 1.0, 4.0}));
  EXPECT_EQ(kept.nees, outage.nees());
  outage.reference_ecef_m = drive.reference.back().position_ecef_m;
  EXPECT_EQ(mapped(outage, drive).truth_m, way_of(drive).back());
}

TEST(WayOf, KeepsAtMostFiveHundredAndOnePointsAndTheLast) {
  Drive drive = simulated_drive(51);
  const std::vector<ReferencePoint> whole = drive.reference;
  ASSERT_FALSE(whole.empty());
  for (const std::size_t points : {std::size_t{1}, std::size_t{499}, std::size_t{500}, std::size_t{1003}}) {
    drive.reference.assign(points, whole.front());
    drive.reference.back() = whole.back();
    const std::vector<MapPlace> way = way_of(drive);
    EXPECT_LE(way.size(), 501U) << points;
    EXPECT_GE(way.size(), std::min<std::size_t>(points, 250)) << points;
    const Vector3 end = drive.on_map(whole.back().position_ecef_m);
    EXPECT_EQ(way.back(), (MapPlace{end.y(), end.x()})) << points;
  }
  drive.reference.clear();
  EXPECT_TRUE(way_of(drive).empty());
}

}  // namespace
}  // namespace driftlab::drive
