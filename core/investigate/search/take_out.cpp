#include "core/investigate/search/take_out.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/fullrate/tails.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// Root mean square of a recording's innovations once `sd` is taken out, against that of the others; gross ones are
/// cut at five.
double level_left(const FullRate& data, std::size_t member, const std::vector<double>& sd) {
  std::array<double, 2> square{};  // the others', the member's own
  std::array<double, 2> count{};
  for (std::size_t r = 0; r < data.members(); ++r) {
    const std::size_t own = r == member ? 1 : 0;
    for (std::size_t i = 0; i < data.innovation[r].size(); ++i) {
      if (data.used[r][i] != 0) {
        const double e = data.innovation[r][i] / (own == 1 ? sd[i] : 1.0);
        square.at(own) += std::min(e * e, 25.0);
        count.at(own) += 1.0;
      }
    }
  }
  const bool known = count[0] > 0.0 && count[1] > 0.0 && square[0] > 0.0 && square[1] > 0.0;
  return known ? std::sqrt(square[1] / count[1] / (square[0] / count[0])) : 1.0;
}

/// Adds to member r a white density of `excess` times the innovations' variance that the spectrum is rid of.
void raise_density(FullRate& data, std::size_t r, double excess) {
  data.raised[r] += excess * data.innovation_sd * data.innovation_sd * data.dt_s;
  renew_spectrum(data, r);
}

void take_out_deviation(FullRate& data, const Evidence& found) {
  const NoiseLevel& effect = *found.cause->as<NoiseLevel>();
  std::vector<double> sd;
  for (std::size_t r = 0; r < data.members(); ++r) {
    effect.deviation(data, found, r, sd);
    const bool free = effect.within_recording && !data.given && found.members.front() == r;
    const double level = free ? level_left(data, r, sd) : 1.0;
    double square = 0.0;
    std::vector<double> divided = data.innovation[r].values();
    for (std::size_t i = 0; i < sd.size(); ++i) {
      divided[i] /= sd[i] * level;
      square += sd[i] * sd[i] * level * level;
    }
    data.innovation[r] = std::move(divided);
    const double excess = square / static_cast<double>(std::max<std::size_t>(1, sd.size())) - 1.0;
    raise_density(data, r, excess);
  }
}

/// With a given level, the variance that the tails add is taken out of the spectra.
void take_out_tails(FullRate& data, const Evidence& found) {
  for (std::size_t r = 0; data.given && r < data.members(); ++r) {
    double square = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < data.innovation[r].size(); ++i) {
      square += data.used[r][i] != 0 ? data.innovation[r][i] * data.innovation[r][i] : 0.0;
      count += data.used[r][i] != 0 ? 1.0 : 0.0;
    }
    raise_density(data, r, square / std::max(1.0, count) - 1.0);
  }
  to_normal_scores(data, found.cause->as<NoiseTails>()->tail(data, found));
}

}  // namespace

void take_out(FullRate& data, const Evidence& found) {
  if (found.cause->as<NoiseLevel>() != nullptr) {
    take_out_deviation(data, found);
  } else if (found.cause->as<NoiseTails>() != nullptr) {
    take_out_tails(data, found);
  }
}

double white_at_full_rate(const FullRate& data, double below_hz) {
  double sum = 0.0;
  double weight = 0.0;
  for (std::size_t r = 0; r < data.spectrum.size(); ++r) {
    const Spectrum& s = data.spectrum[r];
    for (std::size_t j = 0; j < s.power.size(); ++j) {
      if (data.slow[r][j] < 0.3 * data.model.white && s.f_hz[j] < below_hz) {
        sum += s.weight[j] * (s.power[j] - data.slow[r][j]);
        weight += s.weight[j];
      }
    }
  }
  return weight > 0.0 && sum > 0.0 ? sum / weight : data.model.white;
}

double white_below(const FullRate& data, double corner_hz) {
  double sum = 0.0;
  double weight = 0.0;
  for (std::size_t r = 0; r < data.spectrum.size(); ++r) {
    const Spectrum& s = data.spectrum[r];
    for (std::size_t j = 0; j < s.power.size() && s.f_hz[j] < 0.5 * corner_hz; ++j) {
      sum += s.weight[j] * (s.power[j] - data.slow[r][j]) / butterworth_gain(s.f_hz[j], corner_hz, data.dt_s);
      weight += s.weight[j];
    }
  }
  return weight > 0.0 && sum > 0.0 ? sum / weight : data.model.white;
}

std::vector<double> white_scale_of(const FullRate& data) {
  std::vector<double> scale(data.members(), 1.0);
  bool any = false;
  for (std::size_t r = 0; r < data.members(); ++r) {
    double sum = 0.0;
    double weight = 0.0;
    const Spectrum& s = data.spectrum[r];
    for (std::size_t j = 0; j < s.power.size(); ++j) {
      if (s.f_hz[j] < 0.125 / data.dt_s && data.slow[r][j] < 0.5 * data.model.white) {
        sum += s.weight[j] * (s.power[j] - data.slow[r][j]) / data.model.white;
        weight += s.weight[j];
      }
    }
    if (weight > 50.0 && std::fabs(sum / weight - 1.0) > 2.0 / std::sqrt(weight)) {
      scale[r] = std::clamp(sum / weight, 0.05, 20.0);
      any = true;
    }
  }
  return any ? scale : std::vector<double>{};
}

}  // namespace driftlab::investigate
