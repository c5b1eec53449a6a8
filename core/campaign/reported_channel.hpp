#pragma once
/// The stored characterisation of a channel, in the units in which people read it.
///
/// A channel's characterisation is computed in SI (core/fit/characterisation.hpp). Results are stored in other units:
/// the curves in the channel's own unit, the parameters in those of the field (deg/sqrt(h), ug/sqrt(Hz)). Everything
/// that combines several recordings is computed from stored results: pooled fits, parameter tables, trends. These types
/// hold what such a computation needs. They are made from a characterisation (below) or read from a stored document
/// (schema/json/reported_channel.hpp), and both ways give the same numbers to the bit, so that a table does not depend
/// on whether its results were stored in between.
#include "core/fit/characterisation.hpp"
#include "core/signal/recording.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace driftlab {

/// A number with its unit and 95 % interval, or the reason why there is none.
struct ReportedValue {
  std::optional<double> value;
  std::optional<double> low;   ///< of the interval; empty: the data do not bound it there
  std::optional<double> high;  ///< likewise
  std::string unit;            ///< may be empty where there is no value
  std::string reason;          ///< why there is no value

  friend bool operator==(const ReportedValue&, const ReportedValue&) = default;
};

/// Values by name, in the order in which they are shown.
using ReportedValues = std::vector<std::pair<std::string, ReportedValue>>;

struct ReportedProcess {
  std::string process;        ///< registry name: `white_noise`, `gauss_markov`, ...
  ReportedValues parameters;  ///< `N`, `sigma`, `beta`, ...

  friend bool operator==(const ReportedProcess&, const ReportedProcess&) = default;
};

/// A ModelFit (core/fit/characterisation.hpp) as it is told. Figures that are not finite are NaN.
struct ReportedFit {
  std::string model;
  bool robust = false;
  std::vector<ReportedProcess> processes;
  double objective = 0.0;
  double wic = 0.0;
  double equation_8 = 0.0;
  double optimism = 0.0;
  double condition_number = 1.0;
  std::vector<std::string> bounds_active;
  std::string intervals;
  bool plausible = false;
  std::optional<JTest> j_test;
  std::string verdict;            ///< `accepted`, `described`, `not_described`, `untested`; empty: not stored
  double described_within = 0.0;  ///< relative error of the variances that the model leaves
  std::string status;
  std::vector<std::string> warnings;

  /// Whether it was tested and stands.
  [[nodiscard]] bool fits() const { return j_test && stands_at(j_test->p); }
};

/// The Haar wavelet variances of a channel [channel unit^2].
struct ReportedHaar {
  std::vector<std::size_t> scale;         ///< filter length in samples, rising
  std::vector<double> variance;           ///< 0 where it is not known
  std::vector<double> efficiency;         ///< of each, 1 where it is not known; empty: all 1
  std::vector<double> edf;                ///< degrees of freedom of each, 0 where they are not known
  std::vector<double> robust_variance;    ///< 0 where the estimator has no root; empty: not estimated
  std::vector<double> robust_efficiency;  ///< as `efficiency`

  friend bool operator==(const ReportedHaar&, const ReportedHaar&) = default;
};

struct ReportedChannel {
  std::string channel;   ///< the file's column
  std::string quantity;  ///< `angular_rate`, ...
  std::string axis;      ///< empty where it has none
  std::string unit;      ///< symbol of the channel's own unit
  std::size_t samples = 0;
  std::size_t missing = 0;
  double dt_s = 0.0;
  ReportedHaar haar;
  std::string contamination;      ///< verdict: `clean`, `contaminated`, `undecided`; empty: not tested
  ReportedValues allan;           ///< N B K Q R of IEEE Std 952
  double discrepancy = 0.0;       ///< of the curve from every candidate; 0 where one is accepted
  double from_tau_s = 0.0;        ///< models were fitted to the scales of tau from here on
  std::vector<ReportedFit> fits;  ///< best first
  std::string description;        ///< what describes the curve, where there is something to say (CurveDescription)

  /// Gross errors move the variances: the robust ones stand for it.
  [[nodiscard]] bool contaminated() const { return contamination == "contaminated"; }
  /// Of the channel; `1` where its symbol is not known.
  [[nodiscard]] Unit parsed_unit() const;
};

/// A fit of a channel measured in `unit`.
[[nodiscard]] ReportedFit reported(const ModelFit& fit, const Unit& unit);

/// The coefficients N B K Q R of a channel of that dimension.
[[nodiscard]] ReportedValues reported(const AllanParameters& parameters, Dimension dimension);

/// The whole channel. `column`, `role`: who it is; a role without a unit counts as `1`.
[[nodiscard]] ReportedChannel reported(const std::string& column, const ColumnRole& role,
                                       const ChannelCharacterisation& channel);

/// The fit of that model, or nullptr.
[[nodiscard]] const ReportedFit* find_fit(const std::vector<ReportedFit>& fits, const std::string& model);

}  // namespace driftlab
