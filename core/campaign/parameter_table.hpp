#pragma once
/// The parameter table: one sensor axis of one device, a row per dynamic condition, a column per parameter with unit
/// and 95 % interval; the form of Tables 1, 2 and 4 of the seed paper (Radi, Nassar and El-Sheimy 2017).
///
/// Method `av` takes the IEEE 952 coefficients of each channel, method `gmwm` the parameters of one model. Without a
/// model of the caller's choice it is the one with the smallest sum of the criterion over all rows, so that one
/// structure is shown for all conditions. Recordings of one condition are replicates: method gmwm shows their joint fit
/// (`joint`) where a pooled result of exactly these members exists (core/campaign/pooled_sensor.hpp); otherwise, and
/// for method av, their values are averaged on the log scale with weights from their intervals (`average`). `agreement`
/// says whether they agree: the likelihood-ratio test of the joint fit, else Cochran's Q over the parameters shown. A
/// parameter that no replicate identifies has no value, and its reason is given. `change` and `ratio` compare a row
/// with the reference row, which is the first (the static one where there is one) or the one asked for: up or down
/// where the two 95 % intervals say so at 5 % (difference of logs against the root of the summed squared half-widths),
/// none where not, nothing where either is not identified.
#include "core/campaign/pooled_sensor.hpp"
#include "core/campaign/sensor_sources.hpp"
#include "core/campaign/sheet_comparison.hpp"
#include "core/campaign/table_cells.hpp"
#include "core/signal/quantity.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

enum class TableMethod { Av, Gmwm };

[[nodiscard]] std::string_view name_of(TableMethod method);
/// Error: InvalidArgument, field "parameter" = "method".
[[nodiscard]] Result<TableMethod> parse_table_method(std::string_view name);

struct TableRequest {
  std::string device;
  Quantity quantity = Quantity::AngularRate;
  std::string axis;
  TableMethod method = TableMethod::Gmwm;
  std::string model;                                  ///< empty: chosen by the criterion
  std::optional<Condition> reference = std::nullopt;  ///< of the row that others are compared with; nothing: the first
  /// Texts in which the sensor may be named, most telling first: the IMU, the model, the name of the device.
  std::vector<std::string> hardware = {};
};

/// How the values of a row came about.
enum class Pooling {
  Single,   ///< one recording
  Average,  ///< replicates averaged from their intervals
  Joint,    ///< replicates fitted jointly
};

/// `single`, `average`, `joint`.
[[nodiscard]] std::string_view name_of(Pooling pooling);

struct TableColumn {
  std::string key;   ///< `N`, `white_noise.N`, `gauss_markov_1.beta`, ...
  std::string unit;  ///< also where no row identifies the parameter; empty where the channel's unit is not known
};

struct TableCell {
  ReportedValue estimate;                       ///< its unit is that of the row
  std::optional<Change> change = std::nullopt;  ///< against the reference row
  ReportedValue ratio = {};                     ///< to the reference row; without a value in that row itself
};

struct TableRow {
  Condition condition;
  std::string label;  ///< of the condition, for people
  std::vector<std::string> recordings;
  double duration_s = 0.0;  ///< of all of them, as analysed
  std::optional<double> j_test_p =
      {};                     ///< of the one fit shown; nothing where several are averaged, and without a test
  std::string contamination;  ///< worst verdict of the recordings; empty where none has one
  Pooling pooling = Pooling::Single;
  bool robust = false;     ///< the values come from robust variances
  std::size_t frozen = 0;  ///< samples of all recordings that are not analysed because the sensor gave one value only
  std::optional<RecordingAgreement> agreement;
  std::vector<std::string> warnings;  ///< what the fits shown say against themselves, each once
  /// The density N of rate at low frequencies, whatever the model: the averaged coefficients N of the recordings.
  TableCell density;
  std::vector<TableCell> cells;  ///< one per column

  /// Whether the one fit shown stands; nothing where no test says so.
  [[nodiscard]] std::optional<bool> fits() const {
    return j_test_p ? std::optional(stands_at(*j_test_p)) : std::nullopt;
  }
};

struct ParameterTable {
  std::string device;
  Quantity quantity = Quantity::AngularRate;
  std::string axis;
  TableMethod method = TableMethod::Gmwm;
  std::string model;  ///< the one model of all rows; empty for method av
  std::vector<TableColumn> columns;
  std::vector<TableRow> rows;  ///< static first, then by kind and value; at least one
  std::size_t reference = 0;   ///< the row that the others are compared with
  /// Of the first row, where the sensor is known and at rest there.
  std::optional<SheetComparison> data_sheet = std::nullopt;
  /// Whether one structure serves every condition; nothing where that was not asked of exactly these recordings.
  std::optional<PooledStructure> structure = std::nullopt;
  /// How `model` and the structure that `structure` names are both right; empty where they are one.
  std::string model_note = {};
};

/// `pooled`: the pooled result of this sensor axis, or nullptr; entries that are not of these sources are passed over.
/// Where such an entry has no joint fit, its reason is among the row's warnings. Errors: NotFound (no source);
/// InvalidArgument (a model that no source was fitted with; a reference that is no row; sources in units that do not
/// convert into each other, for a column then has no unit).
[[nodiscard]] Result<ParameterTable> build_parameter_table(const TableRequest& request,
                                                           const std::vector<TableSource>& sources,
                                                           const PooledSensor* pooled = nullptr);

}  // namespace driftlab
