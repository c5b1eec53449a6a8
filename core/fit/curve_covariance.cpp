#include "core/fit/curve_covariance.hpp"

#include "core/process/distributions.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace driftlab {
namespace {

/// Terms of the covariance of two logarithms of chi-squares of eta degrees of freedom, a = eta/2, in powers of the
/// correlation of the chi-squares (Kibble's expansion): t_k = (k - 1)! Gamma(a)/(k Gamma(a + k)); all of them make
/// psi'(a).
constexpr std::size_t kTerms = 48;
using LogTerms = std::array<double, kTerms>;

LogTerms log_terms(double a) {
  LogTerms terms{};
  double ratio = 1.0 / a;  // (k - 1)! Gamma(a)/Gamma(a + k)
  for (std::size_t i = 0; i < kTerms; ++i) {
    const auto k = static_cast<double>(i + 1);
    terms[i] = std::sqrt(ratio / k);  // the root: two scales give the product of theirs
    ratio *= k / (a + k);
  }
  return terms;
}

double log_covariance(const LogTerms& a, const LogTerms& b, double correlation) {
  double sum = 0.0;
  double power = 1.0;
  for (std::size_t i = 0; i < kTerms; ++i) {
    power *= correlation;
    sum += power * a[i] * b[i];
  }
  return sum;
}

}  // namespace

double CurveCovariance::bias(Eigen::Index j) const { return digamma(0.5 * edf(j)) - std::log(0.5 * edf(j)); }

CurveCovariance curve_covariance(const Eigen::VectorXd& nu, const Eigen::VectorXd& described,
                                 const Eigen::MatrixXd& covariance) {
  CurveCovariance curve;
  for (Eigen::Index j = 0; j < nu.size(); ++j) {
    if (nu(j) > 0.0) {
      curve.used.push_back(j);
    }
  }
  const auto count = static_cast<Eigen::Index>(curve.used.size());
  curve.log_variance.resize(count);
  curve.edf.resize(count);
  curve.covariance.resize(count, count);
  std::vector<LogTerms> terms;
  terms.reserve(curve.used.size());
  for (Eigen::Index j = 0; j < count; ++j) {
    const Eigen::Index row = curve.used[static_cast<std::size_t>(j)];
    const double half_edf = described(row) * described(row) / covariance(row, row);  // eta/2 = nu^2/Var
    curve.edf(j) = 2.0 * half_edf;
    curve.log_variance(j) = std::log(nu(row)) - curve.bias(j);
    terms.push_back(log_terms(half_edf));
    curve.covariance(j, j) = trigamma(half_edf);
    for (Eigen::Index i = 0; i < j; ++i) {
      const Eigen::Index other = curve.used[static_cast<std::size_t>(i)];
      const double correlation = covariance(other, row) / std::sqrt(covariance(other, other) * covariance(row, row));
      curve.covariance(i, j) = log_covariance(terms[static_cast<std::size_t>(i)], terms.back(), correlation);
      curve.covariance(j, i) = curve.covariance(i, j);
    }
  }
  return curve;
}

}  // namespace driftlab
