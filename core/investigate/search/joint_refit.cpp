#include "core/investigate/search/joint_refit.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/fullrate/whittle.hpp"
#include "core/investigate/slow/slow_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace driftlab::investigate {
namespace {

/// Turns of the joint fit. Chosen, not measured.
constexpr int kTurns = 3;

using PerSample = std::vector<std::vector<double>>;

bool acts_in(const Evidence& found, std::size_t r) {
  return std::find(found.members.begin(), found.members.end(), r) != found.members.end();
}

bool scales_everything(const Evidence& found) {
  const NoiseLevel* const level = found.cause->as<NoiseLevel>();
  return level != nullptr && level->scales_slow;
}

/// Variance that gross errors and rounding add to each sample of member r [SI^2].
double added_variance(const std::vector<Evidence>& found, std::size_t r) {
  double sum = 0.0;
  for (const Evidence& evidence : found) {
    const NoiseTails* const tails = evidence.cause->as<NoiseTails>();
    const FileFact* const fact = evidence.cause->as<FileFact>();
    if (!acts_in(evidence, r) || evidence.parameters.empty()) {
      continue;
    }
    if (tails != nullptr && tails->added_variance != nullptr) {
      sum += tails->added_variance(evidence);
    } else if (fact != nullptr && fact->gives_lattice_step) {
      const double step = evidence.parameters[0].estimate.value;
      sum += step * step / 12.0;
    }
  }
  return sum;
}

double differenced_square(const std::vector<Evidence>& found, std::size_t r) {
  double sum = 0.0;
  for (const Evidence& evidence : found) {
    sum += evidence.cause->as<DifferencedNoise>() != nullptr && acts_in(evidence, r) ? evidence.shape : 0.0;
  }
  return sum;
}

/// Deviation of each innovation by the effects on the level, all of them or all but one.
std::vector<double> deviation_of(const FullRate& data, const std::vector<Evidence>& found, std::size_t r,
                                 const Evidence* except = nullptr) {
  std::vector<double> product(data.innovation[r].size(), 1.0);
  std::vector<double> sd;
  for (const Evidence& evidence : found) {
    const NoiseLevel* const level = evidence.cause->as<NoiseLevel>();
    if (level == nullptr || level->scales_slow || &evidence == except) {
      continue;
    }
    level->deviation(data, evidence, r, sd);
    std::transform(product.begin(), product.end(), sd.begin(), product.begin(), std::multiplies<>());
  }
  return product;
}

/// Square of the white part's factor at each sample: an innovation's variance grows by the white part's share alone.
PerSample white_factors(const FullRate& data, const std::vector<Evidence>& found) {
  PerSample factors;
  for (std::size_t r = 0; r < data.members(); ++r) {
    std::vector<double> factor = deviation_of(data, found, r);
    for (double& f : factor) {
      f = std::max(1e-3, 1.0 + (f * f - 1.0) / data.white_share);
    }
    factors.push_back(std::move(factor));
  }
  return factors;
}

/// Block means of the residuals; a block counts for as many samples as its white variance is worth.
BlockSeries weighted_blocks(const FullRate& data, const std::vector<std::vector<unsigned char>>& mask,
                            const std::vector<Series>& residual, const PerSample& factors, BlockColumns& columns) {
  BlockSeries series = average_blocks(*data.group, mask, false);
  columns = BlockColumns::zeros(series, 2);
  for (std::size_t r = 0; r < series.recordings.size(); ++r) {
    BlockRecording& blocks = series.recordings[r];
    blocks.pattern = r;
    for (std::size_t b = 0; b < blocks.mean.size(); ++b) {
      double sum = 0.0;
      double factor = 0.0;
      double count = 0.0;
      for (std::size_t i = b * series.block; i < (b + 1) * series.block; ++i) {
        if (data.used[r][i] != 0) {
          sum += residual[r][i];
          factor += factors[r][i];
          count += 1.0;
        }
      }
      blocks.filled[b] = count > 0.0 ? blocks.filled[b] * count / factor : 0.0;
      blocks.mean[b] = count > 0.0 ? sum / count : 0.0;
      columns.rows[r][2 * b] = blocks.mean[b];
      columns.rows[r][2 * b + 1] = 1.0;
    }
  }
  return series;
}

/// The white level by the spectra beside everything else; the model's own where no recording has a spectrum.
double white_by_spectra(const FullRate& data, const PerSample& factors, const std::vector<Evidence>& found) {
  std::vector<double> power, weight, fixed, shape;
  double mean_factor = 0.0;
  for (std::size_t r = 0; r < data.members(); ++r) {
    const double factor = std::accumulate(factors[r].begin(), factors[r].end(), 0.0) /
                          static_cast<double>(std::max<std::size_t>(1, factors[r].size()));
    mean_factor += factor / static_cast<double>(data.members());
    const double added = added_variance(found, r) * data.dt_s;
    const double differenced = differenced_square(found, r);
    const Spectrum& s = data.spectrum[r];
    for (std::size_t j = 0; j < s.power.size(); ++j) {
      if ((data.colour.band_limited() && s.f_hz[j] > 0.5 * data.colour.corner_hz) ||
          s.f_hz[j] > data.colour.flat_below_hz()) {
        break;
      }
      power.push_back(s.power[j]);
      weight.push_back(s.weight[j]);
      fixed.push_back(data.slow[r][j] + differenced * quantization_shape(s.f_hz[j], data.dt_s) + added);
      shape.push_back(
          factor * (data.colour.band_limited() ? butterworth_gain(s.f_hz[j], data.colour.corner_hz, data.dt_s) : 1.0));
    }
  }
  if (power.empty()) {
    return data.model.white / mean_factor;
  }
  const auto bins = static_cast<Eigen::Index>(power.size());
  LinearDensity density;
  density.power = Eigen::Map<const Eigen::VectorXd>(power.data(), bins);
  density.weight = Eigen::Map<const Eigen::VectorXd>(weight.data(), bins);
  density.fixed = Eigen::Map<const Eigen::VectorXd>(fixed.data(), bins);
  density.shape = Eigen::Map<const Eigen::VectorXd>(shape.data(), bins);
  const double level = fit_levels(density, Eigen::VectorXd::Constant(1, data.model.white / mean_factor)).level[0];
  return level > 0.0 ? level : 0.01 * data.model.white / mean_factor;
}

/// Each effect on the level once more, the others taken out.
void renew_levels(const FullRate& data, std::vector<Evidence>& found) {
  for (Evidence& evidence : found) {
    if (evidence.cause->as<NoiseLevel>() == nullptr || scales_everything(evidence)) {
      continue;
    }
    FullRate rest = data;
    for (std::size_t r = 0; r < rest.members(); ++r) {
      const std::vector<double> others = deviation_of(data, found, r, &evidence);
      std::vector<double> divided = rest.innovation[r].values();
      std::transform(divided.begin(), divided.end(), others.begin(), divided.begin(), std::divides<>());
      rest.innovation[r] = std::move(divided);
    }
    for (const Evidence& fresh : examine_of (*evidence.cause)(rest)) {
      if (fresh.members == evidence.members && !fresh.parameters.empty()) {
        evidence.shape = fresh.shape;
        evidence.parameters = fresh.parameters;
      }
    }
  }
}

}  // namespace

