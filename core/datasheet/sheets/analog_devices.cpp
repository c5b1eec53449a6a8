#include "core/datasheet/data_sheet.hpp"

#include <array>

namespace driftlab {
namespace {

constexpr std::string_view kTable1 = "table 1, specifications";

constexpr std::array k16405Rates{FullScale{75.0, 0.0125}, FullScale{150.0, 0.025}, FullScale{300.0, 0.05}};
constexpr std::array k16405Forces{FullScale{18.0, 3.33e-3}};
constexpr std::array k16448Rates{FullScale{250.0, 0.01}, FullScale{500.0, 0.02}, FullScale{1000.0, 0.04}};
constexpr std::array k16448Forces{FullScale{18.0, 0.833e-3}};
constexpr std::array kRates1{FullScale{125.0, 1.0 / 160.0}};
constexpr std::array kRates2{FullScale{500.0, 1.0 / 40.0}};
constexpr std::array kRates3{FullScale{2000.0, 1.0 / 10.0}};
constexpr std::array kRatesAny{FullScale{125.0, 1.0 / 160.0}, FullScale{500.0, 1.0 / 40.0},
                               FullScale{2000.0, 1.0 / 10.0}};
constexpr std::array kForces8{FullScale{8.0, 1.0 / 4000.0}};
constexpr std::array kForces40{FullScale{40.0, 1.0 / 800.0}};
constexpr std::array kForces392{FullScale{392.0, 392.0 / 32000.0}};
constexpr std::array k16495Rates{FullScale{125.0}};
constexpr std::array k16495Forces{FullScale{8.0}};

constexpr std::array k16405{SensorSheet{.quantity = Quantity::AngularRate,
                                        .unit = "deg/s",
                                        .scales = k16405Rates,
                                        .noise_density = 0.05,
                                        .random_walk = 2.0,
                                        .bias_stability = 25.2,
                                        .bandwidth_hz = StatedSpan{330.0, 330.0},
                                        .rate_hz = StatedSpan{0.413, 819.2},
                                        .place = kTable1},
                            SensorSheet{.quantity = Quantity::SpecificForce,
                                        .unit = "g",
                                        .scales = k16405Forces,
                                        .noise_density = 0.5e-3,
                                        .random_walk = 0.2,
                                        .bias_stability = 200.0,
                                        .bandwidth_hz = StatedSpan{330.0, 330.0},
                                        .rate_hz = StatedSpan{0.413, 819.2},
                                        .place = kTable1}};
constexpr std::array k16448{SensorSheet{.quantity = Quantity::AngularRate,
                                        .unit = "deg/s",
                                        .scales = k16448Rates,
                                        .noise_density = 0.0135,
                                        .random_walk = 0.66,
                                        .bias_stability = 14.5,
                                        .bandwidth_hz = StatedSpan{330.0, 330.0},
                                        .place = kTable1},
                            SensorSheet{.quantity = Quantity::SpecificForce,
                                        .unit = "g",
                                        .scales = k16448Forces,
                                        .noise_density = 0.23e-3,
                                        .random_walk = 0.11,
                                        .bias_stability = 250.0,
                                        .bandwidth_hz = StatedSpan{330.0, 330.0},
                                        .place = kTable1}};

/// The accelerometer is the same in every model of the family. No noise density of the gyroscopes is noted, and of the
/// third model no noise at all: no text was found that states them.
constexpr SensorSheet k16465Force{.quantity = Quantity::SpecificForce,
                                  .unit = "g",
                                  .scales = kForces8,
                                  .noise_density = 23e-6,
                                  .random_walk = 0.012,
                                  .bias_stability = 3.6,
                                  .bandwidth_hz = StatedSpan{600.0, 600.0},
                                  .rate_hz = StatedSpan{1.0, 2000.0},
                                  .place = kTable1};
constexpr std::array k16465{
    SensorSheet{.quantity = Quantity::AngularRate, .unit = "deg/s", .scales = kRatesAny, .place = kTable1},
    k16465Force};
constexpr std::array k16465Model1{SensorSheet{.quantity = Quantity::AngularRate,
                                              .unit = "deg/s",
                                              .scales = kRates1,
                                              .random_walk = 0.15,
                                              .bias_stability = 2.0,
                                              .bandwidth_hz = StatedSpan{550.0, 550.0},
                                              .place = kTable1},
                                  k16465Force};
constexpr std::array k16465Model2{SensorSheet{.quantity = Quantity::AngularRate,
                                              .unit = "deg/s",
                                              .scales = kRates2,
                                              .random_walk = 0.15,
                                              .bias_stability = 2.5,
                                              .bandwidth_hz = StatedSpan{550.0, 550.0},
                                              .place = kTable1},
                                  k16465Force};
constexpr std::array k16465Model3{SensorSheet{.quantity = Quantity::AngularRate,
                                              .unit = "deg/s",
                                              .scales = kRates3,
                                              .bandwidth_hz = StatedSpan{550.0, 550.0},
                                              .place = kTable1},
                                  k16465Force};
constexpr std::array k16470{SensorSheet{.quantity = Quantity::AngularRate,
                                        .unit = "deg/s",
                                        .scales = kRates3,
                                        .noise_density = 0.008,
                                        .random_walk = 0.34,
                                        .bias_stability = 8.0,
                                        .place = kTable1},
                            SensorSheet{.quantity = Quantity::SpecificForce,
                                        .unit = "g",
                                        .scales = kForces40,
                                        .random_walk = 0.037,
                                        .bias_stability = 13.0,
                                        .place = kTable1}};
constexpr std::array k16495Model1{SensorSheet{.quantity = Quantity::AngularRate,
                                              .unit = "deg/s",
                                              .scales = k16495Rates,
                                              .random_walk = 0.09,
                                              .bias_stability = 0.8,
                                              .place = kTable1},
                                  SensorSheet{.quantity = Quantity::SpecificForce,
                                              .unit = "g",
                                              .scales = k16495Forces,
                                              .bias_stability = 3.2,
                                              .place = kTable1}};
constexpr std::array k16500{SensorSheet{.quantity = Quantity::AngularRate,
                                        .unit = "deg/s",
                                        .scales = kRates3,
                                        .random_walk = 0.29,
                                        .bias_stability = 8.1,
                                        .place = kTable1},
                            SensorSheet{.quantity = Quantity::SpecificForce,
                                        .unit = "m/s^2",
                                        .scales = kForces392,
                                        .bias_stability = 12.75,  // 125 um/s^2
                                        .place = kTable1}};

constexpr std::string_view kAdi = "Analog Devices";
constexpr std::array<std::string_view, 1> k16400{"ADIS16400"};

constexpr std::array kSheets{
    DataSheet{"ADIS16405", kAdi, "ADIS16400/ADIS16405 Data Sheet", "B", k16400, k16405},
    DataSheet{"ADIS16448", kAdi, "ADIS16448 Data Sheet", "H", {}, k16448},
    DataSheet{"ADIS16465", kAdi, "ADIS16465 Data Sheet", "C", {}, k16465},
    DataSheet{"ADIS16465-1", kAdi, "ADIS16465 Data Sheet", "C", {}, k16465Model1},
    DataSheet{"ADIS16465-2", kAdi, "ADIS16465 Data Sheet", "C", {}, k16465Model2},
    DataSheet{"ADIS16465-3", kAdi, "ADIS16465 Data Sheet", "C", {}, k16465Model3},
    DataSheet{"ADIS16470", kAdi, "ADIS16470 Data Sheet", "A", {}, k16470},
    DataSheet{"ADIS16495-1", kAdi, "ADIS16495 Data Sheet", "C", {}, k16495Model1},
    DataSheet{"ADIS16500", kAdi, "ADIS16500 Data Sheet", "", {}, k16500},
};

}  // namespace

std::span<const DataSheet> analog_devices_sheets() { return kSheets; }

}  // namespace driftlab
