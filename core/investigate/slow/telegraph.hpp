#pragma once
/// A random telegraph beside slow Gaussian noise: block means that jump between +a and -a.
///
/// A telegraph of mean dwell T has the spectrum of a Gauss-Markov process of sigma = a and beta = 2/T, so that no
/// second moment tells the two apart. Its likelihood does: between blocks of length h it changes sides with probability
/// (1 - exp(-2 h/T))/2, and the blocks scatter about two levels instead of one. The side and the slow states of the
/// model are filtered together by two Kalman filters, one for each side, whose estimates are mixed at every block
/// (interacting multiple models, Blom and Bar-Shalom 1988): exact where there is no slow state beside the side, and
/// near it where sides last many blocks. Likelihoods leave out the constant that slow_fit.hpp leaves out, and of no
/// amplitude they are those of the model alone.
#include "core/investigate/slow/block_series.hpp"
#include "core/investigate/slow/slow_model.hpp"

#include <cstddef>
#include <vector>

namespace driftlab::investigate {

struct Telegraph {
  double amplitude = 0.0;  ///< a [SI]
  double dwell_s = 1.0;    ///< T
  double offset = 0.0;     ///< the middle between the two levels, which is the bias of all recordings [SI]
};

/// Log likelihood of the blocks of all recordings.
[[nodiscard]] double telegraph_log_likelihood(const BlockSeries& series, const SlowModel& model,
                                              const Telegraph& telegraph);

/// Maximum over amplitude, dwell time and offset beside a model that stays as it is, and the deviations of the first
/// two by the second derivatives of the log likelihood.
struct TelegraphFit {
  Telegraph telegraph;
  double log_likelihood = 0.0;
  double log_amplitude_sd = 0.0;
  double log_dwell_sd = 0.0;
};
[[nodiscard]] TelegraphFit fit_telegraph(const BlockSeries& series, const SlowModel& model);

/// The best of a coarse grid of amplitudes and dwell times, for a first look; no deviations.
[[nodiscard]] TelegraphFit coarse_telegraph(const BlockSeries& series, const SlowModel& model);

/// A telegraph with the offset that suits the series best, all else as it is.
[[nodiscard]] Telegraph with_best_offset(const BlockSeries& series, const SlowModel& model, Telegraph telegraph);

/// Expected side of every block of recording r, from -1 to 1, seen from both ends.
[[nodiscard]] std::vector<double> telegraph_sides(const BlockSeries& series, const SlowModel& model,
                                                  const Telegraph& telegraph, std::size_t r);

}  // namespace driftlab::investigate
