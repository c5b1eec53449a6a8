#include "core/signal/recording.hpp"

#include "core/signal/infer_role.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace driftlab {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Unit unit(const char* symbol) { return *parse_unit(symbol); }

/// "angular_rate x [deg/s]", "time [-]", ...
std::string described(const ColumnRole& role) {
  return std::string(name_of(role.quantity)) + (role.axis.empty() ? "" : " " + role.axis) + " [" +
         (role.unit ? role.unit->symbol : "-") + "]";
}

template <class T>
std::string failure(const Result<T>& result) {
  if (result) {
    return "accepted";
  }
  std::string text(name_of(result.error().code));
  for (const ErrorField& field : result.error().fields) {
    text += " " + field.name + "=" + field.value;
  }
  return text;
}

TEST(InferRole, UnderstandsNamesPeopleUse) {
  const std::vector<std::pair<const char*, const char*>> cases{
      {"gx", "angular_rate x [-]"},
      {"gyro_x", "angular_rate x [-]"},
      {"GyroY", "angular_rate y [-]"},
      {"Gyroscope x (rad/s)", "angular_rate x [rad/s]"},
      {"wx [deg/s]", "angular_rate x [deg/s]"},
      {"omega_z", "angular_rate z [-]"},
      {"gyro_z[dps]", "angular_rate z [deg/s]"},
      {"gyro_x_dps", "angular_rate x [deg/s]"},
      {"wy_radps", "angular_rate y [rad/s]"},
      {"ax", "specific_force x [-]"},
      {"acc_x", "specific_force x [-]"},
      {"fx", "specific_force x [-]"},
      {"accel_z [g]", "specific_force z [g]"},
      {"acc_z (m/s^2)", "specific_force z [m/s^2]"},
      {"fz_mps2", "specific_force z [m/s^2]"},
      {"x_acc", "specific_force x [-]"},
      {"Accelerometer Z (g)", "specific_force z [g]"},
      {"mag_x (uT)", "magnetic_field x [uT]"},
      {"X (rad/s)", "angular_rate x [rad/s]"},
      {"Y (m/s^2)", "specific_force y [m/s^2]"},
      {"raw_acceleration_x_gs", "specific_force x [g]"},
      {"raw_angular_rate_z_deg_per_s", "angular_rate z [deg/s]"},
      {"timestamp_seconds", "time [s]"},
      {"temperature_celsius", "temperature [degC]"},
      {"millis", "time [ms]"},
      {"imu_gyr_x", "angular_rate x [-]"},
      {"imu1.fb_z", "specific_force z [-]"},
      {"SENSgyro_y", "angular_rate y [-]"},
      {"gyro_bias_x", "unspecified [-]"},
      {"est_acceleration_x", "unspecified [-]"},
      {"temp", "temperature [-]"},
      {"Temperature (°C)", "temperature [degC]"},
      {"temp_c", "temperature [degC]"},
      {"t", "time [-]"},
      {"time", "time [-]"},
      {"timestamp", "time [-]"},
      {"time (ms)", "time [ms]"},
      {"Time (s)", "time [s]"},
      {"time (sec)", "time [s]"},
      {"time_ms", "time [ms]"},
      {"t_us", "time [us]"},
      {"t_s", "time [s]"},
      {"seconds_elapsed", "time [s]"},
      // Nothing to go by:
      {"0", "unspecified [-]"},
      {"", "unspecified [-]"},
      {"()", "unspecified [-]"},
      {"x", "unspecified [-]"},
      {"state", "unspecified [-]"},
      {"max", "unspecified [-]"},
      {"acc_l_x[mg]", "unspecified [-]"},
      {"gyro", "unspecified [-]"},
      {"time_zone", "unspecified [-]"},
  };
  for (const auto& [name, expected] : cases) {
    EXPECT_EQ(described(infer_role(name)), expected) << name;
  }
}

