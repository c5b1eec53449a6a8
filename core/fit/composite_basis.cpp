#include "core/fit/composite_basis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab {
namespace {

/// ln of what is no variance at all.
constexpr double kNothing = -700.0;
/// Cycles per sample below which a process must be flat to count as fast; the frequency that stands for 0.
constexpr double kFlatTo = 1.0 / 30.0;
constexpr double kZero = 1e-12;
constexpr double kStep = 1e-4;
constexpr double kLineWidth = 0.15;

double safe_log(double x) { return x > 0.0 ? std::max(kNothing, std::log(x)) : kNothing; }

/// ln of the density at frequency 0: the limit where the kind knows it.
double log_at_zero(const Process& process, double dt_s) {
  if (const auto low = process.low_frequency(dt_s)) {
    return safe_log(low->density);
  }
  const std::optional<double> density = process.spectral_density(kZero / dt_s, dt_s);
  return density ? safe_log(*density) : kNothing;
}

}  // namespace

CompositeBasis::CompositeBasis(std::shared_ptr<const SpectralTable> table, std::vector<CompositeKind> kinds,
                               double dt_s)
    : table_(std::move(table)), kinds_(std::move(kinds)), dt_s_(dt_s) {
  const Eigen::Index rows = table_->scales() + 1;
  half_.assign(table_->half().begin(), table_->half().end());
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    const CompositeKind& kind = kinds_[k];
    const std::size_t nodes = kind.shapes() == 0 ? 1 : kind.nodes;
    Table& made = tables_.emplace_back();
    if (kind.shapes() > 1 || kind.at_lines_only) {
      continue;  // looked for at lines only
    }
    made.value.resize(rows, static_cast<Eigen::Index>(nodes));
    for (std::size_t i = 0; i < nodes; ++i) {
      Component at{k, 0.0, {}};
      if (kind.shapes() > 0) {
        const auto [low, high] = kind.log_range[0];
        made.log_shape.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(nodes - 1));
        at.log_shape[0] = made.log_shape.back();
      }
      Eigen::VectorXd column;
      evaluate(at, column);
      made.value.col(static_cast<Eigen::Index>(i)) = column;
    }
    if (kind.shapes() == 0 || !kind.smooth) {
      continue;
    }
    const double h = made.log_shape[1] - made.log_shape[0];
    const auto count = static_cast<Eigen::Index>(nodes);
    made.slope.resize(rows, count);
    const auto at = [&](Eigen::Index i) { return made.value.col(i); };
    for (Eigen::Index i = 0; i < count; ++i) {
      if (i >= 2 && i + 2 < count) {
        made.slope.col(i) = (8.0 * (at(i + 1) - at(i - 1)) - (at(i + 2) - at(i - 2))) / (12.0 * h);
      } else if (i < 2) {
        made.slope.col(i) = (-3.0 * at(i) + 4.0 * at(i + 1) - at(i + 2)) / (2.0 * h);
      } else {
        made.slope.col(i) = (3.0 * at(i) - 4.0 * at(i - 1) + at(i - 2)) / (2.0 * h);
      }
    }
  }
}

std::pair<double, double> CompositeBasis::range(const Component& component, std::size_t s) const {
  const auto [low, high] = kinds_[component.kind].log_range[s];
  if (s > 0 || !component.line) {
    return {low, high};
  }
  return {std::max(low, *component.line - kLineWidth), std::min(high, *component.line + kLineWidth)};
}

Process CompositeBasis::process(const Component& component) const {
  const CompositeKind& kind = kinds_[component.kind];
  Process process{kind.kind, {std::exp(0.5 * component.log_square)}};
  for (std::size_t s = 0; s < kind.shapes(); ++s) {
    process.parameters.push_back(std::exp(component.log_shape[s]));
  }
  return process;
}

void CompositeBasis::evaluate(const Component& component, Eigen::VectorXd& out) const {
  const Eigen::Index scales = table_->scales();
  const Component unit{component.kind, 0.0, component.log_shape};
  const Process process = this->process(unit);
  out.resize(scales + 1);
  out(scales) = log_at_zero(process, dt_s_);
  if (process.kind->haar_curve != nullptr) {
    process.haar_curve(half_, dt_s_, std::span(out.data(), half_.size()));
  } else {
    out.head(scales) = table_->variance(density(unit));
  }
  for (Eigen::Index j = 0; j < scales; ++j) {
    out(j) = safe_log(out(j));
  }
}

