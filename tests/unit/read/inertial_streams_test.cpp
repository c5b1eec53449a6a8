/// The units of a log with several: one is the recording, the others stand beside it and are read by their stream.
#include "core/read/inertial_streams.hpp"

#include "core/signal/missing.hpp"
#include "core/signal/recording_view.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Three units at 100 Hz, of which the second begins a sample later and the third stops after two thirds.
class ThreeUnits {
 public:
  explicit ThreeUnits(std::size_t rows) {
    InertialStreams streams(sink_, 1e6);
    std::array<std::size_t, 3> ids{};
    for (std::size_t unit = 0; unit < 3; ++unit) {
      ids[unit] = *streams.add("unit " + std::to_string(unit), Inertial::Both, inertial_columns(Inertial::Both));
    }
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t unit = 0; unit < 3; ++unit) {
        if ((unit == 1 && i == 0) || (unit == 2 && i >= 2 * rows / 3)) {
          continue;
        }
        EXPECT_TRUE(streams.take(ids[unit], 1'000'000 + 10'000 * i + unit, sample(unit, i)));
      }
    }
    EXPECT_TRUE(streams.finish("Nothing."));
  }
  [[nodiscard]] static std::array<double, 6> sample(std::size_t unit, std::size_t i) {
    std::array<double, 6> values{};
    for (std::size_t k = 0; k < 6; ++k) {
      values[k] = static_cast<double>(unit + 1) + 0.125 * static_cast<double>((i * (k + 3)) % 17);
    }
    return values;
  }
  [[nodiscard]] const ColumnNames& names() const { return sink_.names; }
  [[nodiscard]] std::size_t rows() const { return sink_.columns.front().size(); }
  [[nodiscard]] const std::vector<double>& column(std::size_t i) const { return sink_.columns[i]; }
  [[nodiscard]] Result<RecordingView> view(const std::string& stream) const {
    RecordingSpec spec;
    spec.stream = stream;
    return view_recording(spec, names(), rows(), [this](std::size_t i) { return std::span<const double>(column(i)); });
  }

 private:
  KeepingSink sink_;
};

/// `count` samples of a unit along axis `k`, from `first` on.
void expect_samples(std::span<const double> values, std::size_t unit, std::size_t k, std::size_t first,
                    std::size_t count) {
  ASSERT_EQ(values.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_EQ(values[i], ThreeUnits::sample(unit, first + i)[k]) << "unit " << unit << ", sample " << i;
  }
}

TEST(InertialStreams, TheOtherUnitsOfALogAreReadByTheirStream) {
  for (const std::size_t rows : {std::size_t{300}, std::size_t{300'000}}) {  // chosen at the end, and on the way
    const ThreeUnits log(rows);
    const auto first = log.view("");
    const auto second = log.view("imu2");
    const auto third = log.view("imu3");
    ASSERT_TRUE(first && second && third);
    for (const auto* const view : {&*first, &*second, &*third}) {
      ASSERT_EQ(view->channels.size(), 6U);
      EXPECT_DOUBLE_EQ(view->window.time.dt_s, 0.01);
    }
    for (std::size_t k = 0; k < 6; ++k) {
      expect_samples(first->channels[k].values, 0, k, 0, rows);
      expect_samples(second->channels[k].values, 1, k, 1, rows - 1);
      expect_samples(third->channels[k].values, 2, k, 0, 2 * rows / 3);
    }
    EXPECT_EQ(first->channels[0].column, "gyro_x (rad/s)");
    EXPECT_EQ(second->channels[0].column, "imu2_gyro_x (rad/s)");
    EXPECT_EQ(second->channels[0].role, first->channels[0].role);
  }
}

TEST(InertialStreams, ARecordingSaysNothingOfTheUnitsThatItIsNot) {
  const ThreeUnits log(300);
  const auto first = log.view("");
  const auto second = log.view("imu2");
  ASSERT_TRUE(first && second);
  EXPECT_THAT(first->window.quality.notes, IsEmpty());
  for (const std::string& note : second->window.quality.notes) {
    EXPECT_THAT(note, HasSubstr("imu2_")) << note;
  }
}

TEST(InertialStreams, AShorterUnitHasEndedWhileItsTimeGoesOn) {
  const ThreeUnits log(300);
  const auto at = [&](const std::string& name) -> const std::vector<double>& {
    const auto found = std::find(log.names().begin(), log.names().end(), name);
    EXPECT_NE(found, log.names().end()) << name;
    return log.column(static_cast<std::size_t>(found - log.names().begin()));
  };
  EXPECT_EQ(at("imu3_time (s)").size(), 300U);
  EXPECT_DOUBLE_EQ(at("imu3_time (s)").back(), 2.99);
  EXPECT_EQ(why_missing(at("imu3_acc_z (m/s^2)").back()).why, Missing::Ended);
  EXPECT_TRUE(std::isfinite(at("imu3_acc_z (m/s^2)")[199]));
}

TEST(InertialStreams, AMuchSlowerUnitIsNamedAndLeftOut) {
  KeepingSink sink;
  InertialStreams streams(sink, 1e6);
  const std::size_t both = *streams.add("both", Inertial::Both, inertial_columns(Inertial::Both));
  const std::size_t slow = *streams.add("slow", Inertial::Both, inertial_columns(Inertial::Both));
  const std::array<double, 6> zeros{};
  for (std::size_t i = 0; i < 2100; ++i) {
    ASSERT_TRUE(streams.take(both, 10'000 * i, zeros));
    if (i % 21 == 0) {
      ASSERT_TRUE(streams.take(slow, 10'000 * i, zeros));
    }
  }
  ASSERT_TRUE(streams.finish("Nothing."));
  EXPECT_EQ(sink.names.size(), 7U);
  EXPECT_THAT(sink.notes, ElementsAre(HasSubstr("Left out: 'slow' (gyroscope and accelerometer, 100 samples).")));
}

TEST(InertialStreams, OfAFasterUnitThereIsAsMuchAsOfTheRecording) {
  KeepingSink sink;
  InertialStreams streams(sink, 1e6);
  const std::size_t both = *streams.add("both", Inertial::Both, inertial_columns(Inertial::Both));
  const std::size_t fast = *streams.add("fast", Inertial::Gyroscope, inertial_columns(Inertial::Gyroscope));
  const std::array<double, 6> zeros{};
  constexpr std::size_t kRows = 100'000;
  for (std::size_t i = 0; i < kRows; ++i) {
    ASSERT_TRUE(streams.take(both, 8000 * i, zeros));
    for (std::size_t k = 0; k < 8; ++k) {
      const std::array<double, 3> values{static_cast<double>(8 * i + k), 0.0, 0.0};
      ASSERT_TRUE(streams.take(fast, 8000 * i + 1000 * k, values));
    }
  }
  ASSERT_TRUE(streams.finish("Nothing."));
  const std::vector<double>& x = sink.columns[8];
  ASSERT_EQ(sink.names[8], "imu2_gyro_x (rad/s)");
  ASSERT_EQ(x.size(), kRows);
  std::size_t there = 0;
  while (there < x.size() && x[there] == static_cast<double>(there)) {
    ++there;
  }
  EXPECT_GT(there, kRows / 20) << "what there is is the beginning, without a hole";
  for (std::size_t i = there; i < x.size(); ++i) {
    ASSERT_TRUE(std::isnan(x[i]));
  }
  EXPECT_THAT(sink.notes.back(),
              HasSubstr("Of 'fast' the last " + std::to_string(8 * kRows - there) + " rows are left out."));
}

}  // namespace
}  // namespace driftlab
