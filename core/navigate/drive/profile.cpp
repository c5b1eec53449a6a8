#include "core/navigate/drive/profile.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace driftlab::drive {
namespace {

constexpr std::ptrdiff_t kRemembered = 64;

}  // namespace

std::vector<std::optional<LogLikelihood>> Profile::runs(const std::vector<FilterOptions>& trials) const {
  const auto known = [&](const FilterOptions& options) {
    return std::find_if(known_.begin(), known_.end(), [&](const Known& one) { return one.options == options; });
  };
  std::vector<Known> fresh;
  for (const FilterOptions& trial : trials) {
    const bool asked = std::any_of(fresh.begin(), fresh.end(), [&](const Known& one) { return one.options == trial; });
    if (!asked && known(trial) == known_.end()) {
      fresh.push_back({trial, std::nullopt});
    }
  }
  parallel_for(
      control_.threads, fresh.size(),
      [&](std::size_t i) {
        if (auto found = log_likelihood(drive_, fresh[i].options)) {
          fresh[i].run = std::move(*found);
        }
      },
      control_.stop);
  std::move(fresh.begin(), fresh.end(), std::back_inserter(known_));
  std::vector<std::optional<LogLikelihood>> all;
  for (const FilterOptions& trial : trials) {
    all.push_back(known(trial)->run);
  }
  const auto many = static_cast<std::ptrdiff_t>(known_.size());
  known_.erase(known_.begin(), known_.begin() + std::max(many - kRemembered, std::ptrdiff_t{0}));
  return all;
}

std::vector<double> Profile::values(const std::vector<FilterOptions>& trials) const {
  std::vector<double> sums;
  for (const auto& run : runs(trials)) {
    sums.push_back(run ? run->over(used_) : -std::numeric_limits<double>::infinity());
  }
  return sums;
}

ProfilePoint Profile::point(double at, const std::optional<LogLikelihood>& run, std::size_t blocks) const {
  ProfilePoint point{at, {}};
  for (std::size_t block = 0; block < blocks; ++block) {
    if (used_[fold_of_block(block)]) {
      const bool holds = run && block < run->blocks.size();
      point.blocks.push_back(!run    ? -std::numeric_limits<double>::infinity()
                             : holds ? run->blocks[block].log_likelihood
                                     : 0.0);
    }
  }
  return point;
}

FilterOptions Profile::turned(const FilterOptions& options, const Knob& knob, double by) {
  FilterOptions copy = options;
  knob.turn(copy, by);
  return copy;
}

ProfileEstimates Profile::estimates(const FilterOptions& options, const std::vector<const Knob*>& knobs) const {
  std::vector<FilterOptions> trials{options};
  for (const Knob* knob : knobs) {
    trials.push_back(turned(options, *knob, -knob->step));
    trials.push_back(turned(options, *knob, knob->step));
  }
  const auto all = runs(trials);
  ProfileEstimates found;
  found.knobs.resize(knobs.size());
  if (!all.front()) {
    found.at = -std::numeric_limits<double>::infinity();
    return found;
  }
  const std::size_t blocks = all.front()->blocks.size();
  const ProfilePoint middle = point(0.0, all.front(), blocks);
  found.at = middle.sum();
  found.mean_square = all.front()->mean_square(used_);
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    const Knob& knob = *knobs[i];
    ProfileEstimate& estimate = found.knobs[i];
    const Bracket first{point(-knob.step, all[2 * i + 1], blocks), middle, point(knob.step, all[2 * i + 2], blocks)};
    const Bracket bracket = stride(options, knob, first, blocks);
    estimate = parabola_through(bracket);
    const auto [down, up] = range(options, knob);
    const double within = std::clamp(estimate.value, down, up);
    if (within != estimate.value && estimate.se > 0.0) {
      const double beyond = (estimate.value - within) / estimate.se;
      estimate.top -= 0.5 * estimate.divisor * beyond * beyond;
      estimate.value = within;
    }
    if (knob.share) {
      settle_share(options, knob, bracket, blocks, estimate);
    }
    if (knob.systematic != nullptr) {
      estimate.se = std::hypot(estimate.se, knob.systematic(drive_, options));
    }
    estimate.score = std::max(estimate.gain_to(found.at), 0.0) / estimate.divisor;
  }
  return found;
}

void Profile::settle_share(const FilterOptions& options, const Knob& knob, const Bracket& bracket, std::size_t blocks,
                           ProfileEstimate& estimate) const {
  const double present = knob.value(options);
  if (!estimate.sound) {  // the likelihood of a share bends upwards where nearly all of the whole is of its kind
    const auto best = std::max_element(bracket.begin(), bracket.end(),
                                       [](const auto& a, const auto& b) { return a.sum() < b.sum(); });
    const auto [down, up] = range(options, knob);
    estimate.value = std::clamp(best->at, down, up);
    estimate.sound = std::isfinite(best->sum());
  }
  const auto ends = runs({turned(options, knob, estimate.value), turned(options, knob, -present)});
  const ProfilePoint top = point(estimate.value, ends[0], blocks);
  estimate.top = top.sum();
  judge_against_nothing(estimate, present + estimate.value, top, point(-present, ends[1], blocks));
}

std::array<double, 2> Profile::range(const FilterOptions& options, const Knob& knob) const {
  const double set = change(options, knob);
  return {knob.share ? -knob.value(options) : -knob.most - set, knob.most - set};
}

Profile::Bracket Profile::stride(const FilterOptions& options, const Knob& knob, Bracket bracket,
                                 std::size_t blocks) const {
  const auto [least, most] = range(options, knob);
  auto& [low, middle, high] = bracket;
  while (middle.sum() < std::max(low.sum(), high.sum())) {
    const bool up = high.sum() > low.sum();
    const double edge = up ? high.at : low.at;
    const double next = std::clamp(edge + 2.0 * (edge - middle.at), least, most);
    if ((up ? next <= edge : next >= edge) || control_.stop.stop_requested()) {
      return bracket;  // the end is an edge already
    }
    const auto run = runs({turned(options, knob, next)});
    ProfilePoint tried = point(next, run.front(), blocks);
    if (up) {
      low = std::exchange(middle, std::exchange(high, std::move(tried)));
    } else {
      high = std::exchange(middle, std::exchange(low, std::move(tried)));
    }
  }
  return bracket;
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
    double step = first_factor;
    double best = values({options}).front();
    while (step > 1.03) {
      FilterOptions up = options;
      FilterOptions down = options;
      double& of_up = gyroscope ? up.gyro_noise : up.force_noise;
      double& of_down = gyroscope ? down.gyro_noise : down.force_noise;
      of_up *= step;
      of_down /= step;
      const auto tried = values({up, down});
      const bool rises = std::max(tried[0], tried[1]) > best && of_up < 1e4 && of_down > 1e-2;
      if (rises) {
        options = tried[0] > tried[1] ? up : down;
        best = std::max(tried[0], tried[1]);
      } else {
        step = std::sqrt(step);
      }
      if (control_.stop.stop_requested()) {
        return options;
      }
    }
    first_factor = std::min(first_factor, 2.0);
  }
  return options;
}

FilterOptions Profile::refitted(FilterOptions options, const std::vector<const Knob*>& knobs, int sweeps) const {
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (const Knob* knob : knobs) {
      const ProfileEstimates found = estimates(options, {knob});
      const ProfileEstimate& estimate = found.knobs.front();
      if (estimate.sound) {
        FilterOptions tried = turned(options, *knob, estimate.value);
        if (values({tried}).front() > found.at) {
          options = std::move(tried);
        }
      }
    }
  }
  return options;
}

}  // namespace driftlab::drive
