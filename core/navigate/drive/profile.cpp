#include "core/navigate/drive/profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace driftlab::drive {
namespace {

constexpr std::size_t kRemembered = 64;
constexpr double kMostLevel = 1e4, kLeastLevel = 1e-2;  ///< factors of the model's noise, chosen
constexpr double kParabolic = 1.3;  ///< a likelihood is a parabola of the logarithm of a level within this factor

}  // namespace

std::vector<std::optional<LogLikelihood>> Profile::runs(const std::vector<FilterOptions>& trials) const {
  std::vector<std::size_t> place;
  const std::size_t before = known_.size();
  for (const FilterOptions& trial : trials) {
    const auto same = [&](const Run& run) { return run.options == trial; };
    const auto found = std::find_if(known_.begin(), known_.end(), same);
    place.push_back(static_cast<std::size_t>(found - known_.begin()));
    if (found == known_.end()) {
      known_.push_back({trial, std::nullopt});
    }
  }
  parallel_for(
      control_.threads, known_.size() - before,
      [&](std::size_t i) {
        Run& run = known_[before + i];
        if (auto found = log_likelihood(drive_, run.options)) {
          run.likelihood = *std::move(found);
        }
      },
      control_.stop);
  std::vector<std::optional<LogLikelihood>> found(trials.size());
  std::transform(place.begin(), place.end(), found.begin(), [&](std::size_t i) { return known_[i].likelihood; });
  const std::size_t oldest = known_.size() - std::min(known_.size(), kRemembered);
  known_.erase(known_.begin(), known_.begin() + static_cast<std::ptrdiff_t>(oldest));
  return found;
}

std::vector<double> Profile::values(const std::vector<FilterOptions>& trials) const {
  std::vector<double> sums;
  for (const std::optional<LogLikelihood>& found : runs(trials)) {
    sums.push_back(found ? found->over(used_) : -std::numeric_limits<double>::infinity());
  }
  return sums;
}

FilterOptions Profile::turned(const FilterOptions& options, const Knob& knob, double by) {
  FilterOptions copy = options;
  knob.turn(copy, by);
  return copy;
}

double Profile::scale(const FilterOptions& options) const {
  const std::optional<LogLikelihood> found = runs({options}).front();
  return found ? 3.0 * std::max(found->mean_square(used_), 0.1) : 3.0;
}

std::vector<ProfileEstimate> Profile::estimates(const FilterOptions& options, double at,
                                                const std::vector<const Knob*>& knobs, double scale) const {
  std::vector<FilterOptions> trials;
  for (const Knob* knob : knobs) {
    trials.push_back(turned(options, *knob, -knob->step));
    trials.push_back(turned(options, *knob, knob->step));
  }
  const std::vector<double> sums = values(trials);
  std::vector<ProfileEstimate> estimates(knobs.size());
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    const Knob& knob = *knobs[i];
    const Bracket first{-knob.step, 0.0, knob.step, sums[2 * i], at, sums[2 * i + 1]};
    const Bracket bracket = stride(options, knob, first);
    estimates[i] = parabola(bracket, scale);
    const auto [down, up] = range(options, knob);
    const double within = std::clamp(estimates[i].value, down, up);
    if (within != estimates[i].value && estimates[i].se > 0.0) {
      const double beyond = (estimates[i].value - within) / estimates[i].se;
      estimates[i].top -= 0.5 * scale * beyond * beyond;
      estimates[i].value = within;
    }
    if (knob.share) {
      settle_share(options, knob, bracket, scale, estimates[i]);
    }
    estimates[i].scatter = estimates[i].se;
    if (knob.systematic != nullptr) {
      estimates[i].se = std::hypot(estimates[i].se, knob.systematic(drive_, options));
    }
    estimates[i].score = std::max(estimates[i].gain_to(at), 0.0) / scale;
  }
  return estimates;
}

void Profile::settle_share(const FilterOptions& options, const Knob& knob, const Bracket& bracket, double scale,
                           ProfileEstimate& estimate) const {
  const double present = knob.value(options);
  if (!estimate.sound) {  // the likelihood of a share bends upwards where nearly all of the whole is of its kind
    const std::array<std::pair<double, double>, 3> tried{
        {{bracket.low_value, bracket.low}, {bracket.middle_value, bracket.middle}, {bracket.high_value, bracket.high}}};
    const auto [value, at] = *std::max_element(tried.begin(), tried.end());
    const auto [down, up] = range(options, knob);
    estimate.value = std::clamp(at, down, up);
    estimate.sound = std::isfinite(value);
  }
  const auto ends = values({turned(options, knob, estimate.value), turned(options, knob, -present)});
  estimate.top = ends[0];
  estimate.se = se_against_none(present + estimate.value, ends[0] - ends[1], scale);
}

double Profile::se_against_none(double share, double gain, double scale) {
  return gain > 0.0 ? std::abs(share) / std::sqrt(2.0 * gain / scale) : std::numeric_limits<double>::infinity();
}