TEST(AssignRoles, RefusesAnUnknownUnitInTheNameOfASensor) {
  for (const char* const name :
       {"gz [furlong]", "Accelerometer x (ft/s^2)", "time (fortnights)", "mag_x [G]", "ax [2g]"}) {
    const auto roles = assign_roles({}, {"gx", name});
    ASSERT_FALSE(roles) << name;
    EXPECT_EQ(roles.error().code, ErrorCode::UnknownUnit) << name;
    EXPECT_EQ(roles.error().fields[0], (ErrorField{"column", name}));
    EXPECT_EQ(roles.error().message.find("Column '" + std::string(name) + "': The unit '"), 0U) << name;
  }
  // Raw numbers, clocks, and columns that are no sensor's: nothing is claimed about a unit.
  for (const char* const name : {"gz (LSB)", "gz [counts]", "gz (raw)", "gz [-]", "gz []", "time (UTC)",
                                 "Barometer (hPa)", "pressure [furlong]", "X (furlong)"}) {
    EXPECT_TRUE(assign_roles({}, {"gx", name})) << name;
  }
  RecordingSpec stated;
  stated.columns = {{"gz [furlong]", {Quantity::AngularRate, "z", unit("deg/s")}}};
  EXPECT_TRUE(assign_roles(stated, {"gz [furlong]"})) << "what the user states rules";
}

TEST(InferRole, UnderstandsTheNamesThatToolsGive) {
  const std::vector<std::pair<const char*, const char*>> cases{
      {"linear_acceleration_x [m/s^2]", "specific_force x [m/s^2]"},
      {"linear_acceleration.z", "specific_force z [-]"},
      {"imu.linear_acceleration_y", "specific_force y [-]"},
      {"gyro_x_rad_s", "angular_rate x [rad/s]"},
      {"gyro_x_deg_s", "angular_rate x [deg/s]"},
      {"Gyro_Z_Deg_S", "angular_rate z [deg/s]"},
      {"gyro_x_mdps", "angular_rate x [mdeg/s]"},
      {"gyro_y_mrad_s", "angular_rate y [mrad/s]"},
      {"acc_x_m_s2", "specific_force x [m/s^2]"},
      {"acc_x_m_s^2", "specific_force x [m/s^2]"},
      {"gyro_rad[0]", "angular_rate x [rad/s]"},
      {"gyro_rad[2]", "angular_rate z [rad/s]"},
      {"accelerometer_m_s2[1]", "specific_force y [m/s^2]"},
      {"gyro[1]", "angular_rate y [-]"},
      {"angular_velocity[0]", "angular_rate x [-]"},
      // Nothing to go by, or something else:
      {"gyro_rad[3]", "unspecified [-]"},
      {"q[0]", "unspecified [-]"},
      {"a[0]", "unspecified [-]"},
      {"gyro_x_m_s2", "unspecified [-]"},
      {"gyro_clip[0]", "unspecified [-]"},
      {"gyro_x_rad", "unspecified [-]"},
      {"Linear Acceleration x (m/s^2)", "unspecified [-]"},
      {"[0]", "unspecified [-]"},
  };
  for (const auto& [name, expected] : cases) {
    EXPECT_EQ(described(infer_role(name)), expected) << name;
  }
}

TEST(AssignRoles, PrefersThePlainNameToTheOneOfATool) {
  const auto roles = assign_roles({}, {"acc_x (g)", "linear_acceleration_x (g)", "gyro[0]", "gyro_y", "gyro[1]"});
  ASSERT_TRUE(roles) << roles.error().message;
  EXPECT_EQ(described(*roles->at(0)), "specific_force x [g]");
  EXPECT_EQ(described(*roles->at(1)), "unspecified [-]");
  EXPECT_EQ(described(*roles->at(2)), "angular_rate x [-]");
  EXPECT_EQ(described(*roles->at(3)), "angular_rate y [-]");
  EXPECT_EQ(described(*roles->at(4)), "unspecified [-]");
}

TEST(AssignRoles, ReadsALetterAsTheUnitThatTheQuantityHas) {
  EXPECT_EQ(described(infer_role("temp (C)")), "temperature [degC]");
  EXPECT_EQ(described(infer_role("Temp [C]")), "temperature [degC]");
  EXPECT_EQ(described(infer_role("temperature (deg C)")), "temperature [degC]");
  EXPECT_EQ(described(infer_role("ax [G]")), "specific_force x [g]");
  EXPECT_EQ(described(infer_role("X (G)")), "unspecified [-]") << "may be gauss";
  EXPECT_EQ(described(infer_role("time (\u03bcs)")), "time [us]");
}

