#include "core/variance/biweight.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace driftlab {
namespace {

constexpr int kTableSize = 101;
constexpr double kSmallest = 2.0;
constexpr double kLargest = 12.0;

/// The expansions on a grid of c, made once: tuning is then a search in a table.
const std::vector<Biweight>& table() {
  static const std::vector<Biweight> shared_table = [] {
    std::vector<Biweight> entries;
    entries.reserve(kTableSize);
    for (int i = 0; i < kTableSize; ++i) {
      entries.push_back(Biweight::with(kSmallest + (kLargest - kSmallest) * i / (kTableSize - 1)));
    }
    return entries;
  }();
  return shared_table;
}

}  // namespace

Biweight Biweight::with(double c) {
  Biweight biweight;
  biweight.c = c;
  // Simpson's rule with 600 panels on [0, c], both signs: chi and its first two derivatives vanish at c.
  constexpr int kPoints = 601;
  static const std::array<double, 2 * HaarCovariance::kEvenPowers + 1> root = [] {
    std::array<double, 2 * HaarCovariance::kEvenPowers + 1> roots{};
    for (std::size_t k = 0; k < roots.size(); ++k) {
      roots[k] = std::sqrt(static_cast<double>(k));
    }
    return roots;
  }();
  const double step = c / (kPoints - 1);
  for (int i = 0; i < kPoints; ++i) {
    const double r = step * i;
    const double inside = 1.0 - (r / c) * (r / c);
    const double chi = r * r * inside * inside * inside * inside;
    const double simpson = i == 0 || i == kPoints - 1 ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    const double weight = 2.0 * simpson * step / 3.0 * chi * std::exp(-0.5 * r * r) / std::sqrt(2.0 * std::numbers::pi);
    biweight.mean += weight;
    double before = 1.0;  // h_0
    double now = r;       // h_1
    for (std::size_t k = 2; k <= 2 * biweight.hermite.size(); ++k) {
      const double next = (r * now - root[k - 1] * before) / root[k];
      before = now;
      now = next;
      if (k % 2 == 0) {
        biweight.hermite[k / 2 - 1] += weight * now;
      }
    }
  }
  return biweight;
}

double Biweight::efficiency(const std::array<double, HaarCovariance::kEvenPowers>& sums) const {
  double all = 0.0;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    all += hermite[k] * hermite[k] * sums[k];
  }
  return all > 0.0 ? hermite[0] * hermite[0] * sums[0] / all : 0.0;
}

Biweight tune_biweight(const std::array<double, HaarCovariance::kEvenPowers>& sums, double target) {
  const std::vector<Biweight>& entries = table();
  std::size_t at = 0;
  while (at + 1 < entries.size() && entries[at].efficiency(sums) < target) {
    ++at;
  }
  if (at == 0 || entries[at].efficiency(sums) < target) {
    return entries[at];
  }
  const double low = entries[at - 1].efficiency(sums);
  const double high = entries[at].efficiency(sums);
  const double fraction = (target - low) / (high - low);
  return Biweight::with(entries[at - 1].c + fraction * (entries[at].c - entries[at - 1].c));
}

}  // namespace driftlab
