#include "schema/json/table_figures.hpp"

#include "schema/figure/drawing.hpp"
#include "schema/json/report_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace driftlab {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

Json row(const Json& condition, double value) {
  return {{"condition", condition}, {"values", {{"N", {{"value", value}, {"ci95", {0.9 * value, 1.1 * value}}}}}}};
}

Json table(const std::string& axis, const std::vector<Json>& rows) {
  return {{"device", "one"},
          {"sensor", "gyroscope"},
          {"axis", axis},
          {"columns", {{{"key", "N"}, {"unit", "deg/sqrt(h)"}}}},
          {"rows", rows}};
}

const Json kStatic{{"kind", "static"}};

Json rate(double value, const std::string& unit) {
  return {{"kind", "constant_rate"}, {"axis", "z"}, {"value", value}, {"unit", unit}};
}

TEST(TableFigures, ADeviceAtRestHasAnAxisThatSaysSo) {
  const auto figures = figures_of_table(table("z", {row(kStatic, 0.1)}), "");
  ASSERT_EQ(figures.size(), 1U);
  EXPECT_EQ(figures[0].name, "N");
  const figure::Plot& plot = figures[0].figure.plots.at(0);
  EXPECT_EQ(plot.x.name, "at rest");
  EXPECT_GT(plot.x.domain->second, 0.5) << "zero has room around it";
  EXPECT_EQ(plot.x.domain->first, -plot.x.domain->second) << "and stands in the middle";
  const std::string drawn = figure::to_svg(figures[0].figure);
  EXPECT_NE(drawn.find(">at rest<"), std::string::npos);
  EXPECT_NE(drawn.find(">0.04<"), std::string::npos) << "the heights have numbers";
  for (const char* const number : {">0.2<", ">0.5<", ">0.8<", ">1<"}) {
    EXPECT_EQ(drawn.find(number), std::string::npos) << number << ": a place at rest has none";
  }
}

TEST(TableFigures, ConditionsOfOneKindStandInOneUnitAndOtherKindsApart) {
  const Json acceleration{{"kind", "angular_acceleration"}, {"axis", "z"}, {"value", 2.0}, {"unit", "deg/s^2"}};
  const auto figures = figures_of_table(table("z", {row(kStatic, 0.1), row(rate(9.0, "deg/s"), 0.2),
                                                    row(rate(-0.5, "rad/s"), 0.3), row(acceleration, 0.4)}),
                                        "");
  ASSERT_EQ(figures.size(), 2U);
  EXPECT_EQ(figures[0].name, "N-constant_rate");
  EXPECT_EQ(figures[1].name, "N-angular_acceleration");
  const figure::Plot& rates = figures[0].figure.plots.at(0);
  EXPECT_THAT(rates.x.name, HasSubstr("constant rate"));
  EXPECT_THAT(rates.series.at(0).x, ElementsAre(0.0, DoubleNear(9.0, 1e-12), DoubleNear(28.6479, 1e-4)));
  const figure::Plot& accelerations = figures[1].figure.plots.at(0);
  EXPECT_THAT(accelerations.series.at(0).x, ElementsAre(0.0, DoubleNear(2.0, 1e-12)));
}

TEST(TableFigures, TheTablesOfAllAxesAreDrawnByAxis) {
  const Json all{{"device", "one"}, {"tables", {table("x", {row(kStatic, 0.1)}), table("y", {row(kStatic, 0.2)})}}};
  const auto figures = figures_of(all, "N");
  ASSERT_TRUE(figures) << figures.error().message;
  ASSERT_EQ(figures->size(), 2U);
  EXPECT_EQ((*figures)[0].name, "x-N");
  EXPECT_EQ((*figures)[1].name, "y-N");
  EXPECT_FALSE(figures_of(all, "K"));
}

TEST(TableFigures, ANameThatIsNotThereIsAnsweredWithThoseThatAre) {
  Json one = table("x", {row(kStatic, 0.1)});
  one["columns"].push_back({{"key", "K"}, {"unit", "deg/h/sqrt(h)"}});
  one["rows"][0]["values"]["K"] = {{"value", 2.0}, {"ci95", {1.0, 3.0}}};
  const auto figures = figures_of({{"device", "one"}, {"tables", {one, table("y", {row(kStatic, 0.2)})}}}, "n");
  ASSERT_FALSE(figures);
  EXPECT_EQ(figures.error().message, "The document has no figure of 'n'; it has figures of N, K.");
}

TEST(IsAskedFor, ANameWithItsUnitOrWithout) {
  EXPECT_TRUE(is_asked_for("gx (deg/s)", "gx"));
  EXPECT_TRUE(is_asked_for("gx (deg/s)", "gx (deg/s)"));
  EXPECT_TRUE(is_asked_for("Gyroscope x [rad/s]", "Gyroscope x"));
  EXPECT_TRUE(is_asked_for("gx", ""));
  EXPECT_FALSE(is_asked_for("gx (deg/s)", "g"));
  EXPECT_FALSE(is_asked_for("gx (deg/s)", "gy"));
  EXPECT_FALSE(is_asked_for("gyro x", "gyro")) << "x is no unit";
  EXPECT_FALSE(is_asked_for("(x)", "x"));
}

TEST(TableFigures, TheTablesOfSeveralSensorsAreDrawnBySensorToo) {
  Json other = table("x", {row(kStatic, 0.1)});
  other["sensor"] = "accelerometer";
  const Json all{{"device", "one"}, {"tables", {table("x", {row(kStatic, 0.1)}), other}}};
  const auto figures = figures_of(all, "N");
  ASSERT_TRUE(figures) << figures.error().message;
  ASSERT_EQ(figures->size(), 2U);
  EXPECT_EQ((*figures)[0].name, "gyroscope-x-N");
  EXPECT_EQ((*figures)[1].name, "accelerometer-x-N");
}

TEST(TableReports, HaveEveryNumberWithItsInterval) {
  Json one = table("z", {row(kStatic, 0.1)});
  one["model"] = nullptr;  // as a table by Allan variance has it
  one["columns"].push_back({{"key", "alpha"}, {"unit", nullptr}});
  one["rows"][0]["label"] = "static";
  one["rows"][0]["values"]["alpha"] = {{"value", 1.25}, {"ci95", {nullptr, nullptr}}};
  const auto page = report_page(one, "one", "");
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_THAT(*page, HasSubstr("<td>static</td><td>0.100 [0.090, 0.110]</td><td>1.25</td>"));
  one["method"] = "av";
  const auto all = report_page({{"device", "one"}, {"tables", {one, table("x", {row(kStatic, 0.2)})}}}, "one", "");
  ASSERT_TRUE(all) << all.error().message;
  EXPECT_THAT(*all, HasSubstr("<h2>gyroscope z, Allan variance</h2>"));
  EXPECT_THAT(*all, Not(HasSubstr("driftlab " DRIFTLAB_VERSION ", <")));
  EXPECT_THAT(*all, HasSubstr("gyroscope x"));
}

}  // namespace
}  // namespace driftlab
