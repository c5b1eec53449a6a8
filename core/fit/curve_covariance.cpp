#include "core/fit/curve_covariance.hpp"

#include "core/process/distributions.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

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

double log_bias(double edf) { return digamma(0.5 * edf) - std::log(0.5 * edf); }

}  // namespace

double CurveCovariance::bias(Eigen::Index j) const { return log_bias(edf(j)); }

CurveCovariance curve_covariance(const Eigen::VectorXd& nu, const Eigen::VectorXd& described,
                                 const BlockDiagonal& covariance) {
  CurveCovariance curve;
  std::vector<double> edf;
  std::vector<double> log_variance;
  std::vector<Eigen::MatrixXd> blocks;
  for (const BlockDiagonal::Block& block : covariance.blocks()) {
    const Eigen::MatrixXd& own = block.matrix;
    std::vector<Eigen::Index> used;  // rows of the block
    for (Eigen::Index j = 0; j < own.rows(); ++j) {
      if (nu(block.first + j) > 0.0) {
        used.push_back(j);
      }
    }
    const auto count = static_cast<Eigen::Index>(used.size());
    Eigen::MatrixXd logarithms(count, count);
    std::vector<LogTerms> terms;
    terms.reserve(used.size());
    for (Eigen::Index j = 0; j < count; ++j) {
      const Eigen::Index row = used[static_cast<std::size_t>(j)];
      const Eigen::Index at = block.first + row;
      const double half_edf = described(at) * described(at) / own(row, row);  // eta/2 = nu^2/Var
      curve.used.push_back(at);
      edf.push_back(2.0 * half_edf);
      log_variance.push_back(std::log(nu(at)) - log_bias(edf.back()));
      terms.push_back(log_terms(half_edf));
      logarithms(j, j) = trigamma(half_edf);
      for (Eigen::Index i = 0; i < j; ++i) {
        const Eigen::Index other = used[static_cast<std::size_t>(i)];
        const double correlation = own(other, row) / std::sqrt(own(other, other) * own(row, row));
        logarithms(i, j) = log_covariance(terms[static_cast<std::size_t>(i)], terms.back(), correlation);
        logarithms(j, i) = logarithms(i, j);
      }
    }
    blocks.push_back(std::move(logarithms));
  }
  const auto rows = static_cast<Eigen::Index>(edf.size());
  curve.edf = Eigen::Map<const Eigen::VectorXd>(edf.data(), rows);
  curve.log_variance = Eigen::Map<const Eigen::VectorXd>(log_variance.data(), rows);
  curve.covariance = BlockDiagonal(std::move(blocks));
  return curve;
}

}  // namespace driftlab
