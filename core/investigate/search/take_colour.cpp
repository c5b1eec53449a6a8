#include "core/investigate/search/take_colour.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/search/candidates.hpp"
#include "core/investigate/search/hold_out.hpp"
#include "core/investigate/search/take_out.hpp"
#include "core/investigate/search/thresholds.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace driftlab::investigate {
namespace {

/// Rounds in which a colour is sought. Chosen, not measured.
constexpr int kMostColours = 4;
constexpr double kApart = 1.5;  ///< what a peak leaves within this factor of its frequency is its own shape

bool is_colour(const Cause& cause, const FullRate& data) {
  return cause.as<SpectralPeak>() != nullptr || (cause.as<BandLimit>() != nullptr && !data.colour.band_limited());
}

/// Means over a block of coloured noise are correlated with their neighbours, which an automatic baseline describes by
/// a Gauss-Markov process about as fast as the blocks. The data under the model without it, its density white noise
/// again; nothing where the model has none.
std::optional<FullRate> without_fast_process(const FullRate& data) {
  constexpr double kFast = 2.0;  // [1/s], of blocks of about 1/5 s
  const auto fast = [](const SlowComponent& c) {
    return c.process.kind == &registered<GaussMarkov>() && c.process.only_shape() > kFast;
  };
  SlowModel plain = data.model;
  for (const SlowComponent& component : plain.components) {
    plain.white += fast(component) ? 2.0 * component.process.square() / component.process.only_shape() : 0.0;
  }
  if (std::erase_if(plain.components, fast) == 0) {
    return std::nullopt;
  }
  FullRate without = data;
  without.model = std::move(plain);
  for (std::size_t r = 0; r < without.members(); ++r) {
    renew_spectrum(without, r);
  }
  return without;
}

/// A peak beside one that has been found: no process is exactly of second order.
bool is_left_over(const Evidence& evidence, const std::vector<Evidence>& found) {
  return std::any_of(found.begin(), found.end(), [&](const Evidence& earlier) {
    return evidence.cause->as<SpectralPeak>() != nullptr && earlier.cause->as<SpectralPeak>() != nullptr &&
           evidence.shape < kApart * earlier.shape && earlier.shape < kApart * evidence.shape;
  });
}

/// What a cause sees in the data.
std::vector<Evidence> seen(const Cause& cause, const FullRate& data) {
  std::vector<Evidence> found = examine_of(cause)(data);
  for (Evidence& evidence : found) {
    evidence.cause = &cause;
  }
  return found;
}

bool is_clear(const std::vector<Evidence>& found) {
  const Evidence* const best = strongest(found);
  return best != nullptr && best->score >= kThreshold;
}

struct SeenColour {
  Evidence evidence;
  FullRate data;  ///< under which it was seen
};

/// The strongest colour in the data; what every cause of a colour saw is noted.
std::optional<SeenColour> strongest_colour(const ColourSetting& setting, const FullRate& data, GroupOutcome& outcome) {
  const std::optional<FullRate> without = setting.given ? std::nullopt : without_fast_process(data);
  std::optional<SeenColour> best;
  for (const Cause& cause : cause_registry()) {
    if (!is_colour(cause, data) || data.stopped()) {
      continue;
    }
    std::vector<Evidence> found = without ? seen(cause, *without) : std::vector<Evidence>{};
    const FullRate* const plain = without && is_clear(found) ? &*without : nullptr;
    const FullRate& under = plain != nullptr ? *plain : data;
    if (plain == nullptr) {
      found = seen(cause, data);
    }
    std::erase_if(found, [&](const Evidence& evidence) { return is_left_over(evidence, outcome.found); });
    keep_best(outcome.examined, found);
    keep_last(outcome.remaining, found, [&](const Cause& other) { return &other == &cause; });
    const Evidence* const top = strongest(found);
    if (top != nullptr && top->score >= kThreshold && (!best || top->score > best->evidence.score)) {
      best = SeenColour{*top, under};
    }
  }
  return best;
}

/// The colours of the data and one more: a peak beside those that are there, or the band limit.
NoiseColour one_more(const FullRate& data, const Evidence& found) {
  NoiseColour colour = data.colour;
  if (const auto* peak = found.cause->as<SpectralPeak>()) {
    colour.peak = [before = colour.peak, density = peak->density, found, dt_s = data.dt_s](std::size_t r, double f) {
      const bool acts = std::find(found.members.begin(), found.members.end(), r) != found.members.end();
      return (before ? before(r, f) : 0.0) + (acts ? density(found, f, dt_s) : 0.0);
    };
    colour.peak_hz = colour.peak_hz > 0.0 ? std::min(colour.peak_hz, found.shape) : found.shape;
  } else {
    colour.corner_hz = found.shape;
  }
  return colour;
}

/// The white level that is integrated, of data with these colours.
double white_beside(const NoiseColour& colour, FullRate data) {
  data.colour = colour;
  for (std::size_t r = 0; r < data.members(); ++r) {
    renew_spectrum(data, r);
  }
  return colour.band_limited() ? white_below(data, colour.corner_hz) : white_at_full_rate(data, colour.flat_below_hz());
}

/// The data with one more colour in the model.
void take(const ColourSetting& setting, const SeenColour& top, GroupOutcome& outcome) {
  FullRate& data = outcome.after;
  FullRateOptions options;
  options.given = false;  // the level behind the colour is the autoregression's
  options.quantization = setting.given ? 0.0 : setting.quantization;
  options.lattice_step = setting.lattice_step;
  options.stop = data.stop;
  options.colour = one_more(top.data, top.evidence);
  SlowModel model = top.data.model;
  if (!setting.given) {
    outcome.model.beside.noise = base_of(model, outcome.found);
    const double white = white_beside(options.colour, top.data);
    outcome.model.beside.noise.white = white;
    model.white = options.colour.band_limited() ? model.white : white;
  }
  data = look_at_full_rate(*data.study, *data.group, model, std::move(data.residual), setting.mask, options);
  data.flat = data.flat && !options.colour.band_limited();
  outcome.found.push_back(top.evidence);
}

}  // namespace

SlowModel base_of(SlowModel noise, const std::vector<Evidence>& found) {
  const auto extras = static_cast<std::size_t>(std::count_if(
      found.begin(), found.end(), [](const Evidence& evidence) { return evidence.cause->as<SlowNoise>() != nullptr; }));
  noise.components.resize(noise.components.size() - std::min(extras, noise.components.size()));
  return noise;
}

void take_colours(const ColourSetting& setting, GroupOutcome& outcome) {
  for (int taken = 0; taken < kMostColours && !outcome.after.stopped(); ++taken) {
    std::optional<SeenColour> colour = strongest_colour(setting, outcome.after, outcome);
    if (!colour) {
      return;
    }
    hold_out(colour->data, colour->evidence);
    // A peak that half of the data does not show in the other half is none.
    if (colour->evidence.cause->as<SpectralPeak>() != nullptr && colour->evidence.heldout_gain <= 0.0) {
      return;
    }
    take(setting, *colour, outcome);
  }
}

}  // namespace driftlab::investigate
