#pragma once
/// The same noise level in the conventions of data sheets, spectrum analysers and Kalibr.
///
/// driftlab's N is that of IEEE Std 952: the two-sided density of the rate is N^2, samples at interval dt scatter by
/// N/sqrt(dt), and AV = N^2/tau. Data sheets and spectrum analysers give the one-sided density, which is larger by
/// sqrt(2): 0.05 deg/s/sqrt(Hz) on a data sheet is an angle random walk of 2.1 deg/sqrt(h), not 3.0. Kalibr's
/// continuous-time `noise_density` is N and its `random_walk` is K, both in SI units. The standard deviations that a
/// filter adds per sample are N/sqrt(dt) and K sqrt(dt).
#include "core/fit/characterisation.hpp"
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
/// specific force. For other dimensions only those without a lab unit are given. The first is the one in which results
/// are written.
[[nodiscard]] std::vector<NoiseEquivalent> white_noise_equivalents(Dimension channel, double dt_s);

/// Equivalents of a random-walk level K [channel unit / sqrt(s)].
[[nodiscard]] std::vector<NoiseEquivalent> random_walk_equivalents(Dimension channel, double dt_s);

/// A level of a fitted model with the ways of writing it.
struct LevelEquivalents {
  std::string parameter;  ///< as its process declares it: `N`, `K`
  Estimate level;         ///< SI
  std::vector<NoiseEquivalent> conventions;
};

/// Of every white noise and random walk of a fit whose level is identified, in the order of the model; the other
/// processes have no level in these conventions. `channel` is the dimension of a channel sampled at `dt_s`.
[[nodiscard]] std::vector<LevelEquivalents> level_equivalents(const ModelFit& fit, Dimension channel, double dt_s);

}  // namespace driftlab
