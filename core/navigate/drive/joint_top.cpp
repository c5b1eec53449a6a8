#include "core/navigate/drive/joint_top.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace driftlab::drive {
namespace {

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

/// The options with a knob turned by `steps` times `step`.
FilterOptions turned(const FilterOptions& options, const Knob& knob, double step, double steps) {
  const double value = knob.value(options);
  const bool by_ratio = (knob.magnitude || knob.companion) && value != 0.0;
  const double by = by_ratio ? value * std::expm1(steps * step / std::abs(value)) : steps * step;
  return Profile::turned(options, knob, by);
}

}  // namespace

JointTop::JointTop(const Profile& profile, const FilterOptions& options, const std::vector<const Knob*>& knobs,
                   const std::vector<double>& steps, double scale)
    : profile_(profile), options_(options), knobs_(knobs), steps_(steps), scale_(scale) {
  std::vector<std::size_t> asked;
  std::vector<FilterOptions> trials{options};
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    if (steps[i] > 0.0) {
      asked.push_back(i);
      trials.push_back(turned(options, *knobs[i], steps[i], 1.0));
      trials.push_back(turned(options, *knobs[i], steps[i], -1.0));
    }
  }
  for (std::size_t a = 0; a < asked.size(); ++a) {
    const FilterOptions one = trials[1 + 2 * a];
    for (std::size_t b = a + 1; b < asked.size(); ++b) {
      trials.push_back(turned(one, *knobs[asked[b]], steps[asked[b]], 1.0));
    }
  }
  const std::vector<double> f = profile.values(trials);
  top_ = f[0];
  curvature_ = Eigen::MatrixXd::Zero(index(knobs.size()), index(knobs.size()));
  slope_ = Eigen::VectorXd::Zero(index(knobs.size()));
  std::size_t pair = 1 + 2 * asked.size();
  for (std::size_t a = 0; a < asked.size(); ++a) {
    const Eigen::Index i = index(asked[a]);
    const double up = f[1 + 2 * a];
    const double down = f[2 + 2 * a];
    curvature_(i, i) = -(up + down - 2.0 * top_);
    slope_(i) = 0.5 * (up - down);
    for (std::size_t b = a + 1; b < asked.size(); ++b) {
      const Eigen::Index j = index(asked[b]);
      curvature_(i, j) = curvature_(j, i) = -(f[pair] - up - f[1 + 2 * b] + top_);
      ++pair;
    }
  }
  std::copy_if(asked.begin(), asked.end(), std::back_inserter(turned_), [&](std::size_t knob) {
    return curvature_(index(knob), index(knob)) > 0.0 && curvature_.col(index(knob)).allFinite();
  });
  directions_ = directions_of(turned_);
  for (Direction& direction : directions_) {
    if (direction.curvature < kWeak) {
      measure(direction);
    }
  }
}

std::vector<JointTop::Direction> JointTop::directions_of(const std::vector<std::size_t>& which) const {
  const std::size_t n = which.size();
  if (n == 0) {
    return {};
  }
  Eigen::MatrixXd correlation(index(n), index(n));
  Eigen::VectorXd root(index(n));
  Eigen::VectorXd slope(index(n));
  for (std::size_t a = 0; a < n; ++a) {
    root(index(a)) = std::sqrt(curvature_(index(which[a]), index(which[a])));
    slope(index(a)) = slope_(index(which[a]));
  }
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      correlation(index(a), index(b)) =
          curvature_(index(which[a]), index(which[b])) / (root(index(a)) * root(index(b)));
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation);
  std::vector<Direction> directions;
  for (std::size_t k = 0; k < n; ++k) {
    Direction direction;
    direction.steps = eigen.eigenvectors().col(index(k)).cwiseQuotient(root);
    direction.curvature = eigen.eigenvalues()(index(k));
    direction.slope = direction.steps.dot(slope);
    directions.push_back(std::move(direction));
  }
  return directions;
}

FilterOptions JointTop::along(const Direction& direction, double length, FilterOptions from) const {
  for (std::size_t a = 0; a < turned_.size(); ++a) {
    from = turned(from, *knobs_[turned_[a]], steps_[turned_[a]], length * direction.steps(index(a)));
  }
  return from;
}

double JointTop::outside(std::size_t knob, const FilterOptions& there) const {
  const auto [least, most] = profile_.range(options_, *knobs_[knob]);
  const double by = knobs_[knob]->value(there) - knobs_[knob]->value(options_);
  return std::clamp(by, least, most) - by;
}

void JointTop::measure(Direction& direction) const {
  const auto inside = [&](double length) {
    const FilterOptions there = along(direction, length, options_);
    return std::all_of(turned_.begin(), turned_.end(), [&](std::size_t knob) { return outside(knob, there) == 0.0; });
  };
  bool measured = false;
  double length = std::sqrt(scale_ / std::max(direction.curvature, kFlat));
  for (int stride = 0; stride < kStrides && inside(length) && inside(-length); ++stride) {
    const std::vector<double> f =
        profile_.values({along(direction, length, options_), along(direction, -length, options_)});
    const double fall = top_ - 0.5 * (f[0] + f[1]);
    if (!std::isfinite(fall)) {
      break;
    }
    direction.slope = 0.5 * (f[0] - f[1]) / length;
    measured = true;
    direction.curvature = 2.0 * std::max(fall, 0.05 * scale_) / (length * length);
    if (fall > 0.2 * scale_) {
      break;
    }
    length *= 2.0;
  }
  direction.curvature = std::max(direction.curvature, measured ? 0.0 : kFlat);
}

FilterOptions JointTop::at_top() const {
  FilterOptions top = options_;
  for (const Direction& direction : directions_) {
    const double farthest = kFarthest * std::sqrt(scale_ / direction.curvature);
    const double length = std::clamp(direction.slope / direction.curvature, -farthest, farthest);
    top = along(direction, length, std::move(top));
  }
  for (const std::size_t knob : turned_) {
    knobs_[knob]->turn(top, outside(knob, top));
  }
  return top;
}

double JointTop::se_over(std::size_t knob, const std::vector<std::size_t>& which,
                         const std::vector<Direction>& directions) const {
  const auto place = std::find(which.begin(), which.end(), knob);
  if (place == which.end()) {
    return 0.0;
  }
  double variance = 0.0;
  for (const Direction& direction : directions) {
    const double steps = direction.steps(place - which.begin());
    variance += scale_ * steps * steps / direction.curvature;
  }
  return steps_[knob] * std::sqrt(variance);
}

double JointTop::se(std::size_t knob) const { return se_over(knob, turned_, directions_); }

double JointTop::se_beside_companions(std::size_t knob) const {
  std::vector<std::size_t> which;
  std::copy_if(turned_.begin(), turned_.end(), std::back_inserter(which), [&](std::size_t other) {
    return other == knob || !knobs_[other]->companion || knobs_[other]->cause != knobs_[knob]->cause;
  });
  if (which.size() == turned_.size()) {
    return se(knob);
  }
  std::vector<Direction> directions = directions_of(which);
  for (Direction& direction : directions) {
    direction.curvature = std::max(direction.curvature, kFlat);
  }
  return se_over(knob, which, directions);
}

}  // namespace driftlab::drive