void CompositeBasis::differentiate(const Component& component, LogColumn& out) const {
  const CompositeKind& kind = kinds_[component.kind];
  const Eigen::Index scales = table_->scales();
  const Process process = this->process({component.kind, 0.0, component.log_shape});
  const bool closed = kind.kind->haar_curve != nullptr;
  const std::size_t parameters = process.parameters.size();
  std::vector<double> gradient;
  if (closed) {
    gradient.resize(half_.size() * parameters);
    out.value.resize(scales + 1);
    process.haar_curve(half_, dt_s_, std::span(out.value.data(), half_.size()), gradient);
    for (Eigen::Index j = 0; j < scales; ++j) {
      out.value(j) = safe_log(out.value(j));
    }
    out.value(scales) = log_at_zero(process, dt_s_);
  } else {
    evaluate(component, out.value);
  }
  for (std::size_t s = 0; s < kind.shapes(); ++s) {
    Component beside = component;
    const double step = component.log_shape[s] + kStep > range(component, s).second ? -kStep : kStep;
    beside.log_shape[s] += step;
    if (!closed) {
      evaluate(beside, out.slope[s]);
      out.slope[s] = (out.slope[s] - out.value) / step;
      continue;
    }
    out.slope[s].resize(scales + 1);
    const double level = log_at_zero(this->process({component.kind, 0.0, beside.log_shape}), dt_s_);
    out.slope[s](scales) = (level - out.value(scales)) / step;
    for (Eigen::Index j = 0; j < scales; ++j) {
      out.slope[s](j) = gradient[static_cast<std::size_t>(j) * parameters + s + 1] * process.parameters[s + 1] *
                        std::exp(-out.value(j));
    }
  }
}

Eigen::VectorXd CompositeBasis::density(const Component& component) const {
  const std::vector<double>& f = table_->frequencies();
  Eigen::VectorXd result(static_cast<Eigen::Index>(f.size()));
  const Process process = this->process(component);
  for (std::size_t b = 0; b < f.size(); ++b) {
    result(static_cast<Eigen::Index>(b)) = process.spectral_density(f[b] / dt_s_, dt_s_).value_or(0.0) / dt_s_;
  }
  return result;
}

Eigen::VectorXd CompositeBasis::density(const Composite& model) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(table_->frequencies().size()));
  for (const Component& component : model) {
    sum += density(component);
  }
  return sum;
}

Eigen::VectorXd CompositeBasis::variance(const Composite& model) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(table_->scales());
  LogColumn column_of;
  for (const Component& component : model) {
    column(component, false, column_of);
    sum.array() += (component.log_square + column_of.value.head(sum.size()).array()).exp();
  }
  return sum;
}

void CompositeBasis::column(const Component& component, bool with_slopes, LogColumn& out) const {
  const CompositeKind& kind = kinds_[component.kind];
  const Table& table = tables_[component.kind];
  if (kind.shapes() == 0) {
    out.value = table.value.col(0);
    return;
  }
  if (table.slope.size() == 0) {
    if (with_slopes) {
      differentiate(component, out);
    } else {
      evaluate(component, out.value);
    }
    return;
  }
  const double h = table.log_shape[1] - table.log_shape[0];
  const double place = std::clamp((component.log_shape[0] - table.log_shape[0]) / h, 0.0,
                                  static_cast<double>(table.log_shape.size() - 1));
  const auto i = std::min(static_cast<Eigen::Index>(place), static_cast<Eigen::Index>(table.log_shape.size()) - 2);
  const double t = place - static_cast<double>(i);
  const auto from = table.value.col(i);
  const auto to = table.value.col(i + 1);
  const auto rise_from = table.slope.col(i);
  const auto rise_to = table.slope.col(i + 1);
  const double a = (1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t);
  const double b = t * (1.0 - t) * (1.0 - t);
  const double c = t * t * (3.0 - 2.0 * t);
  const double d = t * t * (t - 1.0);
  out.value = a * from + c * to + h * (b * rise_from + d * rise_to);
  if (with_slopes) {
    out.slope[0] = (6.0 * t * (1.0 - t) / h) * (to - from) + (1.0 - t) * (1.0 - 3.0 * t) * rise_from +
                   t * (3.0 * t - 2.0) * rise_to;
  }
}

bool CompositeBasis::is_fast(const Component& component) const {
  const Process process = this->process(component);
  const std::optional<double> at_zero = process.spectral_density(kZero / dt_s_, dt_s_);
  const std::optional<double> beside = process.spectral_density(kFlatTo / dt_s_, dt_s_);
  return at_zero && beside && std::isfinite(*at_zero) && *at_zero > 0.0 && *beside >= 0.5 * *at_zero &&
         *beside <= 2.0 * *at_zero;
}

}  // namespace driftlab
