#pragma once
/// The knob of one element of the gyroscope's error matrix: the part of a rate about the axis `Column` that the axis
/// `Row` reads.
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {

template <int Row, int Column>
constexpr Knob gyroscope_error(std::string_view parameter, std::string_view title, std::string_view told_apart) {
  return {.parameter = parameter,
          .title = title,
          .unit = "%",
          .per_si = 100.0,
          .step = 0.005,
          .most = 0.3,
          .turn = [](FilterOptions& o, double by) { o.errors.gyroscope(Row, Column) += by; },
          .value = [](const FilterOptions& o) { return o.errors.gyroscope(Row, Column); },
          .told_apart = told_apart};
}

}  // namespace driftlab::drive
