#pragma once
/// A channel group at full rate under the present model: residuals, their innovations, and their spectra.
///
/// The residuals are the error minus the mean effects found so far. The innovations are the one-step prediction errors
/// of the model's Kalman filter (white part and slow states, sample by sample), divided by their standard deviation.
/// Under a right model they are independent and standard normal, so effects on the variance and on the distribution can
/// be read off them. Under an automatic baseline they are whitened once more by an autoregression fitted to themselves,
/// because recorded noise never follows a model exactly, and remaining correlation must not be mistaken for a change of
/// the noise level.
///
/// Memory: 9 bytes a sample, while the residuals follow from the file. Copies share the samples, so that a part of the
/// data, or the data under another model, costs little.
#include "core/investigate/fullrate/noise_colour.hpp"
#include "core/investigate/fullrate/spectrum.hpp"
#include "core/investigate/slow/slow_model.hpp"
#include "core/investigate/study/study.hpp"

#include <cstddef>
#include <stop_token>
#include <vector>

namespace driftlab::investigate {

struct FullRate {
  const Study* study = nullptr;
  const ChannelGroup* group = nullptr;
  bool given = false;  ///< the baseline is given: its scale is not free
  double dt_s = 0.0;
  double white_share = 1.0;                      ///< of the innovations' variance that the white part drives
  double innovation_sd = 1.0;                    ///< of one innovation [SI]
  double lattice_step = 0.0;                     ///< step of the file's lattice [SI], 0: none seen
  double quantization = 0.0;                     ///< Q^2 of a given baseline [SI^2 s^2]
  std::vector<double> raised;                    ///< per member, white density of other origin or of findings taken out
  SlowModel model;                               ///< of the samples
  std::vector<Series> residual;                  ///< per member, over its analysed part
  std::vector<Series> innovation;                ///< likewise; numbers of their own
  std::vector<std::vector<unsigned char>> used;  ///< innovation is meaningful
  std::vector<Spectrum> spectrum;                ///< of the residuals; empty where gaps would show
  std::vector<std::vector<double>> slow;         ///< expected periodogram of the slow part, per bin
  bool flat = true;  ///< white + slow describes the spectra; false: compare recordings with each other instead
  /// Where no model describes the spectra, gains of contrasts between recordings of n samples are divided by
  /// 1 + 2 n kLevelRepeats^2 (study/measured_constants.hpp): a sensor does not repeat its noise level to 1/sqrt(2 n).
  /// 1 elsewhere.
  double repeatability = 1.0;
  std::vector<double> further;  ///< coefficients of the autoregression that whitens once more; empty: none
  NoiseColour colour;           ///< that has been found; its peaks are part of `slow`
  std::stop_token stop;         ///< once it is asked, loops end early and what they give counts for nothing

  [[nodiscard]] std::size_t members() const { return group->members.size(); }
  [[nodiscard]] bool stopped() const { return stop.stop_requested(); }
};

struct FullRateOptions {
  bool given = false;
  bool whiten_further = true;
  double quantization = 0.0;  ///< Q^2 of a given baseline [SI^2 s^2]; the innovations then need whiten_further
  double lattice_step = 0.0;
  NoiseColour colour = {};  ///< needs whiten_further
  bool innovations = true;  ///< false: the spectra alone, and what follows from them
  std::stop_token stop = {};
};

/// `residual[r]`: over the analysed part of member r; `mask[r]`: over its grid, removes samples (may be empty).
[[nodiscard]] FullRate look_at_full_rate(const Study& study, const ChannelGroup& group, const SlowModel& model,
                                         std::vector<Series> residual,
                                         const std::vector<std::vector<unsigned char>>& mask,
                                         const FullRateOptions& options);

/// Sets `spectrum` and `slow` of member r from its residual, gaps filled (gaps.hpp); power is divided by what `raised`
/// has added to the density. `f_low_hz`: the lowest frequency.
void set_spectrum(FullRate& data, std::size_t r, double f_low_hz = 0.3);
/// The same for a member that has a spectrum already.
void renew_spectrum(FullRate& data, std::size_t r);

/// Recordings of a group by scope: all members, and those that move.
[[nodiscard]] std::vector<std::size_t> all_members(const ChannelGroup& group);
[[nodiscard]] std::vector<std::size_t> moving_members(const ChannelGroup& group);

/// The scopes in which an effect on the noise may act: all recordings (under a given baseline only), those that move,
/// and each single one. An automatic baseline describes the recordings at rest. If only one recording is at rest, that
/// one is not a scope of its own, since it is not the one that differs from the others.
[[nodiscard]] std::vector<std::vector<std::size_t>> noise_scopes(const ChannelGroup& group, bool given);

}  // namespace driftlab::investigate
