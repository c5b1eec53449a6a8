#pragma once
/// The joint fit of an extended model's noise: base processes and effects on the noise, in turns.
///
/// The search meets the recordings one effect after another. When it finds that the noise of some samples is louder
/// than that of others, that a few samples are gross, or that the output is rounded, the white level it has in hand was
/// fitted to all of them together and holds what the effect has added. A model that stored this level beside the effect
/// would count the effect twice. So at the end, under an automatic baseline, all that shares in the noise is fitted
/// together, by turns until nothing moves:
///   1. the slow processes, by the likelihood of the block means, in which each block counts by its own white variance;
///   2. the white level, by Whittle's likelihood of the spectra, E = N^2 m_r H + (slow and differenced noise) + v_r,
///      where m_r is the mean square of the white part's factor in recording r, H the gain of a band limit that was
///      found and v_r the density of gross errors and rounding;
///   3. the effects on the level, on innovations under this model.
/// A given baseline is never refitted and skips this step.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

#include <stop_token>
#include <vector>

namespace driftlab::investigate {

/// True where something found has a share in the noise that the base was fitted to.
[[nodiscard]] bool shares_in_noise(const std::vector<Evidence>& found);

/// The noise beside `found`; shapes and parameters of effects on the level are renewed. `data` is the group under the
/// model in hand, of which residuals, model and band limit are used; `mask[r]` removes samples from the grid of member
/// r; `quantization`: Q^2 of the base [SI^2 s^2]. O(iterations samples states).
[[nodiscard]] SlowModel refit_jointly(const FullRate& data, const std::vector<std::vector<unsigned char>>& mask,
                                      double quantization, std::vector<Evidence>& found,
                                      const std::stop_token& stop = {});

}  // namespace driftlab::investigate