bool shares_in_noise(const std::vector<Evidence>& found) {
  return std::any_of(found.begin(), found.end(), [](const Evidence& evidence) {
    const NoiseTails* const tails = evidence.cause->as<NoiseTails>();
    const FileFact* const fact = evidence.cause->as<FileFact>();
    return evidence.cause->as<NoiseLevel>() != nullptr || evidence.cause->as<DifferencedNoise>() != nullptr ||
           (tails != nullptr && tails->added_variance != nullptr) || (fact != nullptr && fact->gives_lattice_step);
  });
}

SlowModel refit_jointly(const FullRate& data, const std::vector<std::vector<unsigned char>>& mask, double quantization,
                        std::vector<Evidence>& found, const std::stop_token& stop) {
  std::vector<Series> residual = data.residual;
  std::vector<double> sd;
  for (const Evidence& evidence : found) {
    for (std::size_t r = 0; scales_everything(evidence) && r < residual.size(); ++r) {
      evidence.cause->as<NoiseLevel>()->deviation(data, evidence, r, sd);
      std::vector<double> divided = residual[r].values();
      std::transform(divided.begin(), divided.end(), sd.begin(), divided.begin(), std::divides<>());
      residual[r] = std::move(divided);
    }
  }
  FullRateOptions options;
  options.lattice_step = data.lattice_step;
  options.quantization = quantization;
  options.whiten_further = !data.flat || quantization > 0.0 || data.colour.peak;
  options.colour = data.colour;
  options.stop = stop;
  SlowModel model = data.model;
  model.white_scale.clear();
  SlowFreedom freedom;
  freedom.stop = stop;
  for (int turn = 0; turn < kTurns && !stop.stop_requested(); ++turn) {
    const FullRate now = look_at_full_rate(*data.study, *data.group, model, residual, mask, options);
    if (turn > 0) {
      renew_levels(now, found);
    }
    const PerSample factors = white_factors(now, found);
    BlockColumns columns;
    const BlockSeries series = weighted_blocks(now, mask, residual, factors, columns);
    SlowModel start = model;
    start.white = white_by_spectra(now, factors, found);
    model.components = fit_slow(series, columns, start, freedom).model.components;
    model.white = start.white;
  }
  return model;
}

}  // namespace driftlab::investigate
