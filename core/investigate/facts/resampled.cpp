#include "core/investigate/facts/resampled.hpp"

#include "core/variance/welch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kMostSamples = 10;  ///< samples made of one

double deviation_of_differences(std::span<const double> rows) {
  double square = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    square += (rows[i] - rows[i - 1]) * (rows[i] - rows[i - 1]);
  }
  return rows.size() > 1 ? std::sqrt(square / static_cast<double>(rows.size() - 1)) : 0.0;
}

/// Share of the samples between two that are `every` apart and differ, which lie on their chord.
double share_on_chords(std::span<const double> rows, std::size_t every, std::size_t phase, double digit) {
  double on = 0.0;
  double between = 0.0;
  for (std::size_t from = phase; from + every < rows.size(); from += every) {
    const double step = (rows[from + every] - rows[from]) / static_cast<double>(every);
    if (std::fabs(rows[from + every] - rows[from]) <= 2.0 * digit) {
      continue;
    }
    for (std::size_t k = 1; k < every; ++k) {
      on += std::fabs(rows[from + k] - rows[from] - step * static_cast<double>(k)) <= 1.001 * digit ? 1.0 : 0.0;
      between += 1.0;
    }
  }
  return between > 100.0 ? on / between : 0.0;
}

/// Density of pieces of `length` that overlap by half, each less the line through its ends and the mean of the rest;
/// unit of x squared per sample.
std::vector<double> mean_periodogram(std::span<const double> x, std::size_t length) {
  WelchPeriodogram mean(length, Taper::Hann, 1.0);
  for (std::size_t from = 0; from + length <= x.size(); from += length / 2) {
    const std::span<const double> piece = x.subspan(from, length);
    PieceLine off{.slope = (piece.back() - piece.front()) / static_cast<double>(length - 1)};
    for (std::size_t i = 0; i < length; ++i) {
      off.level += (piece[i] - off.slope * static_cast<double>(i)) / static_cast<double>(length);
    }
    mean.add(piece, off);
  }
  return mean.mean();
}

struct Near {
  double power = 0.0;  ///< mean, less the rounding's
  double shape = 0.0;  ///< mean
};

Near near(const std::vector<double>& power, std::size_t m, double f, double width, double rounding) {
  const double bins = 2.0 * static_cast<double>(power.size() - 1);
  Near mean;
  double count = 0.0;
  for (std::size_t k = 1; k < power.size(); ++k) {
    const double at = static_cast<double>(k) / bins;
    if (std::fabs(at - f) > width) {
      continue;
    }
    const double half = std::numbers::pi * at;
    const double s = std::sin(static_cast<double>(m) * half) / (static_cast<double>(m) * std::sin(half));
    mean.power += power[k] - rounding;
    mean.shape += s * s;
    count += 1.0;
  }
  mean.power /= std::max(1.0, count);
  mean.shape /= std::max(1.0, count);
  return mean;
}

/// What is there for each of what the shape lets through, near `f`.
double ratio_of(const Near& near) { return near.power / near.shape; }

bool is_running_mean(const std::vector<double>& power, std::size_t m, double rounding) {
  // [cycles per sample] to either side of a zero of the mean of m samples: a few ordinates of the periodogram. Chosen,
  // not measured.
  constexpr double kAboutZero = 0.006;
  // Chosen, not measured: what is left at a true zero is rounding, whose power is taken off before.
  constexpr double kDeep = 0.02;
  // [cycles per sample] from a zero: the flank, where the shape has risen beyond rounding and beyond what leaks into
  // the zero itself, and a low-pass that is as deep there has not. Chosen, not measured.
  constexpr double kFlank = 0.025;
  constexpr double kAboutFlank = 0.008;
  for (std::size_t k = 1; 2 * k <= m; ++k) {
    const double zero = static_cast<double>(k) / static_cast<double>(m);
    const Near at = near(power, m, zero, kAboutZero, rounding);
    const Near midway = near(power, m, zero - 0.5 / static_cast<double>(m), 0.02, rounding);
    const Near flank = near(power, m, zero - kFlank, kAboutFlank, rounding);
    if (!(midway.power > 0.0) || at.power > kDeep * midway.power) {
      return false;
    }
    for (const Near& place : {at, flank}) {
      const double ratio = ratio_of(place) / ratio_of(midway);
      if (!(ratio > 0.5) || !(ratio < 2.0)) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

Interpolation find_interpolation(std::span<const double> rows, double digit) {
  // Chosen, not measured: gaps and gross errors may take a twentieth of the rows off their chords.
  constexpr double kShare = 0.95;
  // Rows that decide whether the whole file is worth the pass: a share of 0.95 of them is known to 0.005 (two standard
  // deviations).
  constexpr std::size_t kLook = 8192;
  const double spread = deviation_of_differences(rows);
  const double code = digit > 0.0 ? digit : 1e-4 * spread;
  if (rows.size() < 200 || spread < 3.0 * code) {
    return {};
  }
  const std::span<const double> look = rows.first(std::min(rows.size(), kLook));
  for (std::size_t every = kMostSamples; every >= 2; --every) {
    for (std::size_t phase = 0; phase < every; ++phase) {
      if (share_on_chords(look, every, phase, code) > kShare && share_on_chords(rows, every, phase, code) > kShare) {
        return {every, phase};
      }
    }
  }
  return {};
}

std::size_t find_running_mean(std::span<const double> error, double digit) {
  const std::size_t length = error.size() >= 16384 ? 4096 : 1024;
  if (error.size() < 4 * length) {
    return 0;
  }
  const std::vector<double> power = mean_periodogram(error, length);
  const double rounding = digit * digit / 12.0;
  for (std::size_t m = kMostSamples; m >= 2; --m) {
    if (is_running_mean(power, m, rounding)) {
      return m;
    }
  }
  return 0;
}

}  // namespace driftlab::investigate
