#include "core/investigate/fullrate/peak_spectrum.hpp"

#include "core/investigate/fullrate/golden_section.hpp"
#include "core/process/resonance.hpp"
#include "core/signal/turns.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace driftlab::investigate {

PeakDensity::PeakDensity(const Peak& peak, double dt_s) : dt_s_(dt_s) {
  const Resonance unit{1.0, peak.f_hz, peak.quality};
  const double fall = 0.5 * kTurn * peak.f_hz / peak.quality * dt_s;
  const double turn = kTurn * peak.f_hz * dt_s * std::sqrt(1.0 - 0.25 / (peak.quality * peak.quality));
  p1_ = 2.0 * std::exp(-fall) * std::cos(turn);
  p2_ = -std::exp(-2.0 * fall);
  const std::array<double, 3> weights{1.0, -p1_, -p2_};
  std::array<double, 4> covariance{};
  for (std::size_t lag = 0; lag < covariance.size(); ++lag) {
    covariance.at(lag) = unit.autocovariance(static_cast<double>(lag), dt_s).value_or(0.0);
  }
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      const double product = weights.at(static_cast<std::size_t>(a)) * weights.at(static_cast<std::size_t>(b));
      m0_ += product * covariance.at(static_cast<std::size_t>(std::abs(a - b)));
      m1_ += product * covariance.at(static_cast<std::size_t>(std::abs(a - b - 1)));
    }
  }
}

double PeakDensity::at(double f_hz) const {
  const double c = std::cos(kTurn * f_hz * dt_s_);
  const double square = 1.0 + p1_ * p1_ + p2_ * p2_ - 2.0 * p1_ * (1.0 - p2_) * c - 2.0 * p2_ * (2.0 * c * c - 1.0);
  return dt_s_ * (m0_ + 2.0 * m1_ * c) / square;
}

double PeakDensity::in_bin(double f_hz, double weight) const {
  if (weight < 4.0) {
    return at(f_hz);
  }
  // Half the width of a bin, of which each is 1.025 times the one before (kBinRatio of spectrum.cpp).
  constexpr double kHalf = 0.0125;
  return (at(f_hz * (1.0 - kHalf)) + 4.0 * at(f_hz * (1.0 - 0.5 * kHalf)) + 2.0 * at(f_hz) +
          4.0 * at(f_hz * (1.0 + 0.5 * kHalf)) + at(f_hz * (1.0 + kHalf))) /
         12.0;
}

StackedSpectra::StackedSpectra(const FullRate& data, const std::vector<std::size_t>& scope, double low_hz,
                               double high_hz)
    : dt_s_(data.dt_s) {
  for (const std::size_t r : scope) {
    const Spectrum& s = data.spectrum[r];
    parts_.push_back({s.samples, f_hz_.size(), 0});
    for (std::size_t j = 0; j < s.power.size(); ++j) {
      if (s.f_hz[j] < low_hz || s.f_hz[j] > high_hz) {
        continue;
      }
      const double gain =
          data.colour.band_limited() ? butterworth_gain(s.f_hz[j], data.colour.corner_hz, data.dt_s) : 1.0;
      const double floor = 1e-9 * data.model.white + data.lattice_step * data.lattice_step / 12.0 * data.dt_s;
      f_hz_.push_back(s.f_hz[j]);
      power_.push_back(s.power[j]);
      weight_.push_back(s.weight[j]);
      fixed_.push_back(data.slow[r][j] + floor + (data.given ? data.model.white * gain : 0.0));
      white_.push_back(gain);
      ++parts_.back().count;
    }
  }
  free_white_ = !data.given;
  start_ = data.model.white;
  floor_ = data.colour.band_limited();
}

LevelFit StackedSpectra::fit(const Peak* peak) const {
  LinearDensity density = linear((free_white_ ? 1 : 0) + (floor_ ? 1 : 0) + (peak != nullptr ? 1 : 0));
  if (peak != nullptr) {
    density.shape.col(density.shape.cols() - 1) = column(*peak);
  }
  if (density.shape.cols() == 0) {
    return {{}, {}, whittle(density.power, density.weight, density.fixed)};
  }
  Eigen::VectorXd start = Eigen::VectorXd::Constant(density.shape.cols(), start_);
  if (peak != nullptr) {
    const double top = density.shape.col(start.size() - 1).maxCoeff();
    start[start.size() - 1] = top > 0.0 ? start_ / top : start_;
  }
  return fit_levels(density, start);
}

