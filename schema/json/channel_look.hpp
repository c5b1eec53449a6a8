#pragma once
/// The views of a channel as documents: densities and widths in the channel's own unit.
#include "core/analysis/channel_look.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json spectrum_to_json(const ChannelLook& look, const BinnedSpectrum& spectrum);
/// Nothing to draw (more than half of the values are equal): `sigma` is null, with the reason, and there are no counts.
[[nodiscard]] Json histogram_to_json(const ChannelLook& look, const std::optional<RobustHistogram>& histogram);
/// Decadic logarithms of the ratios, to three digits: what a colour shows.
[[nodiscard]] Json spectrogram_to_json(const ChannelLook& look, const ChannelLook::Ratio& ratio);

}  // namespace driftlab