TEST(AssignRoles, TakesATemperatureWithoutItsUnitWhereThatIsNotKnown) {
  // `temp (F)` refused the whole file.
  const auto roles = assign_roles({}, {"gx", "temp (F)"});
  ASSERT_TRUE(roles) << roles.error().message;
  EXPECT_EQ(described(*roles->at(1)), "temperature [-]");
  EXPECT_EQ(unknown_unit_of_temperature("temp (F)"), "F");
  EXPECT_EQ(unknown_unit_of_temperature("temp (C)"), "");
  EXPECT_EQ(unknown_unit_of_temperature("temp (raw)"), "");
  EXPECT_EQ(unknown_unit_of_temperature("gx (F)"), "");
}

TEST(AssignRoles, TakesCountsInTheNameOfASensorForNoUnitOfTime) {
  for (const char* const name : {"gz [digits]", "gz [LSBs]", "gz (digit)", "gz [LSBS]"}) {
    const auto roles = assign_roles({}, {"gx", name});
    ASSERT_TRUE(roles) << name << ": " << roles.error().message;
    EXPECT_EQ(roles->at(1)->quantity, Quantity::AngularRate) << name;
    EXPECT_EQ(roles->at(1)->unit.value_or(Unit{}).symbol, "1") << name;
  }
}

TEST(AssignRoles, TakesStatedColumnsAndLeavesTheRest) {
  RecordingSpec spec;
  spec.columns = {{"b", {Quantity::AngularRate, "z", unit("deg/s")}}};
  const auto roles = assign_roles(spec, {"a", "b", "gx"});
  ASSERT_TRUE(roles);
  EXPECT_FALSE(roles->at(0));
  EXPECT_EQ(described(*roles->at(1)), "angular_rate z [deg/s]");
  EXPECT_FALSE(roles->at(2));  // nothing is guessed once something is stated
}

TEST(AssignRoles, NamesTheColumnOfEveryFault) {
  const auto with = [](const std::map<std::string, ColumnRole>& columns) {
    RecordingSpec spec;
    spec.columns = columns;
    return failure(assign_roles(spec, {"a", "b"}));
  };
  EXPECT_EQ(with({{"c", {Quantity::Time, "", unit("s")}}}), "unknown_column column=c");
  EXPECT_EQ(with({{"a", {Quantity::AngularRate, "x", {}}}, {"b", {Quantity::AngularRate, "x", {}}}}),
            "duplicate_column column=b");
  EXPECT_EQ(with({{"a", {Quantity::SpecificForce, "x", unit("deg/s")}}}), "unit_mismatch column=a unit=deg/s");
  EXPECT_EQ(with({{"a", {Quantity::AngularRate, "", {}}}}), "invalid_argument column=a parameter=axis");
  EXPECT_EQ(with({{"a", {Quantity::AngularRate, "north", {}}}}), "invalid_argument column=a parameter=axis");
  EXPECT_EQ(with({{"a", {Quantity::Time, "x", {}}}}), "invalid_argument column=a parameter=axis");
  EXPECT_EQ(with({{"a", {Quantity::Unspecified, "", {}}}, {"b", {Quantity::Unspecified, "", {}}}}), "accepted");
}

TEST(AssignRoles, InfersFromHeaderNames) {
  const auto roles = assign_roles({}, {"time", "gx", "state"});
  ASSERT_TRUE(roles);
  EXPECT_EQ(described(*roles->at(0)), "time [-]");
  EXPECT_EQ(described(*roles->at(1)), "angular_rate x [-]");
  EXPECT_EQ(described(*roles->at(2)), "unspecified [-]");
}

TEST(AssignRoles, KeepsTheTimeColumnWhoseUnitIsKnown) {
  const auto roles = assign_roles({}, {"time", "seconds_elapsed", "z", "y", "x"});
  ASSERT_TRUE(roles) << roles.error().message;
  EXPECT_FALSE(roles->at(0));
  EXPECT_EQ(described(*roles->at(1)), "time [s]");
}