double StackedSpectra::with(const Peak& peak, double variance) const {
  LinearDensity density = linear((free_white_ ? 1 : 0) + (floor_ ? 1 : 0));
  density.fixed += variance * column(peak);
  return density.shape.cols() == 0
             ? whittle(density.power, density.weight, density.fixed)
             : fit_levels(density, Eigen::VectorXd::Constant(density.shape.cols(), start_)).log_likelihood;
}

std::vector<double> StackedSpectra::without_peak() const {
  const LinearDensity density = linear((free_white_ ? 1 : 0) + (floor_ ? 1 : 0));
  const LevelFit fitted = fit(nullptr);
  Eigen::VectorXd expected = density.fixed;
  if (density.shape.cols() > 0) {
    expected += density.shape * fitted.level;
  }
  return {expected.begin(), expected.end()};
}

double StackedSpectra::tilted(const std::vector<double>& expected, const Peak* peak, double middle_hz) const {
  const auto at = [&](double slope) {
    LinearDensity density = linear(peak != nullptr ? 2 : 1);
    density.fixed.setConstant(1e-12 * start_);
    for (std::size_t j = 0; j < bins(); ++j) {
      density.shape(static_cast<Eigen::Index>(j), 0) = expected[j] * std::pow(f_hz_[j] / middle_hz, slope);
    }
    Eigen::VectorXd start = Eigen::VectorXd::Ones(density.shape.cols());
    if (peak != nullptr) {
      density.shape.col(1) = column(*peak);
      start[1] = 0.5 * start_ / std::max(1e-300, density.shape.col(1).maxCoeff());
    }
    return fit_levels(density, start).log_likelihood;
  };
  return at(golden_section(-2.5, 2.5, 14, at));
}

double StackedSpectra::gain_of_one_bin(const std::vector<double>& expected) const {
  double most = 0.0;
  for (std::size_t j = 0; j < bins(); ++j) {
    const double ratio = power_[j] / expected[j];
    most = std::max(most, ratio > 1.0 ? 2.0 * weight_[j] * (ratio - 1.0 - std::log(ratio)) : 0.0);
  }
  return most;
}

Eigen::VectorXd StackedSpectra::column(const Peak& peak) const {
  const PeakDensity density(peak, dt_s_);
  Eigen::VectorXd column(static_cast<Eigen::Index>(bins()));
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    const Part& own = parts_[part];
    const auto same = std::find_if(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(part),
                                   [&](const Part& other) { return other.samples == own.samples; });
    const bool known = same != parts_.begin() + static_cast<std::ptrdiff_t>(part);
    for (std::size_t k = 0; k < own.count; ++k) {
      const std::size_t j = own.first + k;
      column[static_cast<Eigen::Index>(j)] =
          known ? column[static_cast<Eigen::Index>(same->first + k)] : density.in_bin(f_hz_[j], weight_[j]);
    }
  }
  return column;
}

LinearDensity StackedSpectra::linear(int columns) const {
  const auto count = static_cast<Eigen::Index>(bins());
  LinearDensity density;
  density.power = Eigen::Map<const Eigen::VectorXd>(power_.data(), count);
  density.weight = Eigen::Map<const Eigen::VectorXd>(weight_.data(), count);
  density.fixed = Eigen::Map<const Eigen::VectorXd>(fixed_.data(), count);
  density.shape = Eigen::MatrixXd::Zero(count, columns);
  int next = 0;
  if (free_white_ && columns > 0) {
    density.shape.col(next++) = Eigen::Map<const Eigen::VectorXd>(white_.data(), count);
  }
  if (floor_ && columns > next) {
    density.shape.col(next).setOnes();
  }
  return density;
}

PeakGrid::PeakGrid(double low_hz, double high_hz, double dt_s) : dt_s_(dt_s) {
  // A peak of quality 32, the sharpest of the grid, is 3 % wide: none is missed between two places.
  constexpr double kStep = 1.04;
  for (double f = low_hz; f < high_hz; f *= kStep) {
    for (const double quality : {2.0, 4.0, 8.0, 16.0, 32.0}) {
      peaks_.push_back({f, quality});
    }
  }
}

