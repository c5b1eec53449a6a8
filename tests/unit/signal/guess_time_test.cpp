/// A time column by its numbers, and what a recording without one is told.
#include "core/signal/guess_time.hpp"

#include "core/signal/recording_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace driftlab {
namespace {

using Columns = std::vector<std::vector<double>>;

std::vector<double> rising(double step, std::size_t rows = 200) {
  std::vector<double> values(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    values[i] = 1000.0 + step * static_cast<double>(i);
  }
  return values;
}

std::optional<TimeGuess> guess(const Columns& columns, std::vector<std::optional<ColumnRole>> roles = {}) {
  ColumnNames names;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    names.push_back("c" + std::to_string(i));
  }
  roles.resize(columns.size());
  return guess_time(names, roles, [&](std::size_t i) { return std::span<const double>(columns[i]); });
}

TEST(GuessTime, ReadsTheUnitOffTheStep) {
  EXPECT_EQ(guess({rising(0.01)})->unit.symbol, "s");
  EXPECT_EQ(guess({rising(10.0)})->unit.symbol, "ms");
  EXPECT_EQ(guess({rising(10000.0)})->unit.symbol, "us");
  EXPECT_EQ(guess({rising(1e7)})->unit.symbol, "ns");
  EXPECT_NEAR(guess({rising(10.0)})->rate_hz, 100.0, 1e-9);
}

TEST(GuessTime, ANumberOfTheRowAndNoiseAreNone) {
  EXPECT_FALSE(guess({rising(1.0)}));
  std::vector<double> wavy(200);
  for (std::size_t i = 0; i < wavy.size(); ++i) {
    wavy[i] = std::sin(static_cast<double>(i));
  }
  EXPECT_FALSE(guess({wavy}));
  EXPECT_FALSE(guess({rising(0.01, 15)})) << "too few rows";
  EXPECT_EQ(guess({wavy, rising(0.01)})->column, "c1");
}

TEST(GuessTime, WhereAColumnIsTheTimeNothingIsGuessed) {
  const ColumnRole time{Quantity::Time, "", *parse_unit("s")};
  EXPECT_FALSE(guess({rising(0.01), rising(0.02)}, {std::nullopt, time}));
  EXPECT_TRUE(guess({rising(0.01)}, {ColumnRole{Quantity::Time, "", std::nullopt}})) << "in which unit nobody says";
  EXPECT_FALSE(guess({rising(0.01)}, {ColumnRole{Quantity::Temperature, "", std::nullopt}}));
}

TEST(GuessTime, ARecordingWithoutATimeIsToldOfIt) {
  const Columns columns{rising(10.0), std::vector<double>(200, 0.5)};
  RecordingSpec spec;
  const auto view = view_recording(spec, {"0", "1"}, 200, [&](std::size_t i) { return std::span(columns[i]); });
  ASSERT_FALSE(view);
  EXPECT_NE(view.error().message.find("Column '0' rises as a time at 100 Hz does: 0=time:ms."), std::string::npos)
      << view.error().message;
  spec.columns["0"] = {Quantity::Time, "", *parse_unit("ms")};  // what it says, done
  const auto told = view_recording(spec, {"0", "1"}, 200, [&](std::size_t i) { return std::span(columns[i]); });
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_EQ(told->channels.size(), 1U);
  EXPECT_NEAR(told->window.time.rate_hz(), 100.0, 1e-9);
}

TEST(GuessTime, ATimeWithoutAUnitIsNamed) {
  const Columns columns{rising(10.0), std::vector<double>(200, 0.5)};
  const auto view = view_recording({}, {"timestamp", "gx"}, 200, [&](std::size_t i) { return std::span(columns[i]); });
  ASSERT_FALSE(view);
  EXPECT_EQ(
      view.error().message,
      "The time column 'timestamp' has no unit and no rate is stated: give its unit (columns timestamp=time:s, or "
      "ms, us, ns) or rate_hz. In ms its rate would be 100 Hz.");
}

}  // namespace
}  // namespace driftlab