TEST(AssignRoles, TakesAColumnByItsNumberUnderAHeaderToo) {
  // `--columns 0=time::s` was refused as soon as the file had a header.
  RecordingSpec spec;
  spec.columns = {{"0", {Quantity::Time, "", unit("s")}}, {"rate", {Quantity::AngularRate, "z", unit("deg/s")}}};
  const auto roles = assign_roles(spec, {"stamp", "rate", "2"});
  ASSERT_TRUE(roles) << roles.error().message;
  EXPECT_EQ(described(*roles->at(0)), "time [s]");
  EXPECT_FALSE(roles->at(2));
  spec.columns = {{"2", {Quantity::Time, "", unit("s")}}};  // a name comes first
  EXPECT_EQ(described(*assign_roles(spec, {"2", "a", "b"})->at(0)), "time [s]");
  EXPECT_EQ(failure(assign_roles(spec, {"a", "b"})), "unknown_column column=2");
  spec.columns = {{"1", {Quantity::AngularRate, "z", unit("deg/s")}}, {"b", {Quantity::AngularRate, "y", {}}}};
  EXPECT_EQ(failure(assign_roles(spec, {"a", "b"})), "duplicate_column column=b");
}

TEST(AssignRoles, ReadsTheNamesOfTheRestWhereTheTimeAloneIsStated) {
  // "6=time:ms", as the refusal had asked for, gave "None of the columns is a sensor".
  RecordingSpec spec;
  spec.columns = {{"2", {Quantity::Time, "", unit("ms")}}};
  const auto roles = assign_roles(spec, {"gx [deg/s]", "ax (g)", "stamp", "time (s)", "state"});
  ASSERT_TRUE(roles) << roles.error().message;
  EXPECT_EQ(described(*roles->at(0)), "angular_rate x [deg/s]");
  EXPECT_EQ(described(*roles->at(1)), "specific_force x [g]");
  EXPECT_EQ(described(*roles->at(2)), "time [ms]");
  EXPECT_FALSE(roles->at(3)) << "another time than the stated one";
  EXPECT_EQ(described(*roles->at(4)), "unspecified [-]");
  EXPECT_EQ(failure(assign_roles(spec, {"gz [furlong]", "b", "c"})), "unknown_unit column=gz [furlong] unit=furlong");
}

TEST(AssignRoles, KnowsTheRatesOfRollPitchAndYaw) {
  const auto roles = assign_roles({}, {"rollrate", "pitch_rate [deg/s]", "YawRate", "roll"});
  ASSERT_TRUE(roles) << roles.error().message;
  EXPECT_EQ(described(*roles->at(0)), "angular_rate x [-]");
  EXPECT_EQ(described(*roles->at(1)), "angular_rate y [deg/s]");
  EXPECT_EQ(described(*roles->at(2)), "angular_rate z [-]");
  EXPECT_EQ(described(*roles->at(3)), "unspecified [-]");
}

TEST(AssignRoles, KnowsTheTimeThatIsNamedAfterItsSensor) {
  // `TimestampGyro [ns]` was analysed as a sensor in unit 1, and the rate asked for.
  for (const char* name :
       {"TimestampGyro [ns]", "timestamp_acc (ns)", "gyro_timestamp_ns", "IMU Time [ns]", "Zeit [ns]"}) {
    const auto roles = assign_roles({}, {name, "gx"});
    ASSERT_TRUE(roles) << roles.error().message;
    EXPECT_EQ(described(*roles->at(0)), "time [ns]") << name;
  }
  const auto both = assign_roles({}, {"TimestampGyro [ns]", "gx", "TimestampAcc [ns]", "ax"});
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_FALSE(both->at(2));
}

TEST(AssignRoles, DoesNotGuessBetweenTwoColumnsOrAgainstAUnit) {
  EXPECT_EQ(failure(assign_roles({}, {"gx", "gyro_x"})), "duplicate_column column=gyro_x");
  EXPECT_EQ(failure(assign_roles({}, {"ax (deg/s)"})), "unit_mismatch column=ax (deg/s) unit=deg/s");
}

RecordingSpec at_rate(double rate_hz, Trim trim = {}) {
  RecordingSpec spec;
  spec.rate_hz = rate_hz;
  spec.trim = trim;
  return spec;
}

std::vector<double> stamps(std::size_t count, double step) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<double>(i) * step;
  }
  return values;
}

Result<Window> plan(const RecordingSpec& spec, const std::vector<double>& time, const char* symbol = "s") {
  return plan_window(spec, time.size(), time, unit(symbol));
}

