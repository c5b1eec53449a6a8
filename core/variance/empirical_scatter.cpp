#include "core/variance/empirical_scatter.hpp"

#include "core/process/distributions.hpp"
#include "core/variance/square_projections.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab {
namespace {

constexpr std::array<std::size_t, 5> kProjections{kMostProjections, 96, 48, 24, 12};
constexpr double kShortest = 100.0;  ///< samples/m of the longest observed scale
constexpr double kReach = 0.12;      ///< projections per samples/m
constexpr double kAgreement = 2.2;   ///< standard errors by which fewer projections may give more scatter
constexpr double kDictionaryError = 1.06;
constexpr double kLevel = 0.01;
constexpr double kCommonEvidence = 3.0;
constexpr std::size_t kThinnedFrom = 16;  ///< half lengths that square_projections thins

double mean_square(const SquareProjections& observed, Eigen::Index scale, std::size_t count) {
  const auto rows = static_cast<Eigen::Index>(count);
  return observed.relative.col(scale).head(rows).squaredNorm() / static_cast<double>(count);
}

/// The number of projections of one scale: as many as the scale allows, fewer while these show more.
std::size_t projections(const SquareProjections& observed, Eigen::Index scale, double samples) {
  const double allowed = kReach * samples / static_cast<double>(observed.half[static_cast<std::size_t>(scale)]);
  std::size_t first = 0;
  while (first + 1 < kProjections.size() && static_cast<double>(kProjections[first]) > allowed) {
    ++first;
  }
  for (; first + 1 < kProjections.size(); ++first) {
    const double many = mean_square(observed, scale, kProjections[first]);
    const bool agreed = std::all_of(
        kProjections.begin() + static_cast<std::ptrdiff_t>(first) + 1, kProjections.end(), [&](std::size_t fewer) {
          const double error =
              std::sqrt(2.0 / static_cast<double>(fewer) - 2.0 / static_cast<double>(kProjections[first]));
          return mean_square(observed, scale, fewer) <= many * std::exp(kAgreement * error);
        });
    if (agreed) {
      break;
    }
  }
  return kProjections[first];
}

/// Relative variance of the mean square of the coefficients that were used, under the mixture.
double assumed(const VarianceIntervals& intervals, HaarCovariance& plan, std::size_t j, std::size_t half) {
  const auto row = static_cast<Eigen::Index>(j);
  const double level = intervals.modelled(row);
  if (half < kThinnedFrom) {
    return intervals.estimate_variance(row) / (level * level);
  }
  double relative = 2.0 * plan.thinned_sums(j, half / 8, intervals.mixture)[0];
  if (intervals.shape.kurtosis != 0.0) {
    const double share =
        part_variance(intervals.mixture, static_cast<double>(half), plan.dt_s(), intervals.shape.rough) / level;
    relative += intervals.shape.kurtosis * share * share * kurtosis_share(half, plan.samples());
  }
  return std::max(relative, 0.05 * intervals.estimate_variance(row) / (level * level));
}

/// What scales two and more octaves apart share beyond the model, as a relative variance; 0 without evidence.
double common_part(const SquareProjections& observed, const std::vector<std::size_t>& used,
                   const VarianceIntervals& intervals, HaarCovariance& plan) {
  Eigen::MatrixXd model = plan.matrix(intervals.mixture);
  add_kurtosis(model, intervals.mixture, plan.half(), plan.samples(), plan.dt_s(), intervals.shape);
  double sum = 0.0;
  double weights = 0.0;
  for (Eigen::Index j = 0; j < observed.relative.cols(); ++j) {
    for (Eigen::Index i = 0; i + 2 <= j; ++i) {
      const std::size_t count = std::min(used[static_cast<std::size_t>(i)], used[static_cast<std::size_t>(j)]);
      const auto rows = static_cast<Eigen::Index>(count);
      const double shared =
          observed.relative.col(i).head(rows).dot(observed.relative.col(j).head(rows)) / static_cast<double>(count);
      const double weight =
          static_cast<double>(count) / (mean_square(observed, i, count) * mean_square(observed, j, count));
      sum += weight * (shared - model(i, j) / (intervals.modelled(i) * intervals.modelled(j)));
      weights += weight;
    }
  }
  return weights > 0.0 && sum > kCommonEvidence * std::sqrt(weights) ? sum / weights : 0.0;
}

void replace(const SquareProjections& observed, const EmpiricalScatter& scatter, double common,
             const HaarVariance& curve, VarianceIntervals& intervals) {
  const Eigen::Index scales = intervals.modelled.size();
  ScatterCorrection correction{Eigen::VectorXd::Ones(scales), std::sqrt(common) * intervals.modelled};
  for (Eigen::Index j = 0; j < scales; ++j) {
    const double raised = intervals.estimate_variance(j) + correction.common(j) * correction.common(j);
    double variance = raised;
    if (j < observed.relative.cols()) {
      const auto entry = static_cast<std::size_t>(j);
      const double wider = student_quantile(0.975, static_cast<double>(scatter.used[entry])) / kNormal975;
      variance = intervals.estimate_variance(j) * scatter.ratio[entry] * wider * wider;
    }
    correction.factor(j) = std::sqrt(variance / raised);
    intervals.estimate_variance(j) = variance;
    const auto row = static_cast<std::size_t>(j);
    intervals.edf[row] = 2.0 * intervals.modelled(j) * intervals.modelled(j) / variance;
    intervals.ci95[row] = chi_square_interval(curve.variance[row], intervals.edf[row]);
  }
  intervals.scatter = std::move(correction);
}

}  // namespace

EmpiricalScatter observe_scatter(std::span<const double> samples, double pivot, const HaarVariance& curve,
                                 HaarCovariance& plan, VarianceIntervals& intervals, const RunControl& control) {
  EmpiricalScatter scatter;
  const auto count = static_cast<double>(samples.size());
  std::size_t largest = 0;
  for (const std::size_t half : curve.half) {
    largest = kShortest * static_cast<double>(half) <= count ? half : largest;
  }
  if (largest == 0) {
    return scatter;
  }
  const SquareProjections observed = square_projections(samples, pivot, largest, control);
  double least = 1.0;
  for (Eigen::Index j = 0; j < observed.relative.cols(); ++j) {
    const auto row = static_cast<std::size_t>(j);
    const std::size_t used = projections(observed, j, count);
    const double ratio = mean_square(observed, j, used) / assumed(intervals, plan, row, observed.half[row]);
    const auto dof = static_cast<double>(used);
    least = std::min(least, chi_squared_tail(dof * ratio / kDictionaryError, dof));
    scatter.used.push_back(used);
    scatter.ratio.push_back(ratio);
    scatter.largest_ratio = std::max(scatter.largest_ratio, ratio);
  }
  scatter.p = std::min(1.0, least * static_cast<double>(std::max<std::size_t>(1, scatter.used.size())));
  scatter.departs = scatter.p < kLevel;
  if (scatter.departs) {
    replace(observed, scatter, common_part(observed, scatter.used, intervals, plan), curve, intervals);
  }
  return scatter;
}

std::string departure_sentence(const EmpiricalScatter& scatter) {
  const double tenths = std::round(10.0 * scatter.largest_ratio);
  std::string text = std::to_string(static_cast<long long>(tenths / 10.0));
  text += '.';
  text += static_cast<char>('0' + static_cast<int>(std::fmod(tenths, 10.0)));
  return "The wavelet variances scatter up to " + text +
         " times as much as linear noise of their spectrum does: the noise changes its level or has a spectrum that no "
         "sum of standard processes describes. Intervals rest on the scatter that the record itself shows.";
}

}  // namespace driftlab
