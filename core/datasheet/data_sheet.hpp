#pragma once
/// What manufacturers state of their inertial sensors, as facts with their source.
///
/// A data sheet gives typical figures at room temperature: a density of white noise, sometimes a random walk and an
/// in-run bias stability, the full scales that can be chosen with the meaning of one count, bandwidths and output
/// rates. A member that is absent is not stated there, or was not at hand when the entry was written; nothing is
/// guessed. Figures are in the unit of the data sheet, for that is how they are checked against it; `stated` converts.
///
/// To add a sensor: an entry in core/datasheet/sheets/<manufacturer>.cpp (a new manufacturer is a file there and a line
/// in registry.cpp). The law suite in tests/unit/datasheet holds every entry to its unit, its counts and, where both a
/// density and a random walk are stated, to both.
#include "core/signal/quantity.hpp"
#include "core/signal/result.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// A full scale that can be chosen: readings from -limit to +limit.
struct FullScale {
  double limit = 0.0;                              ///< [unit of the sensor]
  std::optional<double> per_count = std::nullopt;  ///< what one count means [unit]; empty: not stated
};

struct StatedSpan {
  double lowest = 0.0;
  double highest = 0.0;
};

/// The figures of a gyroscope or an accelerometer.
struct SensorSheet {
  Quantity quantity = Quantity::AngularRate;
  std::string_view unit;                                 ///< `deg/s`, `g` or `m/s^2`
  std::span<const FullScale> scales;                     ///< rising
  std::optional<double> noise_density = std::nullopt;    ///< [unit/sqrt(Hz)] at the smallest full scale
  std::optional<double> noise_density_z = std::nullopt;  ///< of axis z where it differs
  std::optional<double> random_walk = std::nullopt;      ///< of angle [deg/sqrt(h)] or velocity [m/s/sqrt(h)]
  /// In-run bias stability: the least Allan deviation [deg/h] or [ug].
  std::optional<double> bias_stability = std::nullopt;
  std::optional<StatedSpan> bandwidth_hz = std::nullopt;  ///< -3 dB, that can be chosen
  std::optional<StatedSpan> rate_hz = std::nullopt;       ///< of the output
  std::string_view place;                                 ///< table or section
};

struct DataSheet {
  std::string_view name;  ///< as the manufacturer writes it: `MPU-6050`
  std::string_view manufacturer;
  std::string_view document;  ///< number or title
  std::string_view revision;  ///< empty: not noted
  /// Other names of the same sensor. A `*` at the end stands for any order code.
  std::span<const std::string_view> also;
  std::span<const SensorSheet> sensors;  ///< one of a quantity at most

  /// The figures of that quantity, or nullptr.
  [[nodiscard]] const SensorSheet* find(Quantity quantity) const;
  /// `Bosch Sensortec BST-BMI160-DS000-07, revision 0.8`.
  [[nodiscard]] std::string source() const;
};

/// Every data sheet, by manufacturer.
[[nodiscard]] const std::vector<const DataSheet*>& data_sheets();

/// The sensors that a text names, in the order of the list: `phone with LSM6DSO`, `mpu 6050`, `ICM42688P`,
/// `L3G4200D + BMA220`. Case, blanks, hyphens and the like make no difference; what stands before and behind a name
/// must be another word, or behind it an order code of its manufacturer. The longer of two names at one place counts.
[[nodiscard]] std::vector<const DataSheet*> sheets_named_in(std::string_view text);

/// The sheet of that name. Error: NotFound, with what is known: of a name that is cut short (`Xsens MTi`) the longer
/// ones.
[[nodiscard]] Result<const DataSheet*> find_data_sheet(std::string_view name);

/// The sensor of a device, with its document.
struct KnownSensor {
  const DataSheet* sheet = nullptr;
  const SensorSheet* sensor = nullptr;
};

/// The gyroscope or accelerometer of a device from the texts that describe it, most telling first. The first text that
/// names sensors with that quantity decides; nothing where it names two.
[[nodiscard]] std::optional<KnownSensor> known_sensor(std::span<const std::string> texts, Quantity quantity);

/// The stated N of white noise at low frequencies [SI/sqrt(Hz)], two-sided as everywhere in driftlab: the random walk
/// where one is stated, for it is N by definition (IEEE Std 952); else 1/sqrt(2) of the density, which data sheets give
/// one-sided (schema/docs/conventions.md). `axis` may be empty.
[[nodiscard]] std::optional<double> stated_density_si(const SensorSheet& sensor, std::string_view axis);

/// The stated least Allan deviation [SI].
[[nodiscard]] std::optional<double> stated_bias_stability_si(const SensorSheet& sensor);

}  // namespace driftlab