TEST(PlanWindow, IsUniformWithoutATimeColumn) {
  const auto window = plan_window(at_rate(50.0, {30.0, 20.0}), 5000, {}, Unit{});
  ASSERT_TRUE(window);
  EXPECT_EQ(window->time.dt_s, 1.0 / 50.0);
  EXPECT_EQ(window->first, 1500U);
  EXPECT_EQ(window->count, 5000U - 1500U - 1000U);
  EXPECT_EQ(window->quality.samples, 5000U);
  EXPECT_EQ(window->quality.analysed, 2500U);
  EXPECT_EQ(window->quality.measured_rate_hz, 0.0);
  EXPECT_THAT(window->quality.notes, IsEmpty());
}

TEST(PlanWindow, TrimsTheSameRowsWithAndWithoutATimeColumn) {
  for (const Trim trim : {Trim{0.0, 0.0}, Trim{30.0, 30.0}, Trim{0.015, 0.0}, Trim{0.1, 0.3}, Trim{12.34, 7.001}}) {
    const auto uniform = plan_window(at_rate(100.0, trim), 10000, {}, Unit{});
    const auto stamped = plan(at_rate(100.0, trim), stamps(10000, 0.01));
    ASSERT_TRUE(uniform && stamped);
    EXPECT_EQ(uniform->first, stamped->first) << trim.start_s;
    EXPECT_EQ(uniform->count, stamped->count) << trim.end_s;
  }
}

TEST(PlanWindow, NeedsARateOrATimeColumn) {
  EXPECT_EQ(failure(plan_window({}, 100, {}, Unit{})), "inconsistent_sampling parameter=rate_hz");
}

TEST(PlanWindow, NamesTheSettingThatIsWrong) {
  EXPECT_EQ(failure(plan_window(at_rate(0.0), 100, {}, Unit{})), "invalid_argument parameter=rate_hz");
  EXPECT_EQ(failure(plan_window(at_rate(-1.0), 100, {}, Unit{})), "invalid_argument parameter=rate_hz");
  EXPECT_EQ(failure(plan_window(at_rate(std::nan("")), 100, {}, Unit{})), "invalid_argument parameter=rate_hz");
  EXPECT_EQ(failure(plan_window(at_rate(1.0, {-1.0, 0.0}), 100, {}, Unit{})),
            "invalid_argument parameter=trim.start_s");
  EXPECT_EQ(failure(plan_window(at_rate(1.0, {0.0, INFINITY}), 100, {}, Unit{})),
            "invalid_argument parameter=trim.end_s");
}

TEST(PlanWindow, RefusesWhatTheTrimsLeaveNothingOf) {
  EXPECT_EQ(failure(plan_window(at_rate(10.0, {9.0, 1.0}), 100, {}, Unit{})), "too_few_samples parameter=trim.start_s");
  EXPECT_EQ(failure(plan_window(at_rate(10.0, {1.0, 1e300}), 100, {}, Unit{})), "too_few_samples parameter=trim.end_s");
  EXPECT_EQ(failure(plan(at_rate(10.0, {60.0, 0.0}), stamps(100, 0.1))), "too_few_samples parameter=trim.start_s");
}

TEST(PlanWindow, RefusesOneSample) {
  EXPECT_EQ(failure(plan_window(at_rate(10.0), 1, {}, Unit{})), "too_few_samples");
  EXPECT_EQ(failure(plan(at_rate(10.0), {1.0})), "too_few_samples");
}

TEST(PlanWindow, ReadsTheRateFromTheTimeColumn) {
  const auto window = plan({}, stamps(1001, 20.0), "ms");
  ASSERT_TRUE(window);
  EXPECT_DOUBLE_EQ(window->time.dt_s, 0.02);
  EXPECT_DOUBLE_EQ(window->quality.measured_rate_hz, 50.0);
  EXPECT_EQ(window->count, 1001U);
}

TEST(PlanWindow, TakesTheStatedRateWhereTheStampsConfirmIt) {
  // Stamps as decimal text: 0.02 i rounds, and the mean step differs from 1/50 in the last bits.
  EXPECT_EQ(plan(at_rate(50.0), stamps(1001, 0.02))->time.dt_s, 1.0 / 50.0);
}

TEST(PlanWindow, LetsTheTimeColumnRuleWithinOnePercent) {
  const auto window = plan(at_rate(50.0), stamps(1001, 0.0201));
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_NEAR(window->time.dt_s, 0.0201, 1e-12);
  EXPECT_THAT(window->quality.notes, Contains(HasSubstr("49.7512 Hz where 50 Hz is stated")));
}

