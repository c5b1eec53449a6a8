#pragma once
/// The cells of a parameter table: one parameter of one recording or of several, in the units people write.
#include "core/signal/condition.hpp"
#include "schema/json/json.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace driftlab {

struct Cell {
  std::optional<double> value;
  std::optional<double> low;  ///< of the 95 % interval; nothing: open
  std::optional<double> high;
  std::string unit;
  std::string reason;  ///< why there is no value
};

using Cells = std::vector<std::pair<std::string, Cell>>;  ///< key -> cell, in document order

/// N B K Q R of a channel document. A cell without a value has the unit that the parameter would have in this channel.
[[nodiscard]] Cells allan_cells(const Json& channel);

/// `white_noise.N`, `gauss_markov_1.sigma`, ...: kinds that may repeat always carry a number. `channel_unit`: symbol of
/// the unit of the channel that was fitted; with the declaration of the process it gives the unit of a cell without a
/// value, which is empty where either is not known.
[[nodiscard]] Cells model_cells(const Json& fit, const std::string& channel_unit);

/// The fit of that model in a document with `fits`, or nullptr.
[[nodiscard]] const Json* find_fit(const Json& document, const std::string& model);

/// Half-width of the interval on the log scale; the wider side where they differ. Nothing where an end is open.
[[nodiscard]] std::optional<double> log_half_width(const Cell& cell);

/// Replicates of one condition from their intervals alone: weighted mean of logs, weights 1/half-width^2. One
/// identified replicate stands alone. `replicates` is not empty.
[[nodiscard]] Cell averaged(const std::vector<Cell>& replicates);

/// Cochran's Q of the same: statistic and degrees of freedom that this parameter adds to a test of agreement.
struct Scatter {
  double statistic = 0.0;
  int dof = 0;
};
[[nodiscard]] Scatter scatter_of(const std::vector<Cell>& replicates);

/// `up`, `down` or `none` where the two intervals decide at 5 %; null where either is open.
[[nodiscard]] Json change_between(const Cell& first, const Cell& now);

/// Order of conditions in tables: static first, then by kind, axis and value.
[[nodiscard]] bool comes_before(const Condition& a, const Condition& b);

}  // namespace driftlab
