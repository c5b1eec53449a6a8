#include "core/campaign/population.hpp"

#include "core/campaign/table_cells.hpp"
#include "core/process/distributions.hpp"

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kPoints = 64;

/// Estimates on the log scale.
struct Logs {
  std::vector<double> y;
  std::vector<double> variance;  ///< s^2
  [[nodiscard]] std::size_t count() const { return y.size(); }
  [[nodiscard]] Logs without(std::size_t i) const {
    Logs rest = *this;
    rest.y.erase(rest.y.begin() + static_cast<std::ptrdiff_t>(i));
    rest.variance.erase(rest.variance.begin() + static_cast<std::ptrdiff_t>(i));
    return rest;
  }
};

/// The weighted mean under one tau.
struct Weighted {
  double weight = 0.0;  ///< sum of 1/(s^2 + tau^2)
  double mean = 0.0;
  double squares = 0.0;         ///< weighted squares about the mean
  double log_likelihood = 0.0;  ///< restricted
};

Weighted weighted(const Logs& logs, double tau) {
  Weighted found;
  double log_weights = 0.0;
  for (std::size_t i = 0; i < logs.count(); ++i) {
    const double w = 1.0 / (logs.variance[i] + tau * tau);
    found.weight += w;
    found.mean += w * logs.y[i];
    log_weights += std::log(w);
  }
  found.mean /= found.weight;
  for (std::size_t i = 0; i < logs.count(); ++i) {
    const double w = 1.0 / (logs.variance[i] + tau * tau);
    found.squares += w * (logs.y[i] - found.mean) * (logs.y[i] - found.mean);
  }
  found.log_likelihood = 0.5 * (log_weights - std::log(found.weight) - found.squares);
  return found;
}

double typical_error(const Logs& logs) {
  const double sum = std::accumulate(logs.variance.begin(), logs.variance.end(), 0.0,
                                     [](double total, double v) { return total + 0.5 * std::log(v); });
  return std::exp(sum / static_cast<double>(logs.count()));
}

/// The largest tau worth a look: far beyond the scatter of the estimates.
double largest_tau(const Logs& logs) {
  const auto [low, high] = std::minmax_element(logs.y.begin(), logs.y.end());
  return 12.0 * std::max(typical_error(logs), *high - *low);
}

/// Where the restricted likelihood is greatest: the best of a grid, then golden sections between its neighbours.
double reml_spread(const Logs& logs) {
  const double s = typical_error(logs);
  const double top = largest_tau(logs);
  const auto at = [&](double u) { return s * (std::pow(1.0 + top / s, u) - 1.0); };
  const auto value = [&](double u) { return weighted(logs, at(u)).log_likelihood; };
  std::size_t best = 0;
  for (std::size_t i = 1; i <= kPoints; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(kPoints);
    best = value(u) > value(static_cast<double>(best) / static_cast<double>(kPoints)) ? i : best;
  }
  double low = (best == 0 ? 0.0 : static_cast<double>(best - 1)) / static_cast<double>(kPoints);
  double high = static_cast<double>(std::min(best + 1, kPoints)) / static_cast<double>(kPoints);
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  for (int step = 0; step < 60; ++step) {
    const double a = high - golden * (high - low);
    const double b = low + golden * (high - low);
    (value(a) < value(b) ? low : high) = value(a) < value(b) ? a : b;
  }
  const double u = 0.5 * (low + high);
  return value(0.0) >= value(u) ? 0.0 : at(u);
}

/// What is known of mean and further values, averaged over tau.
class OverSpreads {
 public:
  explicit OverSpreads(const Logs& logs) : dof_(static_cast<double>(logs.count()) - 1.0) {
    const double s = typical_error(logs);
    const double top = largest_tau(logs);
    double greatest = -1e300;
    for (std::size_t i = 0; i < kPoints; ++i) {
      // Evenly spaced in ln(s + tau): the prior 1/(s + tau).
      const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(kPoints);
      const double tau = s * (std::pow(1.0 + top / s, u) - 1.0);
      const Weighted found = weighted(logs, tau);
      points_.push_back({found.mean, std::sqrt(found.squares / dof_ / found.weight), 1.0 / found.weight + tau * tau,
                         found.log_likelihood});
      greatest = std::max(greatest, found.log_likelihood);
    }
    double sum = 0.0;
    for (Point& point : points_) {
      point.share = std::exp(point.share - greatest);
      sum += point.share;
    }
    constexpr double kNothing = 1e-12;
    std::erase_if(points_, [&](const Point& point) { return point.share < kNothing * sum; });
    for (Point& point : points_) {
      point.share /= sum;
    }
  }

  /// P(further value + error < x), the error of that variance; normal given tau.
  [[nodiscard]] double below(double x, double error_variance) const {
    double sum = 0.0;
    for (const Point& point : points_) {
      sum += point.share * normal_tail((point.mean - x) / std::sqrt(point.variance + error_variance));
    }
    return sum;
  }

  /// The x with P(further value < x) = p.
  [[nodiscard]] double quantile(double p) const {
    const auto reach = [](const Point& point) { return 12.0 * std::sqrt(point.variance); };
    return where([&](double x) { return below(x, 0.0); }, p, reach);
  }

