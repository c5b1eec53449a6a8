#pragma once
/// The same noise in the numbers of other books: what a fitted N or K is called, and how large it is there.
///
/// driftlab's N is that of IEEE Std 952: the two-sided density of the rate is N^2, samples at dt scatter by N/sqrt(dt),
/// AV = N^2/tau. Data sheets and spectrum analysers give the one-sided density, which is larger by sqrt(2) (0.05
/// deg/s/sqrt(Hz) on a data sheet is 2.1 deg/sqrt(h) of angle random walk, not 3.0). Kalibr's continuous-time
/// `noise_density` is N in SI units, its `random_walk` is K in SI units; what a filter adds per sample is N/sqrt(dt)
/// and K sqrt(dt).
#include "core/signal/unit.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// One way of writing a level: `value = factor * SI value`.
struct NoiseEquivalent {
  std::string convention;  ///< slug, see schema/docs/conventions.md
  std::string unit;
  double factor = 1.0;
};

/// Equivalents of a white-noise level N [channel unit sqrt(s)] of a channel sampled at dt_s, for angular rate and
/// specific force; only the ones without a lab unit for other dimensions. The first is the one that results are in.
[[nodiscard]] std::vector<NoiseEquivalent> white_noise_equivalents(Dimension channel, double dt_s);

/// Equivalents of a random-walk level K [channel unit / sqrt(s)].
[[nodiscard]] std::vector<NoiseEquivalent> random_walk_equivalents(Dimension channel, double dt_s);

}  // namespace driftlab
