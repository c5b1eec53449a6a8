#pragma once
/// How warm a recording says it was, by its own temperature column.
///
/// A sensor's noise and bias follow its temperature, so that recordings which are far apart in it cannot show what a
/// change of firmware did. The median stands for the recording and the 5 % and 95 % quantiles for its range: a few
/// cells that mean "missing" (0, -9999) move neither.
#include "core/signal/recording_view.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>

namespace driftlab {

/// Over the analysed rows [degC].
struct MeasuredTemperature {
  std::string column;  ///< of the file
  double median_degc = 0.0;
  double low_degc = 0.0;   ///< 5 % quantile
  double high_degc = 0.0;  ///< 95 % quantile
};

/// Of the rows that `view` analyses; `column(i)` gives column i of the file in its own unit, as for view_recording.
/// Nothing if there is no temperature column, if its unit is not stated (a count has no temperature), or if it holds no
/// number. At most about 65,536 rows, evenly spread, are looked at, in as much memory.
[[nodiscard]] std::optional<MeasuredTemperature> measured_temperature(
    const RecordingSpec& spec, const ColumnNames& names, const RecordingView& view,
    const std::function<std::span<const double>(std::size_t)>& column);

}  // namespace driftlab
