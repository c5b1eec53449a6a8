#pragma once
/// How each parameter of a table moves with the dynamics (core/campaign/trends.hpp).
///
/// Every column of a parameter table is followed against |rate|, over the table's static and constant-rate rows, and
/// against |angular acceleration|, over its static and constant-angular-acceleration rows, wherever two such rows
/// identify it. So is the density N of rate at low frequencies, whatever the model, under the key `N`. Values keep the
/// unit of their column; the abscissa is in deg/s or deg/s^2. Rows marked as contaminated without robust values, and
/// rows whose recordings disagree, take part; the marks are kept with their points.
#include "core/campaign/parameter_table.hpp"
#include "core/campaign/trends.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// What a parameter is followed against.
enum class Dynamics { Rate, AngularAcceleration };

/// `rate`, `angular_acceleration`.
[[nodiscard]] std::string_view name_of(Dynamics dynamics);
/// `deg/s`, `deg/s^2`.
[[nodiscard]] std::string_view unit_of(Dynamics dynamics);

/// A row that takes part.
struct TrendTablePoint {
  std::string label;
  double at = 0.0;    ///< in the unit of the dynamics
  Estimate estimate;  ///< in the unit of the column
  std::string contamination;
  bool robust = false;
};

/// A row that does not identify the parameter.
struct LeftOutPoint {
  std::string label;
  double at = 0.0;
  std::string reason;
};

struct ColumnTrend {
  TableColumn column;
  Dynamics against = Dynamics::Rate;
  std::vector<TrendTablePoint> points;  ///< in the order of the table's rows
  std::vector<LeftOutPoint> left_out;
  Trend trend;
};

struct TrendTable {
  std::string device;
  Quantity quantity = Quantity::AngularRate;
  std::string axis;
  TableMethod method = TableMethod::Gmwm;
  std::string model;
  std::vector<ColumnTrend> trends;  ///< against the rate first; N, then the columns in their order
};

[[nodiscard]] TrendTable build_trends(const ParameterTable& table);

/// The relation as people write it, for example `1.2 +0.034 w^0.5`: w is in the unit of the abscissa.
[[nodiscard]] std::string formula(const FittedRelation& relation);

/// What the two tests say, as a sentence.
[[nodiscard]] std::string statement(const Trend& trend);

}  // namespace driftlab
