#include "core/datasheet/data_sheet.hpp"

#include <array>

namespace driftlab {
namespace {

using Names = std::array<std::string_view, 1>;

constexpr std::array kRates{FullScale{250.0, 1.0 / 131.0}, FullScale{500.0, 1.0 / 65.5}, FullScale{1000.0, 1.0 / 32.8},
                            FullScale{2000.0, 1.0 / 16.4}};
constexpr std::array kFineRates{FullScale{15.625, 1.0 / 2097.2}, FullScale{31.25, 1.0 / 1048.6},
                                FullScale{62.5, 1.0 / 524.3},    FullScale{125.0, 1.0 / 262.0},
                                FullScale{250.0, 1.0 / 131.0},   FullScale{500.0, 1.0 / 65.5},
                                FullScale{1000.0, 1.0 / 32.8},   FullScale{2000.0, 1.0 / 16.4}};
constexpr std::array kFastRates{FullScale{500.0, 1.0 / 65.5}, FullScale{1000.0, 1.0 / 32.8},
                                FullScale{2000.0, 1.0 / 16.4}, FullScale{4000.0, 1.0 / 8.2}};
constexpr std::array kForces{FullScale{2.0, 1.0 / 16384.0}, FullScale{4.0, 1.0 / 8192.0}, FullScale{8.0, 1.0 / 4096.0},
                             FullScale{16.0, 1.0 / 2048.0}};
constexpr std::array kHighForces{FullScale{4.0, 1.0 / 8192.0}, FullScale{8.0, 1.0 / 4096.0},
                                 FullScale{16.0, 1.0 / 2048.0}, FullScale{30.0, 1.0 / 1024.0}};

constexpr std::array kMpu6050{SensorSheet{.quantity = Quantity::AngularRate,
                                          .unit = "deg/s",
                                          .scales = kRates,
                                          .noise_density = 0.005,
                                          .bandwidth_hz = StatedSpan{5.0, 256.0},
                                          .rate_hz = StatedSpan{4.0, 8000.0},
                                          .place = "section 6.1"},
                              SensorSheet{.quantity = Quantity::SpecificForce,
                                          .unit = "g",
                                          .scales = kForces,
                                          .noise_density = 400e-6,
                                          .bandwidth_hz = StatedSpan{5.0, 260.0},
                                          .rate_hz = StatedSpan{4.0, 1000.0},
                                          .place = "section 6.2"}};
constexpr std::array kMpu6500{SensorSheet{.quantity = Quantity::AngularRate,
                                          .unit = "deg/s",
                                          .scales = kRates,
                                          .noise_density = 0.01,
                                          .bandwidth_hz = StatedSpan{5.0, 250.0},
                                          .rate_hz = StatedSpan{4.0, 8000.0},
                                          .place = "section 3.1, table 1"},
                              SensorSheet{.quantity = Quantity::SpecificForce,
                                          .unit = "g",
                                          .scales = kForces,
                                          .noise_density = 300e-6,
                                          .bandwidth_hz = StatedSpan{5.0, 260.0},
                                          .rate_hz = StatedSpan{4.0, 4000.0},
                                          .place = "section 3.2, table 2"}};
constexpr std::array kIcm20602{SensorSheet{.quantity = Quantity::AngularRate,
                                           .unit = "deg/s",
                                           .scales = kRates,
                                           .noise_density = 0.004,
                                           .place = "section 3.1, table 1"},
                               SensorSheet{.quantity = Quantity::SpecificForce,
                                           .unit = "g",
                                           .scales = kForces,
                                           .noise_density = 100e-6,
                                           .place = "section 3.2, table 2"}};
constexpr std::array kIcm20649{SensorSheet{.quantity = Quantity::AngularRate,
                                           .unit = "deg/s",
                                           .scales = kFastRates,
                                           .noise_density = 0.0175,
                                           .place = "section 3.1, table 1"},
                               SensorSheet{.quantity = Quantity::SpecificForce,
                                           .unit = "g",
                                           .scales = kHighForces,
                                           .noise_density = 285e-6,
                                           .place = "section 3.2, table 2"}};
/// No noise is noted: no text was found that confirms what is in use.
constexpr std::array kIcm20689{
    SensorSheet{.quantity = Quantity::AngularRate, .unit = "deg/s", .scales = kRates, .place = "section 3.1, table 1"},
    SensorSheet{.quantity = Quantity::SpecificForce, .unit = "g", .scales = kForces, .place = "section 3.2, table 2"}};
constexpr std::array kIcm20948{SensorSheet{.quantity = Quantity::AngularRate,
                                           .unit = "deg/s",
                                           .scales = kRates,
                                           .noise_density = 0.015,
                                           .bandwidth_hz = StatedSpan{5.7, 197.0},
                                           .place = "section 3.1, table 1"},
                               SensorSheet{.quantity = Quantity::SpecificForce,
                                           .unit = "g",
                                           .scales = kForces,
                                           .noise_density = 230e-6,
                                           .bandwidth_hz = StatedSpan{5.7, 246.0},
                                           .rate_hz = StatedSpan{4.5, 4500.0},
                                           .place = "section 3.2, table 2"}};
constexpr std::array kIcm42605{SensorSheet{.quantity = Quantity::AngularRate,
                                           .unit = "deg/s",
                                           .scales = kFineRates,
                                           .noise_density = 0.0038,
                                           .place = "section 3.1, table 1"},
                               SensorSheet{.quantity = Quantity::SpecificForce,
                                           .unit = "g",
                                           .scales = kForces,
                                           .noise_density = 70e-6,
                                           .place = "section 3.2, table 2"}};
constexpr std::array kIcm42688{SensorSheet{.quantity = Quantity::AngularRate,
                                           .unit = "deg/s",
                                           .scales = kFineRates,
                                           .noise_density = 0.0028,
                                           .rate_hz = StatedSpan{12.5, 32000.0},
                                           .place = "section 3.1, table 1"},
                               SensorSheet{.quantity = Quantity::SpecificForce,
                                           .unit = "g",
                                           .scales = kForces,
                                           .noise_density = 65e-6,
                                           .noise_density_z = 70e-6,
                                           .rate_hz = StatedSpan{1.5625, 32000.0},
                                           .place = "section 3.2, table 2"}};

constexpr Names kMpu6000{"MPU-6000"};
constexpr Names kIcm42688Name{"ICM-42688"};

constexpr std::array kSheets{
    DataSheet{"MPU-6050", "InvenSense", "PS-MPU-6000A-00", "3.4", kMpu6000, kMpu6050},
    DataSheet{"MPU-9150", "InvenSense", "PS-MPU-9150A-00", "4.3", {}, kMpu6050},
    DataSheet{"MPU-6500", "InvenSense", "PS-MPU-6500A-01", "1.1", {}, kMpu6500},
    DataSheet{"MPU-9250", "InvenSense", "PS-MPU-9250A-01", "1.1", {}, kMpu6500},
    DataSheet{"ICM-20602", "TDK InvenSense", "DS-000176", "", {}, kIcm20602},
    DataSheet{"ICM-20649", "TDK InvenSense", "DS-000192", "", {}, kIcm20649},
    DataSheet{"ICM-20689", "TDK InvenSense", "DS-000143", "", {}, kIcm20689},
    DataSheet{"ICM-20948", "TDK InvenSense", "DS-000189", "1.3", {}, kIcm20948},
    DataSheet{"ICM-42605", "TDK InvenSense", "DS-000292", "1.5", {}, kIcm42605},
    DataSheet{"ICM-42688-P", "TDK InvenSense", "DS-000347", "1.6", kIcm42688Name, kIcm42688},
};

}  // namespace

std::span<const DataSheet> invensense_sheets() { return kSheets; }

}  // namespace driftlab
