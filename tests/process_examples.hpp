#pragma once
/// Processes of a kind at which suites that walk the registry test it.
#include "core/process/process.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace driftlab {

/// A shape that a suite asks for, or, where the parameter has no such values, a place within the range in which a
/// record of 64 samples can tell it.
inline double shape_at(const ProcessKind& kind, std::size_t k, double wanted, double share, double dt_s) {
  if (kind.parameters[k + 1].second_power_halves == -2) {  // a rate or a frequency
    return wanted;
  }
  const auto [low, high] = kind.shape_range(k, dt_s, 64.0);
  return low * std::pow(high / low, share);
}

/// One of level 1.3: rates and frequencies are `rate`, other shapes in the lower part of their range.
inline Process example_of(const ProcessKind& kind, double rate, double dt_s) {
  Process process{&kind, {1.3}};
  for (std::size_t k = 0; k < kind.shape_count(); ++k) {
    process.parameters.push_back(shape_at(kind, k, rate, 0.27, dt_s));
  }
  return process;
}

/// Several of level 1.3: every combination of four values of each shape, rates and frequencies from 0.07 to 40 per
/// second.
inline std::vector<Process> examples_of(const ProcessKind& kind, double dt_s) {
  std::vector<Process> all{{&kind, {1.3}}};
  for (std::size_t k = 0; k < kind.shape_count(); ++k) {
    std::vector<Process> longer;
    for (const Process& shorter : all) {
      for (const auto& [rate, share] : {std::pair{0.07, 0.1}, {1.3, 0.33}, {11.0, 0.64}, {40.0, 0.93}}) {
        longer.push_back(shorter);
        longer.back().parameters.push_back(shape_at(kind, k, rate, share, dt_s));
      }
    }
    all = std::move(longer);
  }
  return all;
}

}  // namespace driftlab
