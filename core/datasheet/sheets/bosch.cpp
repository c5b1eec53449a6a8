#include "core/datasheet/data_sheet.hpp"

#include <array>

namespace driftlab {
namespace {

constexpr std::array kRates{FullScale{125.0, 1.0 / 262.4}, FullScale{250.0, 1.0 / 131.2}, FullScale{500.0, 1.0 / 65.6},
                            FullScale{1000.0, 1.0 / 32.8}, FullScale{2000.0, 1.0 / 16.4}};
constexpr std::array kForces{FullScale{2.0, 1.0 / 16384.0}, FullScale{4.0, 1.0 / 8192.0}, FullScale{8.0, 1.0 / 4096.0},
                             FullScale{16.0, 1.0 / 2048.0}};
constexpr std::array kSixBitForces{FullScale{2.0, 1.0 / 16.0}, FullScale{4.0, 1.0 / 8.0}, FullScale{8.0, 1.0 / 4.0},
                                   FullScale{16.0, 1.0 / 2.0}};
constexpr std::array kTwelveBitForces{FullScale{2.0, 1.0 / 1024.0}, FullScale{4.0, 1.0 / 512.0},
                                      FullScale{8.0, 1.0 / 256.0}, FullScale{16.0, 1.0 / 128.0}};
constexpr std::array kHighForces{FullScale{3.0, 1.0 / 10920.0}, FullScale{6.0, 1.0 / 5460.0},
                                 FullScale{12.0, 1.0 / 2730.0}, FullScale{24.0, 1.0 / 1365.0}};
/// A processor behind the sensor gives its readings in units that can be chosen.
constexpr std::array kComputedForces{FullScale{2.0}, FullScale{4.0}, FullScale{8.0}, FullScale{16.0}};
constexpr std::array kComputedRates{FullScale{125.0}, FullScale{250.0}, FullScale{500.0}, FullScale{1000.0},
                                    FullScale{2000.0}};

constexpr std::array kBma220{SensorSheet{.quantity = Quantity::SpecificForce,
                                         .unit = "g",
                                         .scales = kSixBitForces,
                                         .bandwidth_hz = StatedSpan{32.0, 1000.0},
                                         .place = "section 1, table 1"}};
constexpr std::array kBmg160{SensorSheet{.quantity = Quantity::AngularRate,
                                         .unit = "deg/s",
                                         .scales = kRates,
                                         .noise_density = 0.014,
                                         .bandwidth_hz = StatedSpan{12.0, 230.0},
                                         .rate_hz = StatedSpan{100.0, 2000.0},
                                         .place = "section 1.1, table 1"}};
constexpr std::array kBmi055{SensorSheet{.quantity = Quantity::AngularRate,
                                         .unit = "deg/s",
                                         .scales = kRates,
                                         .noise_density = 0.014,
                                         .place = "section 1.3"},
                             SensorSheet{.quantity = Quantity::SpecificForce,
                                         .unit = "g",
                                         .scales = kTwelveBitForces,
                                         .noise_density = 150e-6,
                                         .place = "section 1.2"}};
constexpr std::array kBmi088{SensorSheet{.quantity = Quantity::AngularRate,
                                         .unit = "deg/s",
                                         .scales = kRates,
                                         .noise_density = 0.014,
                                         .bandwidth_hz = StatedSpan{12.0, 523.0},
                                         .rate_hz = StatedSpan{100.0, 2000.0},
                                         .place = "section 1.3, table 3"},
                             SensorSheet{.quantity = Quantity::SpecificForce,
                                         .unit = "g",
                                         .scales = kHighForces,
                                         .noise_density = 160e-6,
                                         .noise_density_z = 190e-6,
                                         .bandwidth_hz = StatedSpan{5.0, 280.0},
                                         .rate_hz = StatedSpan{12.5, 1600.0},
                                         .place = "section 1.2, table 2"}};
/// No noise density of the gyroscope is noted: 0.007 and 0.008 deg/s/sqrt(Hz) are both in use as the stated one.
constexpr std::array kBmi160{SensorSheet{.quantity = Quantity::AngularRate,
                                         .unit = "deg/s",
                                         .scales = kRates,
                                         .rate_hz = StatedSpan{25.0, 3200.0},
                                         .place = "section 1.3, table 3"},
                             SensorSheet{.quantity = Quantity::SpecificForce,
                                         .unit = "g",
                                         .scales = kForces,
                                         .noise_density = 180e-6,
                                         .rate_hz = StatedSpan{0.78, 1600.0},
                                         .place = "section 1.2, table 2"}};
constexpr std::array kBmi270{SensorSheet{.quantity = Quantity::AngularRate,
                                         .unit = "deg/s",
                                         .scales = kRates,
                                         .noise_density = 0.007,
                                         .bandwidth_hz = StatedSpan{11.0, 751.0},
                                         .rate_hz = StatedSpan{25.0, 6400.0},
                                         .place = "section 2, gyroscope (performance mode)"},
                             SensorSheet{.quantity = Quantity::SpecificForce,
                                         .unit = "g",
                                         .scales = kForces,
                                         .noise_density = 160e-6,
                                         .bandwidth_hz = StatedSpan{5.5, 740.0},
                                         .rate_hz = StatedSpan{0.78, 1600.0},
                                         .place = "section 2, accelerometer"}};
constexpr std::array kBno055{SensorSheet{.quantity = Quantity::AngularRate,
                                         .unit = "deg/s",
                                         .scales = kComputedRates,
                                         .noise_density = 0.014,
                                         .bandwidth_hz = StatedSpan{12.0, 523.0},
                                         .place = "section 1.2"},
                             SensorSheet{.quantity = Quantity::SpecificForce,
                                         .unit = "g",
                                         .scales = kComputedForces,
                                         .noise_density = 150e-6,
                                         .bandwidth_hz = StatedSpan{8.0, 1000.0},
                                         .place = "section 1.2"}};

constexpr std::array kSheets{
    DataSheet{"BMA220", "Bosch Sensortec", "BST-BMA220-DS003-07", "1.10", {}, kBma220},
    DataSheet{"BMG160", "Bosch Sensortec", "BST-BMG160-DS000-09", "1.2", {}, kBmg160},
    DataSheet{"BMI055", "Bosch Sensortec", "BST-BMI055-DS000-08", "1.2", {}, kBmi055},
    DataSheet{"BMI088", "Bosch Sensortec", "BST-BMI088-DS001-14", "1.4", {}, kBmi088},
    DataSheet{"BMI160", "Bosch Sensortec", "BST-BMI160-DS000-07", "0.8", {}, kBmi160},
    DataSheet{"BMI270", "Bosch Sensortec", "BST-BMI270-DS000-07", "1.5", {}, kBmi270},
    DataSheet{"BNO055", "Bosch Sensortec", "BST-BNO055-DS000-14", "1.4", {}, kBno055},
};

}  // namespace

std::span<const DataSheet> bosch_sheets() { return kSheets; }

}  // namespace driftlab
