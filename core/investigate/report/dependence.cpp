#include "core/investigate/report/dependence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kLags = 8;           ///< chosen, not measured, as the next
constexpr std::size_t kFewestMeans = 200;  ///< means, so that their kurtosis has a known law in its tail

double size_of(double score) { return (score * score - 1.0) / std::numbers::sqrt2; }

void keep_larger(Remainder& best, double observed, std::string sentence) {
  best.places += 1.0;
  if (observed > best.observed) {
    best.observed = observed;
    best.sentence = std::move(sentence);
  }
}

std::string lag_in_words(std::size_t k) { return k == 1 ? "a sample" : std::to_string(k) + " samples"; }

/// Central moments of the means of m values in a row.
struct Shape {
  double count = 0.0, skewness = 0.0, kurtosis = 0.0;
};

Shape shape_of_means(const std::vector<double>& sum, std::size_t m) {
  const std::size_t blocks = (sum.size() - 1) / m;
  const auto mean_of = [&](std::size_t b) { return (sum[(b + 1) * m] - sum[b * m]) / static_cast<double>(m); };
  double mean = 0.0;
  for (std::size_t b = 0; b < blocks; ++b) {
    mean += mean_of(b) / static_cast<double>(blocks);
  }
  double second = 0.0;
  double third = 0.0;
  double fourth = 0.0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const double d = mean_of(b) - mean;
    second += d * d;
    third += d * d * d;
    fourth += d * d * d * d;
  }
  const auto n = static_cast<double>(blocks);
  second /= n;
  return {n, third / n / std::pow(second, 1.5), fourth / n / (second * second)};
}

/// Of a sample skewness of n Gaussian values (D'Agostino, Biometrika 57, 1970).
double z_of_skewness(double skewness, double n) {
  const double y = skewness * std::sqrt((n + 1.0) * (n + 3.0) / (6.0 * (n - 2.0)));
  const double b =
      3.0 * (n * n + 27.0 * n - 70.0) * (n + 1.0) * (n + 3.0) / ((n - 2.0) * (n + 5.0) * (n + 7.0) * (n + 9.0));
  const double w2 = std::sqrt(2.0 * (b - 1.0)) - 1.0;
  const double a = std::sqrt(2.0 / (w2 - 1.0));
  return std::asinh(y / a) / std::sqrt(0.5 * std::log(w2));
}

/// Of a sample kurtosis of n Gaussian values (Anscombe and Glynn, Biometrika 70, 1983).
double z_of_kurtosis(double kurtosis, double n) {
  const double mean = 3.0 * (n - 1.0) / (n + 1.0);
  const double variance = 24.0 * n * (n - 2.0) * (n - 3.0) / ((n + 1.0) * (n + 1.0) * (n + 3.0) * (n + 5.0));
  const double x = (kurtosis - mean) / std::sqrt(variance);
  const double skew = 6.0 * (n * n - 5.0 * n + 2.0) / ((n + 7.0) * (n + 9.0)) *
                      std::sqrt(6.0 * (n + 3.0) * (n + 5.0) / (n * (n - 2.0) * (n - 3.0)));
  const double a = 6.0 + 8.0 / skew * (2.0 / skew + std::sqrt(1.0 + 4.0 / (skew * skew)));
  const double ratio = (1.0 - 2.0 / a) / (1.0 + x * std::sqrt(2.0 / (a - 4.0)));
  return (1.0 - 2.0 / (9.0 * a) - std::cbrt(ratio)) / std::sqrt(2.0 / (9.0 * a));
}

}  // namespace

Remainder dependence_over_time(const std::vector<double>& score, const std::vector<unsigned char>& used,
                               const std::string& name) {
  Remainder best;
  best.places = 0.0;
  for (std::size_t k = 1; k <= kLags && k < score.size(); ++k) {
    double sizes = 0.0;
    double lean = 0.0;
    double grow = 0.0;
    double n = 0.0;
    for (std::size_t i = k; i < score.size(); ++i) {
      if (used[i] != 0 && used[i - k] != 0) {
        n += 1.0;
        sizes += size_of(score[i]) * size_of(score[i - k]);
        lean += score[i] * size_of(score[i - k]);
        grow += size_of(score[i]) * score[i - k];
      }
    }
    const auto surprise = [&](double sum) { return n > 0.0 ? 0.5 * sum * sum / n : 0.0; };
    const auto of_correlation = [&](double sum) { return " (correlation " + three_digits(sum / n) + ")"; };
    keep_larger(best, surprise(sizes),
                name + ": errors are " + (sizes > 0.0 ? "larger " : "smaller ") + lag_in_words(k) +
                    " after a large one" + of_correlation(sizes));
    keep_larger(best, surprise(lean),
                name + ": errors lean to one side " + lag_in_words(k) + " after a large one" + of_correlation(lean));
    keep_larger(best, surprise(grow),
                name + ": errors are larger " + lag_in_words(k) + " after one to one side" + of_correlation(grow));
  }
  return best;
}

Remainder slow_distribution(const std::vector<double>& score, double dt_s, const std::string& name) {
  std::vector<double> sum(score.size() + 1, 0.0);
  for (std::size_t i = 0; i < score.size(); ++i) {
    sum[i + 1] = sum[i] + score[i];
  }
  Remainder best;
  best.places = 0.0;
  for (std::size_t m = 4; m * kFewestMeans <= score.size(); m *= 4) {
    const Shape shape = shape_of_means(sum, m);
    const double skewed = z_of_skewness(shape.skewness, shape.count);
    const double tailed = z_of_kurtosis(shape.kurtosis, shape.count);
    const std::string means = name + ": means over " + three_digits(static_cast<double>(m) * dt_s) + " s ";
    keep_larger(
        best, 0.5 * skewed * skewed,
        means + "are farther off to one side than to the other (skewness " + three_digits(shape.skewness) + ")");
    keep_larger(best, 0.5 * tailed * tailed,
                means + "are far off " + (tailed > 0.0 ? "more" : "less") + " often than Gaussian ones (kurtosis " +
                    three_digits(shape.kurtosis) + ")");
  }
  best.places = std::max(best.places, 1.0);
  return best;
}

Remainder shared_loudness(const Series& a, const Series& b, const std::string& name) {
  const std::size_t n = std::min(a.size(), b.size());
  const auto cut = [](double value) { return std::clamp(value, -4.0, 4.0); };
  double aa = 0.0;
  double bb = 0.0;
  double ab = 0.0;
  double fourth_a = 0.0;
  double fourth_b = 0.0;
  double both = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = cut(a[i]) * cut(a[i]);
    const double y = cut(b[i]) * cut(b[i]);
    aa += x;
    bb += y;
    ab += cut(a[i]) * cut(b[i]);
    fourth_a += x * x;
    fourth_b += y * y;
    both += x * y;
  }
  const auto count = static_cast<double>(n);
  const double variance_a = fourth_a / count - aa * aa / count / count;
  const double variance_b = fourth_b / count - bb * bb / count / count;
  Remainder best;
  if (!(variance_a > 0.0) || !(variance_b > 0.0)) {
    return best;
  }
  // Of jointly Gaussian values the squares covary by 2 (cov)^2.
  const double covariance = both / count - aa * bb / count / count - 2.0 * std::pow(ab / count, 2.0);
  const double r = covariance / std::sqrt(variance_a * variance_b);
  best.observed = 0.5 * count * r * r;
  best.sentence = name + ": the two are " + (r > 0.0 ? "loud at the same time" : "loud in turns") +
                  " (correlation of squares " + three_digits(r) + ")";
  return best;
}

}  // namespace driftlab::investigate
