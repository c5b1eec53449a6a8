#include "core/signal/infer_role.hpp"
#include "core/signal/recording.hpp"
#include "tests/unit/signal/failure.hpp"

#include <gmock/gmock.h>

namespace driftlab {
namespace {

Unit unit(const char* symbol) { return *parse_unit(symbol); }

/// "angular_rate x [deg/s]", "time [-]", ...
std::string described(const ColumnRole& role) {
  return std::string(name_of(role.quantity)) + (role.axis.empty() ? "" : " " + role.axis) + " [" +
         (role.unit ? role.unit->symbol : "-") + "]";
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

TEST(InferRole, KeepsTheSignsOfAUnitBehindAnUnderscore) {
  // `acc_x_µg` was read in g and `time_µs` in s: bytes beyond ASCII were dropped.
  const std::vector<std::pair<const char*, const char*>> cases{
      {"acc_x_\u00b5g", "specific_force x [ug]"},
      {"acc_x_\u03bcg", "specific_force x [ug]"},
      {"ax_ug", "specific_force x [ug]"},
      {"AX_UG", "specific_force x [ug]"},
      {"gyro_x_\u00b5rad/s", "angular_rate x [urad/s]"},
      {"gyro_x_\u03bcrad/s", "angular_rate x [urad/s]"},
      {"gyro_x_\u00b5radps", "angular_rate x [urad/s]"},
      {"gyro_x_\u00b5rad_s", "angular_rate x [urad/s]"},
      {"gyro_x_urad_s", "angular_rate x [urad/s]"},
      {"gyro_x_mdeg_s", "angular_rate x [mdeg/s]"},
      {"time_\u00b5s", "time [us]"},
      {"time_\u03bcs", "time [us]"},
      {"Accel_X_m/s\u00b2", "specific_force x [m/s^2]"},
      {"ACCEL_X_M/S\u00b2", "specific_force x [m/s^2]"},
      {"acc_x_m_s\u00b2", "specific_force x [m/s^2]"},
      {"acc_x_mps\u00b2", "specific_force x [m/s^2]"},
      {"ACC_X_M/S^2", "specific_force x [m/s^2]"},
      {"gyro_x_\u00b0/s", "angular_rate x [deg/s]"},
      {"gx \u00b0/h", "angular_rate x [deg/h]"},
      {"gyro_z_deg/hr", "angular_rate z [deg/h]"},
      {"Gyro_X_Deg/s", "angular_rate x [deg/s]"},
      {"temp_\u00b0C", "temperature [degC]"},
      {"mag_x_\u00b5T", "magnetic_field x [uT]"},
      {"\u03c9_x / (rad/s)", "angular_rate x [rad/s]"},
      {"Gyro\u00a0X (deg/s)", "angular_rate x [deg/s]"},
      // Signs that mean something else, or nothing that is known:
      {"acc_x_\u2030g", "unspecified [-]"},
      {"gyro_x_\u0394rad/s", "unspecified [-]"},
      {"acc_x_\u00b5", "unspecified [-]"},
      {"acc_x_\u00b5_g", "unspecified [-]"},
      {"a_x\u00b2", "unspecified [-]"},
      {"\u0394gx", "unspecified [-]"},
      {"acc_x_m/g", "unspecified [-]"},
      {"time_m/s", "unspecified [-]"},
      {"gyro_x_raw", "unspecified [-]"},
  };
  for (const auto& [name, expected] : cases) {
    EXPECT_EQ(described(infer_role(name)), expected) << name;
  }
}

TEST(InferRole, TakesTheQuantityFromTheUnitAndTheAxisFromTheName) {
  const std::vector<std::pair<const char*, const char*>> cases{
      {"Drehrate X [\u00b0/s]", "angular_rate x [deg/s]"},
      {"Winkelgeschwindigkeit Z [rad/s]", "angular_rate z [rad/s]"},
      {"Beschleunigung Y [m/s\u00b2]", "specific_force y [m/s^2]"},
      {"xAngRate (deg/s)", "angular_rate x [deg/s]"},
      {"gyroRotationX(rad/s)", "angular_rate x [rad/s]"},
      {"Rotation X [dps]", "angular_rate x [deg/s]"},
      {"Y-axis (mg)", "specific_force y [mg]"},
      {"acc_x/mg", "specific_force x [mg]"},
      {"acc_x/\u00b5g", "specific_force x [ug]"},
      {"acc_z / mg", "specific_force z [mg]"},
      {"acc_z/(m/s^2)", "specific_force z [m/s^2]"},
      {"Drehrate X/\u00b0/s", "angular_rate x [deg/s]"},
      {"gyro_z/deg/s", "angular_rate z [deg/s]"},
      {"t/s", "time [s]"},
      // What is no rate and no force, and what no unit tells:
      {"Rotation X [deg]", "unspecified [-]"},
      {"Rotation X", "unspecified [-]"},
      {"AngleX(deg)", "unspecified [-]"},
      {"gyro_bias_x (deg/s)", "unspecified [-]"},
      {"gravityX (m/s^2)", "unspecified [-]"},
      {"gx/g", "unspecified [-]"},
      {"/imu/gyro", "unspecified [-]"},
  };
  for (const auto& [name, expected] : cases) {
    EXPECT_EQ(described(infer_role(name)), expected) << name;
  }
}

TEST(InferRole, ReadsAUnitWithBracketsOfItsOwn) {
  // The bracket was opened at its last sign, and "s^2)" was no unit.
  EXPECT_EQ(described(infer_role("Acceleration X (m/(s^2))")), "specific_force x [m/s^2]");
  EXPECT_EQ(described(infer_role("acc_z [m/(s\u00b2)]")), "specific_force z [m/s^2]");
  EXPECT_EQ(described(infer_role("gyro x (deg/(s))")), "angular_rate x [deg/s]");
  EXPECT_EQ(described(infer_role("accelerometerAccelerationX(G)")), "specific_force x [g]");
  EXPECT_EQ(described(infer_role("X (m/(s^2))")), "specific_force x [m/s^2]");
  EXPECT_EQ(described(infer_role("gx [131 LSB/(deg/s)]")), "angular_rate x [" + unit("131 LSB/(deg/s)").symbol + "]");
  EXPECT_EQ(described(infer_role("acc (x) (g)")), "specific_force x [g]");
  EXPECT_EQ(described(infer_role("acc x g)")), "unspecified [-]");
  EXPECT_EQ(failure(assign_roles({}, {"gx", "acc x (m/(h^2))"})), "unknown_unit column=acc x (m/(h^2)) unit=m/(h^2)");
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

TEST(AssignRoles, TakesTheLetterOfATemperatureForNoTime) {
  // WitMotion's `T(°)` refused its logs: "the unit deg does not measure time".
  const auto roles = assign_roles({}, {"time(s)", "ax(g)", "wx(deg/s)", "AngleX(deg)", "T(\u00b0)"});
  ASSERT_TRUE(roles) << roles.error().message;
  EXPECT_EQ(described(*roles->at(0)), "time [s]");
  EXPECT_EQ(described(*roles->at(4)), "temperature [-]");
  EXPECT_EQ(unknown_unit_of_temperature("T(\u00b0)"), "\u00b0");
  EXPECT_EQ(described(infer_role("T (\u00b0C)")), "temperature [degC]");
  EXPECT_EQ(described(infer_role("T [C]")), "temperature [degC]");
  EXPECT_EQ(described(infer_role("T [K]")), "temperature [K]");
  EXPECT_EQ(described(infer_role("T (F)")), "temperature [-]");
  EXPECT_EQ(described(infer_role("T [ms]")), "time [ms]");
  EXPECT_EQ(described(infer_role("T")), "time [-]");
  const auto degrees = assign_roles({}, {"gx", "Temp(\u00b0)", "T (\u00b0C)"});
  ASSERT_TRUE(degrees) << degrees.error().message;
  EXPECT_EQ(described(*degrees->at(1)), "temperature [-]");
  EXPECT_EQ(described(*degrees->at(2)), "unspecified [-]") << "the plainer name is the temperature";
  EXPECT_EQ(failure(assign_roles({}, {"gx", "t (furlong)"})), "unknown_unit column=t (furlong) unit=furlong");
}

TEST(AssignRoles, TakesTheTemperatureOfASensorWhereNothingElseIsOne) {
  const auto alone = assign_roles({}, {"gx", "gyro_temp", "accel_temp"});
  ASSERT_TRUE(alone) << alone.error().message;
  EXPECT_EQ(described(*alone->at(1)), "temperature [-]");
  EXPECT_EQ(described(*alone->at(2)), "unspecified [-]");
  const auto beside = assign_roles({}, {"gyro_temp_c", "T(\u00b0)", "gx", "temp (degC)"});
  ASSERT_TRUE(beside) << beside.error().message;
  EXPECT_EQ(described(*beside->at(0)), "unspecified [-]");
  EXPECT_EQ(described(*beside->at(1)), "unspecified [-]");
  EXPECT_EQ(described(*beside->at(3)), "temperature [degC]");
  EXPECT_EQ(described(infer_role("gyroTemperature (\u00b0C)")), "temperature [degC]");
  EXPECT_EQ(described(infer_role("gyroTimestamp_sinceReboot(s)")), "time [s]");
  EXPECT_EQ(described(infer_role("gyro_z_temp")), "unspecified [-]");
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

TEST(AssignRoles, ReadsTheNamesOfMetaWear) {
  // Refused: "The unit '+0100' is not known". With `elapsed` stated as the time, `epoc (ms)` was taken for a sensor.
  const ColumnNames names{"epoc (ms)",      "timestamp (+0100)", "elapsed (s)",
                          "x-axis (deg/s)", "y-axis (deg/s)",    "z-axis (deg/s)"};
  const auto roles = assign_roles({}, names);
  ASSERT_TRUE(roles) << roles.error().message;
  EXPECT_EQ(described(*roles->at(0)), "time [ms]");
  EXPECT_FALSE(roles->at(1));
  EXPECT_FALSE(roles->at(2)) << "a second clock";
  EXPECT_EQ(described(*roles->at(3)), "angular_rate x [deg/s]");
  EXPECT_EQ(described(*roles->at(5)), "angular_rate z [deg/s]");
  RecordingSpec spec;
  spec.columns = {{"elapsed (s)", {Quantity::Time, "", unit("s")}}};
  const auto stated = assign_roles(spec, names);
  ASSERT_TRUE(stated) << stated.error().message;
  EXPECT_FALSE(stated->at(0)) << "a second clock";
  EXPECT_EQ(described(*stated->at(2)), "time [s]");
  EXPECT_EQ(described(*stated->at(3)), "angular_rate x [deg/s]");
  for (const char* const zone : {"time (-05:00)", "time (UTC+1)", "time (GMT)", "timestamp (UTC+05:30)"}) {
    EXPECT_TRUE(assign_roles({}, {"gx", zone})) << zone;
  }
  EXPECT_EQ(failure(assign_roles({}, {"gx", "time (+1)"})), "unknown_unit column=time (+1) unit=+1");
  EXPECT_EQ(described(infer_role("epoch_ms")), "time [ms]");
  EXPECT_EQ(described(infer_role("epoch")), "unspecified [-]");
  EXPECT_EQ(described(infer_role("elapsed (m)")), "unspecified [-]");
  EXPECT_EQ(described(infer_role("x-axis")), "unspecified [-]");
  EXPECT_EQ(described(infer_role("accel_y_axis (g)")), "specific_force y [g]");
}

TEST(AssignRoles, DoesNotGuessBetweenTwoColumnsOrAgainstAUnit) {
  EXPECT_EQ(failure(assign_roles({}, {"gx", "gyro_x"})), "duplicate_column column=gyro_x");
  EXPECT_EQ(failure(assign_roles({}, {"ax (deg/s)"})), "unit_mismatch column=ax (deg/s) unit=deg/s");
}

}  // namespace
}  // namespace driftlab
