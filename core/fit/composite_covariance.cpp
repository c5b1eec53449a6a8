#include "core/fit/composite_covariance.hpp"

#include "core/variance/haar_covariance.hpp"
#include "core/variance/nonnegative_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace driftlab {
namespace {

/// Records of more than this many half lengths are long enough for the table.
constexpr std::size_t kShort = 32;

}  // namespace

CurveCovariance CompositeCovariance::of_model(const Composite& model) const {
  const Eigen::VectorXd nu = basis_.variance(model);
  Eigen::MatrixXd covariance = basis_.table().covariance(basis_.density(model));
  add_kurtosis(model, covariance);
  covariance = raise_.asDiagonal() * covariance * raise_.asDiagonal();
  // Processes without a density scatter nothing, but no variance is known better than to rounding.
  covariance.diagonal().array() += 1e-12 * nu.array().square();
  return curve_covariance(curve_.variance, nu, covariance);
}

void CompositeCovariance::add_kurtosis(const Composite& model, Eigen::MatrixXd& covariance) const {
  if (curve_.shape.kurtosis == 0.0) {
    return;
  }
  Composite part;
  for (const Component& component : model) {
    const bool rough = basis_.is_fast(component) || basis_.kinds()[component.kind].kind->differenced_square != nullptr;
    if (rough == curve_.shape.rough) {
      part.push_back(component);
    }
  }
  driftlab::add_kurtosis(covariance, basis_.variance(part), basis_.table().half(), basis_.table().samples(),
                         curve_.shape.kurtosis);
}

CurveCovariance CompositeCovariance::of_mixture() {
  Composite all;
  for (std::size_t k = 0; k < basis_.kinds().size(); ++k) {
    const CompositeKind& kind = basis_.kinds()[k];
    if (kind.kind->slope != nullptr || kind.at_lines_only || kind.shapes() > 1) {
      continue;
    }
    if (kind.shapes() == 0) {
      all.push_back({k, 0.0, {}});
      continue;
    }
    const std::span<const double> scan = basis_.scan(k);
    const std::size_t step = kind.repeats ? 5 : 12;
    for (std::size_t i = step / 2; i < scan.size(); i += step) {
      all.push_back({k, 0.0, {scan[i]}});
    }
  }
  const Eigen::Index scales = basis_.table().scales();
  Eigen::MatrixXd columns(scales, static_cast<Eigen::Index>(all.size()));
  LogColumn column;
  for (std::size_t c = 0; c < all.size(); ++c) {
    basis_.column(all[c], false, column);
    columns.col(static_cast<Eigen::Index>(c)) = column.value.head(scales).array().exp();
  }
  // Degrees of freedom as if white: the number of filters side by side.
  Eigen::VectorXd weight(scales);
  for (Eigen::Index j = 0; j < scales; ++j) {
    const auto m = static_cast<double>(basis_.table().half()[static_cast<std::size_t>(j)]);
    weight(j) = std::min(std::sqrt(static_cast<double>(basis_.table().samples()) / m), 300.0);
  }
  Eigen::VectorXd fitted = curve_.variance;
  Composite mixture;
  for (int round = 0; round < 3; ++round) {
    const Eigen::VectorXd scale = weight.cwiseQuotient(fitted.cwiseMax(1e-300));
    const NonnegativeSolution solution =
        nonnegative_least_squares(scale.asDiagonal() * columns, scale.asDiagonal() * curve_.variance);
    mixture.clear();
    for (std::size_t c = 0; c < all.size(); ++c) {
      const double level = solution.x(static_cast<Eigen::Index>(c));
      if (level > 0.0) {
        mixture.push_back(all[c]);
        mixture.back().log_square = std::log(level);
      }
    }
    fitted = columns * solution.x;
  }
  correct_long_scales(mixture);
  return of_model(mixture);
}

void CompositeCovariance::correct_long_scales(const Composite& mixture) {
  const SpectralTable& table = basis_.table();
  raise_ = curve_.raise.size() > 0 ? curve_.raise : Eigen::VectorXd::Ones(table.scales());
  const auto first = std::find_if(table.half().begin(), table.half().end(),
                                  [&](std::size_t m) { return kShort * m > table.samples(); });
  const auto from = first - table.half().begin();
  Model model;
  Composite lawful;
  for (const Component& component : mixture) {
    if (basis_.kinds()[component.kind].kind->add_haar_cross != nullptr) {
      model.push_back(basis_.process(component));
      lawful.push_back(component);
    }
  }
  if (first == table.half().end() || model.empty()) {
    return;
  }
  HaarCovariance plan(std::span(table.half()).subspan(static_cast<std::size_t>(from)), table.samples(), basis_.dt_s());
  const Eigen::VectorXd exact = plan.diagonal(model);
  const Eigen::VectorXd nearly = table.covariance(basis_.density(lawful)).diagonal().tail(exact.size());
  raise_.tail(exact.size()).array() *= (exact.array() / nearly.array()).sqrt();
}

}  // namespace driftlab
