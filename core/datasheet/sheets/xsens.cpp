#include "core/datasheet/data_sheet.hpp"

#include <array>

namespace driftlab {
namespace {

constexpr std::array kRates300{FullScale{300.0}};
constexpr std::array kRates450{FullScale{450.0}};
constexpr std::array kRates2000{FullScale{2000.0}};
constexpr std::array kForces17{FullScale{17.0}};
constexpr std::array kForces50{FullScale{50.0}};
constexpr std::array kForces10g{FullScale{10.0}};
constexpr std::array kForces16g{FullScale{16.0}};

constexpr SensorSheet kFirstGyroscope{
    .quantity = Quantity::AngularRate, .unit = "deg/s", .scales = kRates300, .noise_density = 0.05, .place = "table 1"};
constexpr std::array kFirstMti{kFirstGyroscope, SensorSheet{.quantity = Quantity::SpecificForce,
                                                            .unit = "m/s^2",
                                                            .scales = kForces50,
                                                            .noise_density = 0.002,
                                                            .place = "table 1"}};
/// Its accelerometer is another: the full scale of the first MTi stands in the name.
constexpr std::array kFirstMtiOf17{kFirstGyroscope, SensorSheet{.quantity = Quantity::SpecificForce,
                                                                .unit = "m/s^2",
                                                                .scales = kForces17,
                                                                .noise_density = 0.002,
                                                                .place = "table 1 and its amendments"}};
/// Noise and bias stability differ between the hardware revisions of the series, which the name does not tell.
constexpr std::array kMti1Series{
    SensorSheet{
        .quantity = Quantity::AngularRate, .unit = "deg/s", .scales = kRates2000, .place = "sensor specifications"},
    SensorSheet{
        .quantity = Quantity::SpecificForce, .unit = "g", .scales = kForces16g, .place = "sensor specifications"}};
constexpr std::array kMti10Series{SensorSheet{.quantity = Quantity::AngularRate,
                                              .unit = "deg/s",
                                              .scales = kRates450,
                                              .noise_density = 0.03,
                                              .bias_stability = 18.0,
                                              .place = "sensor specifications"}};
constexpr std::array kMti100Series{SensorSheet{.quantity = Quantity::AngularRate,
                                               .unit = "deg/s",
                                               .scales = kRates450,
                                               .noise_density = 0.01,
                                               .bias_stability = 10.0,
                                               .place = "sensor specifications"}};
constexpr std::array kMti600Series{SensorSheet{.quantity = Quantity::AngularRate,
                                               .unit = "deg/s",
                                               .scales = kRates2000,
                                               .noise_density = 0.007,
                                               .bias_stability = 8.0,
                                               .place = "sensor specifications"},
                                   SensorSheet{.quantity = Quantity::SpecificForce,
                                               .unit = "g",
                                               .scales = kForces10g,
                                               .noise_density = 60e-6,
                                               .place = "sensor specifications"}};

using Names = std::string_view;
constexpr std::array<Names, 2> kFirstNames{"MTi-28A53G35*", "MTx-28A53G35*"};
constexpr std::array<Names, 2> kFirstNamesOf17{"MTi-28A33G35*", "MTx-28A33G35*"};
constexpr std::array<Names, 5> kOneNames{"MTi-1", "MTi-2", "MTi-3", "MTi-7", "MTi-8"};
constexpr std::array<Names, 3> kTenNames{"MTi-10", "MTi-20", "MTi-30"};
constexpr std::array<Names, 5> kHundredNames{"MTi-100", "MTi-200", "MTi-300", "MTi-G-700", "MTi-G-710"};
constexpr std::array<Names, 10> kSixHundredNames{"MTi-610",  "MTi-620",  "MTi-630",  "MTi-670",  "MTi-680",
                                                 "MTi-610R", "MTi-620R", "MTi-630R", "MTi-670G", "MTi-680G"};

constexpr std::array kSheets{
    DataSheet{"MTi-28A53G35", "Xsens", "MT0100P, MTi and MTx User Manual", "N", kFirstNames, kFirstMti},
    DataSheet{"MTi-28A33G35", "Xsens", "MT0100P, MTi and MTx User Manual", "N", kFirstNamesOf17, kFirstMtiOf17},
    DataSheet{"MTi 1-series", "Xsens", "MT0512P, MTi 1-series Data Sheet", "", kOneNames, kMti1Series},
    DataSheet{"MTi 10-series", "Xsens", "MT0605P, MTi User Manual", "2019.A", kTenNames, kMti10Series},
    DataSheet{"MTi 100-series", "Xsens", "MT0605P, MTi User Manual", "2019.A", kHundredNames, kMti100Series},
    DataSheet{"MTi 600-series", "Xsens", "MTi 600-series Data Sheet", "", kSixHundredNames, kMti600Series},
};

}  // namespace

std::span<const DataSheet> xsens_sheets() { return kSheets; }

}  // namespace driftlab