  /// The x with P(mean < x) = p: Student's t with the variance of Hartung and Knapp given tau.
  [[nodiscard]] double quantile_of_mean(double p) const {
    const double farthest = student_quantile(std::max(p, 1.0 - p), dof_);
    const auto mean_below = [&](double x) {
      double sum = 0.0;
      for (const Point& point : points_) {
        sum += point.share *
               (point.error > 0.0 ? student_tail((point.mean - x) / point.error, dof_) : (point.mean < x ? 1.0 : 0.0));
      }
      return sum;
    };
    return where(mean_below, p, [&](const Point& point) { return 1.01 * farthest * point.error; });
  }

 private:
  struct Point {
    double mean = 0.0;
    double error = 0.0;     ///< of the mean
    double variance = 0.0;  ///< of a further value
    double share = 0.0;
  };

  /// The x with below(x) = p, among what lies within `reach` of a point's mean.
  template <typename Below, typename Reach>
  [[nodiscard]] double where(const Below& below, double p, const Reach& reach) const {
    double low = points_.front().mean;
    double high = low;
    for (const Point& point : points_) {
      low = std::min(low, point.mean - reach(point));
      high = std::max(high, point.mean + reach(point));
    }
    if (!(below(low) < p && below(high) > p)) {
      return below(low) < p ? high : low;  // all points at one place, or a reach that is rounded away
    }
    constexpr std::uintmax_t kMostSteps = 60;
    std::uintmax_t steps = kMostSteps;
    std::tie(low, high) = boost::math::tools::toms748_solve([&](double x) { return below(x) - p; }, low, high,
                                                            boost::math::tools::eps_tolerance<double>(40), steps);
    return 0.5 * (low + high);
  }

  double dof_ = 1.0;
  std::vector<Point> points_;
};

/// Holm's step-down: the i-th smallest p times what is left, never falling.
void correct_by_holm(std::vector<DevicePlace>& places) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < places.size(); ++i) {
    order.emplace_back(places[i].p.value_or(1.0), i);
  }
  std::sort(order.begin(), order.end());  // equal ones stay in the devices' order
  double running = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto& [p, index] = order[rank];
    DevicePlace& place = places[index];
    running = std::max(running, std::min(1.0, p * static_cast<double>(order.size() - rank)));
    place.p_holm = running;
    place.outlying = running < kOutlyingBelow;
  }
}

/// Devices with a closed interval as logs and places; the others with the reason. Error: InvalidArgument (two units).
Result<Logs> sort_devices(const std::vector<DeviceEstimate>& devices, Population& population) {
  Logs logs;
  for (const auto& [device, estimate] : devices) {
    const auto half = estimate.value && *estimate.value > 0.0 ? log_half_width(estimate) : std::nullopt;
    if (!half || !(*half > 0.0)) {
      const bool open = estimate.value.has_value();
      population.left_out.push_back(
          {device, open ? "Its interval is open." : (estimate.reason.empty() ? "Not identified." : estimate.reason)});
      continue;
    }
    if (!population.places.empty() && estimate.unit != population.unit) {
      return fail(ErrorCode::InvalidArgument, "The devices '" + population.places.front().device + "' and '" + device +
                                                  "' were estimated in " + population.unit + " and in " +
                                                  estimate.unit + ". Correct the unit of one of them.");
    }
    population.unit = estimate.unit;
    const double s = *half / kNormal975;
    logs.y.push_back(std::log(*estimate.value));
    logs.variance.push_back(s * s);
    population.places.push_back({device, estimate, 0.0, {}, {}, {}, false});
  }
  return logs;
}

void place_devices(const Logs& logs, double mean, Population& population) {
  constexpr std::size_t kFewest = 4;  // three others give a spread with two degrees of freedom
  for (std::size_t i = 0; i < logs.count(); ++i) {
    DevicePlace& place = population.places[i];
    place.z = (logs.y[i] - mean) / std::sqrt(population.spread * population.spread + logs.variance[i]);
    if (logs.count() >= kFewest) {
      const double below = OverSpreads(logs.without(i)).below(logs.y[i], logs.variance[i]);
      place.quantile = below;
      place.p = std::min(1.0, 2.0 * std::min(below, 1.0 - below));
    }
  }
  if (logs.count() >= kFewest) {
    correct_by_holm(population.places);
  }
}

}  // namespace

double Population::differ_percent() const { return std::round(1000.0 * std::expm1(spread)) / 10.0; }

Result<Population> describe_population(const std::vector<DeviceEstimate>& devices) {
  Population population;
  auto sorted = sort_devices(devices, population);
  if (!sorted) {
    return fail(sorted.error());
  }
  const Logs& logs = *sorted;
  const std::size_t k = logs.count();
  if (k < 2) {
    return fail(ErrorCode::TooFewSamples, "A population needs two devices that identify the parameter; there " +
                                              std::string(k == 0 ? "is none." : "is one."));
  }
  const auto dof = static_cast<double>(k - 1);
  population.heterogeneity_q = weighted(logs, 0.0).squares;
  population.heterogeneity_p = chi_squared_tail(population.heterogeneity_q, dof);
  population.spread = reml_spread(logs);
  const Weighted found = weighted(logs, population.spread);
  const OverSpreads known(logs);
  population.mean = {std::exp(found.mean), std::exp(known.quantile_of_mean(0.025)),
                     std::exp(known.quantile_of_mean(0.975)), population.unit, ""};
  if (k >= 3) {
    population.predicted_low = std::exp(known.quantile(0.025));
    population.predicted_high = std::exp(known.quantile(0.975));
  }
  place_devices(logs, found.mean, population);
  return population;
}

}  // namespace driftlab