std::array<double, 2> Profile::range(const FilterOptions& options, const Knob& knob) const {
  const double set = change(options, knob);
  return {knob.share ? -knob.value(options) : -knob.most - set, knob.most - set};
}

Profile::Bracket Profile::stride(const FilterOptions& options, const Knob& knob, Bracket bracket) const {
  const auto [least, most] = range(options, knob);
  while (bracket.middle_value < std::max(bracket.low_value, bracket.high_value)) {
    const bool up = bracket.high_value > bracket.low_value;
    const double edge = up ? bracket.high : bracket.low;
    const double beyond = edge + 2.0 * (edge - bracket.middle);
    const double next = knob.share ? std::clamp(beyond, least, most) : beyond;
    const bool ends = next < least || next > most || (up ? next <= edge : next >= edge);
    if (ends || control_.stop.stop_requested()) {
      return bracket;
    }
    const double value = values({turned(options, knob, next)}).front();
    if (up) {
      bracket = {bracket.middle, bracket.high, next, bracket.middle_value, bracket.high_value, value};
    } else {
      bracket = {next, bracket.low, bracket.middle, value, bracket.low_value, bracket.middle_value};
    }
  }
  return bracket;
}

ProfileEstimate Profile::parabola(const Bracket& b, double scale) {
  ProfileEstimate estimate;
  const double left = (b.middle_value - b.low_value) / (b.middle - b.low);
  const double right = (b.high_value - b.middle_value) / (b.high - b.middle);
  const double curvature = -2.0 * (right - left) / (b.high - b.low);
  if (!(curvature > 0.0) || !std::isfinite(curvature)) {
    return estimate;
  }
  // The slope in the middle of the left half is `left`.
  estimate.value = std::clamp(0.5 * (b.low + b.middle) + left / curvature, b.low, b.high);
  estimate.se = std::sqrt(scale / curvature);
  const double from_middle = estimate.value - b.middle;
  const double slope = left - curvature * 0.5 * (b.middle - b.low);
  estimate.top = b.middle_value + slope * from_middle - 0.5 * curvature * from_middle * from_middle;
  estimate.sound = true;
  return estimate;
}

FilterOptions Profile::with_noise_fitted(FilterOptions options, double first_factor) const {
  // Levels that were fitted before a cause was set can lie where the likelihood is flat (0.01 of the gyroscope's beside
  // 3.5 times the accelerometer's under a mounting that is 2 deg off), out of reach of the steps from the model's.
  std::vector<FilterOptions> starts{options, options, options, options};
  starts[1].gyro_noise = starts[3].gyro_noise = 1.0;
  starts[2].force_noise = starts[3].force_noise = 1.0;
  const std::vector<double> of_starts = values(starts);
  const auto start = std::max_element(of_starts.begin(), of_starts.end()) - of_starts.begin();
  if (start != 0) {
    options = starts[static_cast<std::size_t>(start)];
    first_factor = std::max(first_factor, 2.0);
  }
  for (const bool gyroscope : {true, false, true}) {
    options = with_level_fitted(std::move(options), gyroscope, first_factor);
    first_factor = std::min(first_factor, 2.0);
  }
  return options;
}

FilterOptions Profile::with_level_fitted(FilterOptions options, bool gyroscope, double factor) const {
  const auto level = [&](FilterOptions& of) -> double& { return gyroscope ? of.gyro_noise : of.force_noise; };
  const auto times = [&](double by) {
    FilterOptions copy = options;
    level(copy) *= by;
    return copy;
  };
  double best = values({options}).front();
  while (!control_.stop.stop_requested()) {
    const std::vector<FilterOptions> trials{times(1.0 / factor), times(factor)};
    const auto tried = values(trials);
    const std::size_t better = tried[1] > tried[0] ? 1 : 0;
    const double set = level(options);
    if (tried[better] > best && set * factor < kMostLevel && set / factor > kLeastLevel) {
      options = trials[better];
      best = tried[better];
    } else if (factor > kParabolic) {
      factor = std::sqrt(factor);
    } else {
      const double step = std::log(factor);
      const ProfileEstimate top = parabola({-step, 0.0, step, tried[0], best, tried[1]}, 1.0);
      const FilterOptions there = times(std::exp(top.value));
      return top.sound && values({there}).front() > best ? there : options;
    }
  }
  return options;
}

FilterOptions Profile::refitted(FilterOptions options, const std::vector<const Knob*>& knobs, int sweeps) const {
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (const Knob* knob : knobs) {
      const double at = values({options}).front();
      const auto estimate = estimates(options, at, {knob}, 3.0).front();
      if (estimate.sound) {
        FilterOptions tried = turned(options, *knob, estimate.value);
        if (values({tried}).front() > at) {
          options = std::move(tried);
        }
      }
    }
  }
  return options;
}

}  // namespace driftlab::drive