TEST(PlanWindow, NamesBothRatesWhenTheyContradict) {
  const auto window = plan(at_rate(50.0), stamps(1001, 0.025));
  EXPECT_EQ(failure(window), "inconsistent_sampling parameter=rate_hz stated_hz=50 measured_hz=40");
  EXPECT_THAT(window.error().message, HasSubstr("50 Hz"));
  EXPECT_THAT(window.error().message, HasSubstr("40 Hz"));
}

TEST(PlanWindow, ReadsAnUnstatedTimeUnitAsSecondsOnlyIfTheRateAgrees) {
  const auto agrees = plan(at_rate(50.0), stamps(100, 0.02), "1");
  ASSERT_TRUE(agrees);
  EXPECT_THAT(agrees->quality.notes, Contains(HasSubstr("no unit")));
  const auto in_ms = plan(at_rate(50.0), stamps(100, 20.0), "1");
  ASSERT_FALSE(in_ms);
  EXPECT_EQ(in_ms.error().code, ErrorCode::InconsistentSampling);
  EXPECT_THAT(in_ms.error().message, HasSubstr("In ms it would agree"));
  const auto nothing = plan({}, stamps(100, 0.02), "1");
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, ErrorCode::InconsistentSampling);
  EXPECT_THAT(nothing.error().message, HasSubstr("no unit"));
}

TEST(PlanWindow, NamesTheSampleAtWhichTimeStepsBackOrIsNoNumber) {
  std::vector<double> time = stamps(100, 0.01);
  time[40] = 0.2;
  EXPECT_EQ(failure(plan({}, time)), "non_monotonic_time row=41");
  time[40] = std::nan("");
  EXPECT_EQ(failure(plan({}, time)), "non_finite row=41");
  EXPECT_EQ(failure(plan({}, std::vector<double>(10, 3.0))), "inconsistent_sampling");
}

TEST(PlanWindow, CountsRepeatedStampsAndKeepsThem) {
  std::vector<double> time = stamps(1000, 0.01);
  time[500] = time[499];  // the step behind it is twice as long, but nothing is missing
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->count, 1000U);
  EXPECT_EQ(window->quality.gaps, 0U);
  EXPECT_EQ(window->quality.repeated_stamps, 1U);
  EXPECT_THAT(window->quality.notes, Contains(HasSubstr("1 time stamp repeats the one before.")));
}

TEST(PlanWindow, SplitsAtGapsOfMoreThanAFifth) {
  // 100 samples, a gap of 5 s, 300 samples, a gap of 2 s, 200 samples.
  std::vector<double> time;
  double now = 10.0;
  for (int i = 0; i < 600; ++i) {
    now += i == 100 ? 5.0 : i == 400 ? 2.0 : 0.01;
    time.push_back(now);
  }
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->quality.gaps, 2U);
  EXPECT_NEAR(window->quality.longest_gap_s, 5.0, 1e-9);
  EXPECT_EQ(window->first, 100U);
  EXPECT_EQ(window->count, 300U);
  EXPECT_EQ(window->quality.samples, 600U);
  EXPECT_NEAR(window->time.dt_s, 0.01, 1e-12);
  EXPECT_NEAR(window->time.start_s, 10.01, 1e-12);
  EXPECT_THAT(window->quality.notes, Contains(HasSubstr("300 of 600 samples are analysed, from sample 101")));
}

TEST(PlanWindow, AnalysesWhatLiesOnBothSidesOfAGap) {
  // 2000 samples, 0.5 s lost, 3000 samples, 2 s lost, 1000 samples.
  std::vector<double> time = stamps(6000, 0.01);
  for (std::size_t i = 2000; i < time.size(); ++i) {
    time[i] += i >= 5000 ? 2.5 : 0.5;
  }
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->count, 6000U);
  EXPECT_THAT(window->gaps, ElementsAre(Gap{2000, 50}, Gap{5000, 200}));
  EXPECT_EQ(window->quality.missing, 250U);
  EXPECT_EQ(window->time.dt_s, 0.01);
  EXPECT_THAT(window->quality.notes, Contains(HasSubstr("250 samples are missing")));
}

