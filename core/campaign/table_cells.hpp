#pragma once
/// The cells of a parameter table: one parameter of one recording or of several, in the units people write.
///
/// Model of replicates: y_i = ln value_i is Gaussian about one common value, with the standard deviation that the 95 %
/// interval of each states: its half-width on the log scale is 1.96 sd, the wider side where the two differ. Error
/// parameters are positive, so logarithms are their scale. The mean is weighted by 1/sd^2, and Cochran's Q (Cochran
/// 1954), the weighted squares about it, says whether one value serves all: chi-square with n - 1 degrees of freedom.
#include "core/campaign/reported_channel.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// N B K Q R of a channel. A cell without a value has the unit that the parameter would have in this channel; empty
/// where the unit of the channel is not known.
[[nodiscard]] ReportedValues allan_cells(const ReportedChannel& channel);

/// `white_noise.N`, `gauss_markov_1.sigma`, ...: kinds that may repeat always carry a number. `channel_unit`: symbol of
/// the unit of the channel that was fitted; with the declaration of the process it gives the unit of a cell without a
/// value, which is empty where either is not known.
[[nodiscard]] ReportedValues model_cells(const ReportedFit& fit, const std::string& channel_unit);

/// Half-width of the interval on the log scale; the wider side where they differ. Nothing where an end is open.
[[nodiscard]] std::optional<double> log_half_width(const ReportedValue& cell);

/// Replicates of one condition from their intervals alone: weighted mean of logs, weights 1/half-width^2. One
/// identified replicate stands alone. `replicates` is not empty.
[[nodiscard]] ReportedValue averaged(const std::vector<ReportedValue>& replicates);

/// Cochran's Q of the same: statistic and degrees of freedom that this parameter adds to a test of agreement.
struct Scatter {
  double statistic = 0.0;
  int dof = 0;
};
[[nodiscard]] Scatter scatter_of(const std::vector<ReportedValue>& replicates);

enum class Change { None, Up, Down };

/// `none`, `up`, `down`.
[[nodiscard]] std::string_view name_of(Change change);

/// Whether the two intervals decide at 5 %: the difference of logs against the root of the summed squared half-widths.
/// Nothing where either interval is open.
[[nodiscard]] std::optional<Change> change_between(const ReportedValue& first, const ReportedValue& now);

/// `now` over `reference`, without unit; the interval from both, taken as independent, on the log scale: the half-width
/// is the root of the summed squared half-widths, as for change_between. Without it where either interval is open;
/// without a value where either has none that is greater than zero.
[[nodiscard]] ReportedValue ratio_of(const ReportedValue& now, const ReportedValue& reference);

/// Why a value is absent.
enum class Absence {
  NotIdentifiable,  ///< the data are compatible with none of it, or do not bound it
  NoneFound,        ///< the best fit has none of it
};

/// `not_identifiable`, `none_found`.
[[nodiscard]] std::string_view name_of(Absence absence);

/// From the reason that a fit gives (core/fit/fit_report.hpp), which is all that is stored of it.
[[nodiscard]] Absence absence_of(std::string_view reason);

}  // namespace driftlab
