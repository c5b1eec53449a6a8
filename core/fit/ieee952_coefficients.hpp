#pragma once
/// The coefficients of IEEE Std 952 from the best composite models of a curve (core/fit/composite_search.hpp).
///
/// N, the angle or velocity random walk, is the root of the density of rate at low frequencies: the sum of what white
/// noise, band-limited noise and processes faster than five samples have at frequency zero. K is the level of a random
/// walk, or of a Gauss-Markov process whose correlation time is longer than half of the record; B that of flicker
/// noise, with the averaging time at which it takes the largest share of the Allan variance; Q and R those of
/// quantization and drift.
///
/// A coefficient is given where every model that describes the curve as well as the best has it, with the union of
/// their intervals. Five terms fitted to a curve that holds a sixth process give each of them wrong (N 5 to 94 % off
/// beside a Gauss-Markov process, tests/ACCURACY.md), so nothing is given that is not part of a model that describes
/// the curve. Absence is an upper limit, never "none": the level at which L of the best model with the term in it has
/// risen by 2.71 (one-sided, 95 %). Nothing is given where no model describes the curve within 5 %.
#include "core/fit/characterisation.hpp"
#include "core/fit/composite_search.hpp"

namespace driftlab {

/// `unit` is the number of SI units in one unit of the curve; `samples` those of the record.
[[nodiscard]] AllanParameters ieee952_coefficients(const CompositeBasis& basis, const CompositeSearchResult& found,
                                                   double unit);

}  // namespace driftlab