TEST(PlanWindow, TakesALateStampThatIsMadeUpForAsNoGap) {
  // Stamps of a host: every hundredth is 8 ms late, the next ones on time again. One sample is really lost.
  std::vector<double> time = stamps(5001, 0.01);
  time.erase(time.begin() + 2320);
  for (std::size_t i = 50; i < time.size(); i += 100) {
    time[i] += 0.008;
  }
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->quality.gaps, 51U);
  EXPECT_THAT(window->gaps, ElementsAre(Gap{2320, 1}));
  EXPECT_EQ(window->count, 5000U);
}

TEST(PlanWindow, CountsGapsThatLieCloseTogether) {
  // Of 4000 samples, at 1000, 1003 and 1010 one, two and three are lost.
  std::vector<double> time;
  for (std::size_t i = 0; i < 4000; ++i) {
    const bool lost = i == 1000 || (i >= 1004 && i < 1006) || (i >= 1013 && i < 1016);
    if (!lost) {
      time.push_back(0.01 * static_cast<double>(i));
    }
  }
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  std::size_t missing = 0;
  for (const Gap& gap : window->gaps) {
    missing += gap.missing;
    EXPECT_NEAR(static_cast<double>(gap.row), 1005.0, 5.0);
  }
  EXPECT_EQ(missing, 6U);
  EXPECT_EQ(window->time.dt_s, 0.01);
}

TEST(PlanWindow, UnderstandsFifosStampedAtOnce) {
  // Four samples share each stamp, every 40 ms; the eleventh FIFO is lost.
  std::vector<double> time(400);
  for (std::size_t i = 0; i < time.size(); ++i) {
    const std::size_t fifo = i / 4 + (i >= 40 ? 1 : 0);
    time[i] = 0.04 * static_cast<double>(fifo);
  }
  const auto window = plan({}, time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->quality.repeated_stamps, 300U);
  EXPECT_EQ(window->quality.gaps, 1U);
  EXPECT_EQ(window->count, 400U);
  EXPECT_THAT(window->gaps, ElementsAre(Gap{40, 4}));
  // 403 steps over 100 FIFOs of 40 ms: the last FIFO counts at its first sample, a bias of 3 in 403.
  EXPECT_NEAR(window->time.dt_s, 0.01, 0.01 * 3.0 / 403.0 * 1.01);
}

TEST(PlanWindow, SeesOneMissingSample) {
  std::vector<double> time = stamps(1000, 0.01);
  time.erase(time.begin() + 700);
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->quality.gaps, 1U);
  EXPECT_EQ(window->count, 999U);
  EXPECT_THAT(window->gaps, ElementsAre(Gap{700, 1}));
}

TEST(PlanWindow, MeasuresTheMeanOfCoarseStamps) {
  // 300 Hz stamped in whole milliseconds: steps of 3 and 4 ms, median 3; the mean is right.
  std::vector<double> time(3001);
  for (std::size_t i = 0; i < time.size(); ++i) {
    time[i] = std::floor(static_cast<double>(i) * 1000.0 / 300.0);
  }
  const auto window = plan({}, time, "ms");
  ASSERT_TRUE(window);
  EXPECT_EQ(window->quality.gaps, 0U);
  // 3000 steps end on a whole millisecond, at 10 s exactly.
  EXPECT_DOUBLE_EQ(window->time.dt_s, 10.0 / 3000.0);
}

TEST(Window, LastsAsLongAsItsSamplesAndThoseMissingBetweenThem) {
  Window window;
  window.time.dt_s = 0.02;
  window.count = 300;
  window.quality.missing = 50;
  EXPECT_DOUBLE_EQ(window.duration_s(), 7.0);
  EXPECT_DOUBLE_EQ(window.time.rate_hz(), 50.0);
}

TEST(Quality, SaysHowManySamplesOfAColumnAreFrozenAndNoneOfAColumnThatItDoesNotKnow) {
  Quality quality;
  quality.channels.resize(2);
  quality.channels[0].column = "gx";
  quality.channels[0].frozen = 7;
  quality.channels[1].column = "gz";
  EXPECT_EQ(frozen_samples(quality, "gx"), 7U);
  EXPECT_EQ(frozen_samples(quality, "gz"), 0U);
  EXPECT_EQ(frozen_samples(quality, "gy"), 0U);
  EXPECT_EQ(quality.of("gz"), &quality.channels[1]);
  EXPECT_EQ(quality.of("gy"), nullptr);
}

}  // namespace
}  // namespace driftlab
