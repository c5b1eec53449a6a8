#include "core/datasheet/data_sheet.hpp"

#include <array>

namespace driftlab {
namespace {

constexpr std::array kOldRates{FullScale{250.0, 8.75e-3}, FullScale{500.0, 17.5e-3}, FullScale{2000.0, 70e-3}};
constexpr std::array kLsm9Rates{FullScale{245.0, 8.75e-3}, FullScale{500.0, 17.5e-3}, FullScale{2000.0, 70e-3}};
constexpr std::array kRates{FullScale{125.0, 4.375e-3}, FullScale{250.0, 8.75e-3}, FullScale{500.0, 17.5e-3},
                            FullScale{1000.0, 35e-3}, FullScale{2000.0, 70e-3}};
/// The data sheet of the LSM6DS3 says 245 where later ones say 250, with the same count.
constexpr std::array kLsm6ds3Rates{FullScale{125.0, 4.375e-3}, FullScale{245.0, 8.75e-3}, FullScale{500.0, 17.5e-3},
                                   FullScale{1000.0, 35e-3}, FullScale{2000.0, 70e-3}};
constexpr std::array kFastRates{FullScale{125.0, 4.375e-3}, FullScale{250.0, 8.75e-3}, FullScale{500.0, 17.5e-3},
                                FullScale{1000.0, 35e-3},   FullScale{2000.0, 70e-3},  FullScale{4000.0, 140e-3}};
constexpr std::array kForces{FullScale{2.0, 0.061e-3}, FullScale{4.0, 0.122e-3}, FullScale{8.0, 0.244e-3},
                             FullScale{16.0, 0.488e-3}};
/// The last count of the LSM9DS0 and LSM9DS1 is coarser than the others: so it stands in their tables.
constexpr std::array kLsm9Ds0Forces{FullScale{2.0, 0.061e-3}, FullScale{4.0, 0.122e-3}, FullScale{6.0, 0.183e-3},
                                    FullScale{8.0, 0.244e-3}, FullScale{16.0, 0.732e-3}};
constexpr std::array kLsm9Ds1Forces{FullScale{2.0, 0.061e-3}, FullScale{4.0, 0.122e-3}, FullScale{8.0, 0.244e-3},
                                    FullScale{16.0, 0.732e-3}};

constexpr std::string_view kTable3 = "table 3, mechanical characteristics";
constexpr std::string_view kTable2 = "table 2, mechanical characteristics";

constexpr std::array kL3g4200d{SensorSheet{.quantity = Quantity::AngularRate,
                                           .unit = "deg/s",
                                           .scales = kOldRates,
                                           .noise_density = 0.03,
                                           .rate_hz = StatedSpan{100.0, 800.0},
                                           .place = "table 4, mechanical characteristics"}};
constexpr std::array kL3gd20{SensorSheet{.quantity = Quantity::AngularRate,
                                         .unit = "deg/s",
                                         .scales = kOldRates,
                                         .noise_density = 0.03,
                                         .rate_hz = StatedSpan{95.0, 760.0},
                                         .place = "table 3, mechanical characteristics"}};
constexpr std::array kL3gd20h{SensorSheet{.quantity = Quantity::AngularRate,
                                          .unit = "deg/s",
                                          .scales = kLsm9Rates,
                                          .noise_density = 0.011,
                                          .place = "mechanical characteristics"}};
constexpr std::array kLsm6ds3{
    SensorSheet{.quantity = Quantity::AngularRate,
                .unit = "deg/s",
                .scales = kLsm6ds3Rates,
                .noise_density = 7e-3,
                .place = kTable3},
    SensorSheet{
        .quantity = Quantity::SpecificForce, .unit = "g", .scales = kForces, .noise_density = 90e-6, .place = kTable3}};
constexpr std::array kLsm6ds3trc{
    SensorSheet{
        .quantity = Quantity::AngularRate, .unit = "deg/s", .scales = kRates, .noise_density = 5e-3, .place = kTable3},
    SensorSheet{
        .quantity = Quantity::SpecificForce, .unit = "g", .scales = kForces, .noise_density = 90e-6, .place = kTable3}};
constexpr std::array kLsm6dsl{SensorSheet{.quantity = Quantity::AngularRate,
                                          .unit = "deg/s",
                                          .scales = kRates,
                                          .noise_density = 4e-3,
                                          .rate_hz = StatedSpan{12.5, 6664.0},
                                          .place = kTable3},
                              SensorSheet{.quantity = Quantity::SpecificForce,
                                          .unit = "g",
                                          .scales = kForces,
                                          .noise_density = 80e-6,
                                          .rate_hz = StatedSpan{1.6, 6664.0},
                                          .place = kTable3}};
constexpr std::array kLsm6dso{SensorSheet{.quantity = Quantity::AngularRate,
                                          .unit = "deg/s",
                                          .scales = kRates,
                                          .noise_density = 3.8e-3,
                                          .rate_hz = StatedSpan{12.5, 6664.0},
                                          .place = kTable2},
                              SensorSheet{.quantity = Quantity::SpecificForce,
                                          .unit = "g",
                                          .scales = kForces,
                                          .noise_density = 70e-6,
                                          .rate_hz = StatedSpan{1.6, 6664.0},
                                          .place = kTable2}};
constexpr std::array kLsm6dsv{SensorSheet{.quantity = Quantity::AngularRate,
                                          .unit = "deg/s",
                                          .scales = kFastRates,
                                          .noise_density = 2.8e-3,
                                          .rate_hz = StatedSpan{7.5, 7680.0},
                                          .place = "mechanical characteristics (high-performance mode)"},
                              SensorSheet{.quantity = Quantity::SpecificForce,
                                          .unit = "g",
                                          .scales = kForces,
                                          .noise_density = 60e-6,
                                          .rate_hz = StatedSpan{1.875, 7680.0},
                                          .place = "mechanical characteristics (high-performance mode)"}};
constexpr std::array kLsm9ds0{SensorSheet{.quantity = Quantity::AngularRate,
                                          .unit = "deg/s",
                                          .scales = kLsm9Rates,
                                          .rate_hz = StatedSpan{95.0, 760.0},
                                          .place = "table 3, sensor characteristics"},
                              SensorSheet{.quantity = Quantity::SpecificForce,
                                          .unit = "g",
                                          .scales = kLsm9Ds0Forces,
                                          .rate_hz = StatedSpan{3.125, 1600.0},
                                          .place = "table 3, sensor characteristics"}};
constexpr std::array kLsm9ds1{SensorSheet{.quantity = Quantity::AngularRate,
                                          .unit = "deg/s",
                                          .scales = kLsm9Rates,
                                          .rate_hz = StatedSpan{14.9, 952.0},
                                          .place = "table 3, sensor characteristics"},
                              SensorSheet{.quantity = Quantity::SpecificForce,
                                          .unit = "g",
                                          .scales = kLsm9Ds1Forces,
                                          .rate_hz = StatedSpan{10.0, 952.0},
                                          .place = "table 3, sensor characteristics"}};

constexpr std::string_view kSt = "STMicroelectronics";

constexpr std::array kSheets{
    DataSheet{"L3G4200D", kSt, "Doc ID 17116", "3", {}, kL3g4200d},
    DataSheet{"L3GD20", kSt, "DocID022116", "2", {}, kL3gd20},
    DataSheet{"L3GD20H", kSt, "DocID023469", "2", {}, kL3gd20h},
    DataSheet{"LSM6DS3", kSt, "DocID026899", "8", {}, kLsm6ds3},
    DataSheet{"LSM6DS3TR-C", kSt, "DocID030071", "3", {}, kLsm6ds3trc},
    DataSheet{"LSM6DSL", kSt, "DocID028475", "7", {}, kLsm6dsl},
    DataSheet{"LSM6DSO", kSt, "DS12140", "3", {}, kLsm6dso},
    DataSheet{"LSM6DSOX", kSt, "DS12814", "3", {}, kLsm6dso},
    DataSheet{"LSM6DSV", kSt, "DS13476", "2", {}, kLsm6dsv},
    DataSheet{"LSM6DSV16X", kSt, "DS13510", "4", {}, kLsm6dsv},
    DataSheet{"LSM9DS0", kSt, "DocID024763", "2", {}, kLsm9ds0},
    DataSheet{"LSM9DS1", kSt, "DocID025715", "3", {}, kLsm9ds1},
};

}  // namespace

std::span<const DataSheet> st_sheets() { return kSheets; }

}  // namespace driftlab
