#include "core/investigate/search/base_quantization.hpp"

#include "core/investigate/fullrate/whittle.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace driftlab::investigate {
namespace {

constexpr double kShownByEach = 6.0;     ///< twice the log likelihood that each recording gains
constexpr double kShownTogether = 20.0;  ///< and all of them
constexpr double kAgree = 4.0;           ///< standard errors between one recording and all

struct Shown {
  double level = 0.0;  ///< Q^2
  double white = 0.0;
  double sd = 0.0;
  double gain = 0.0;
};

/// White and differenced noise beside the slow part of one recording, against white noise alone.
std::optional<Shown> shown_by(const FullRate& data, std::size_t r) {
  const Spectrum& s = data.spectrum[r];
  const auto bins = static_cast<Eigen::Index>(s.power.size());
  if (bins < 8) {
    return std::nullopt;
  }
  LinearDensity density;
  density.power = Eigen::Map<const Eigen::VectorXd>(s.power.data(), bins);
  density.weight = Eigen::Map<const Eigen::VectorXd>(s.weight.data(), bins);
  density.fixed = Eigen::Map<const Eigen::VectorXd>(data.slow[r].data(), bins);
  density.shape = Eigen::MatrixXd::Ones(bins, 2);
  for (Eigen::Index j = 0; j < bins; ++j) {
    density.shape(j, 0) = quantization_shape(s.f_hz[static_cast<std::size_t>(j)], data.dt_s);
  }
  LinearDensity plain = density;
  plain.shape = density.shape.rightCols(1);
  const LevelFit none = fit_levels(plain, Eigen::VectorXd::Constant(1, data.model.white));
  Eigen::VectorXd start(2);
  start << 0.1 * none.level[0] / quantization_shape(0.25 / data.dt_s, data.dt_s), none.level[0];
  const LevelFit fit = fit_levels(density, start);
  return Shown{fit.level[0], fit.level[1], std::sqrt(std::max(0.0, fit.covariance(0, 0))),
               2.0 * (fit.log_likelihood - none.log_likelihood)};
}

/// Mean deviation of the spectrum from white, differenced and slow noise over some forty bands, as chi-square.
bool describes(const FullRate& data, std::size_t r, const Shown& shown) {
  const Spectrum& s = data.spectrum[r];
  double all = 0.0;
  for (const double w : s.weight) {
    all += w;
  }
  double chi2 = 0.0;
  double dof = -2.0;
  double ratio = 0.0;
  double weight = 0.0;
  for (std::size_t j = 0; j < s.power.size(); ++j) {
    const double model = shown.white + shown.level * quantization_shape(s.f_hz[j], data.dt_s) + data.slow[r][j];
    ratio += s.weight[j] * s.power[j] / model;
    weight += s.weight[j];
    if (weight > all / 40.0 || j + 1 == s.power.size()) {
      chi2 += weight * std::pow(ratio / weight - 1.0, 2.0);
      dof += 1.0;
      ratio = weight = 0.0;
    }
  }
  return dof > 0.0 && (chi2 - dof) / std::sqrt(2.0 * dof) < 4.0;
}

}  // namespace

double quantization_of_base(const FullRate& data) {
  std::vector<std::size_t> members;
  for (std::size_t r = 0; r < data.members(); ++r) {
    if (data.group->members[r].recording->is_static()) {
      members.push_back(r);
    }
  }
  if (members.empty()) {
    members = all_members(*data.group);
  }
  std::vector<Shown> each;
  double gain = 0.0;
  double level = 0.0;
  double information = 0.0;
  for (const std::size_t r : members) {
    const std::optional<Shown> shown = shown_by(data, r);
    if (!shown || shown->gain < kShownByEach || !(shown->sd > 0.0) || !describes(data, r, *shown)) {
      return 0.0;
    }
    each.push_back(*shown);
    gain += shown->gain;
    level += shown->level / (shown->sd * shown->sd);
    information += 1.0 / (shown->sd * shown->sd);
  }
  level /= information;
  const bool agree = std::all_of(
      each.begin(), each.end(), [&](const Shown& shown) { return std::fabs(shown.level - level) < kAgree * shown.sd; });
  return agree && gain > kShownTogether ? level : 0.0;
}

}  // namespace driftlab::investigate