Peak PeakGrid::best(const StackedSpectra& stacked, const std::vector<double>& expected) {
  Peak best;
  double most = 0.0;
  for (std::size_t p = 0; p < peaks_.size(); ++p) {
    double score = 0.0;
    double information = 0.0;
    double shared = 0.0;
    double white = 1e-300;
    for (const StackedSpectra::Part& part : stacked.parts()) {
      const Eigen::MatrixXd& densities = densities_of(stacked, part);
      for (std::size_t k = 0; k < part.count; ++k) {
        const std::size_t j = part.first + k;
        const double d = densities(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(p)) / expected[j];
        const double w = stacked.white(j) / expected[j];
        score += stacked.weight(j) * (stacked.power(j) / expected[j] - 1.0) * d;
        information += stacked.weight(j) * d * d;
        shared += stacked.weight(j) * d * w;
        white += stacked.weight(j) * w * w;
      }
    }
    const double deviations = score / std::sqrt(std::max(1e-300, information - shared * shared / white));
    if (deviations > most) {
      most = deviations;
      best = peaks_[p];
    }
  }
  return best;
}

const Eigen::MatrixXd& PeakGrid::densities_of(const StackedSpectra& stacked, const StackedSpectra::Part& part) {
  const auto known = densities_.find(part.samples);
  if (known != densities_.end()) {
    return known->second;
  }
  Eigen::MatrixXd made(static_cast<Eigen::Index>(part.count), static_cast<Eigen::Index>(peaks_.size()));
  for (std::size_t p = 0; p < peaks_.size(); ++p) {
    const PeakDensity density(peaks_[p], dt_s_);
    for (std::size_t k = 0; k < part.count; ++k) {
      const std::size_t j = part.first + k;
      made(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(p)) =
          density.in_bin(stacked.f_hz(j), stacked.weight(j));
    }
  }
  return densities_.emplace(part.samples, std::move(made)).first->second;
}

Peak refined(const StackedSpectra& stacked, Peak peak, double high_hz) {
  double top = stacked.fit(&peak).log_likelihood;
  double step_f = 0.03;
  double step_q = 0.35;
  for (int i = 0; i < 24; ++i) {
    bool moved = false;
    for (const auto& [df, dq] : {std::pair{step_f, 0.0}, {-step_f, 0.0}, {0.0, step_q}, {0.0, -step_q}}) {
      const Peak trial{std::min(peak.f_hz * std::exp(df), high_hz),
                       std::clamp(peak.quality * std::exp(dq), 0.6, kMostQuality)};
      const double l = stacked.fit(&trial).log_likelihood;
      if (l > top) {
        top = l;
        peak = trial;
        moved = true;
      }
    }
    step_f *= moved ? 1.0 : 0.6;
    step_q *= moved ? 1.0 : 0.6;
  }
  return peak;
}

std::array<double, 3> deviations_of(const StackedSpectra& stacked, const Peak& peak, double variance) {
  const std::array<double, 3> step{0.05, 0.15 / peak.quality, 0.1};
  const auto at = [&](const Eigen::Vector3d& off) {
    return stacked.with({peak.f_hz * std::exp(off[1]), peak.quality * std::exp(off[2])},
                        variance * std::exp(2.0 * off[0]));
  };
  const double here = at(Eigen::Vector3d::Zero());
  Eigen::Matrix3d information;
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      Eigen::Vector3d one = Eigen::Vector3d::Zero();
      Eigen::Vector3d other = Eigen::Vector3d::Zero();
      one[a] = step.at(static_cast<std::size_t>(a));
      other[b] = step.at(static_cast<std::size_t>(b));
      const double curvature =
          a == b ? (at(one) - 2.0 * here + at(-one)) / (one[a] * one[a])
                 : (at(one + other) - at(one - other) - at(other - one) + at(-one - other)) / (4.0 * one[a] * other[b]);
      information(a, b) = information(b, a) = -curvature;
    }
  }
  const Eigen::Matrix3d covariance = information.inverse();
  std::array<double, 3> deviations{};
  for (int a = 0; a < 3; ++a) {
    const double square = covariance(a, a);
    deviations.at(static_cast<std::size_t>(a)) = square > 0.0 && std::isfinite(square) ? std::sqrt(square) : 10.0;
  }
  return deviations;
}

}  // namespace driftlab::investigate
