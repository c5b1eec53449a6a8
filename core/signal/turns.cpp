#include "core/signal/turns.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

/// Whole turns by which a step from one sample to the next went the long way.
double whole_turns(double from, double to) {
  const double step = to - from;
  return std::isfinite(step) ? std::round(step / kTurn) : 0.0;
}

std::size_t places_between(std::span<const std::size_t> places, std::size_t from, std::size_t to) {
  return places.empty() ? to - from : places[to] - places[from];
}

/// Does any step between neighbours on the grid go more than half a turn?
bool starts_again(std::span<const double> angles, std::span<const std::size_t> places) {
  for (std::size_t i = 1; i < angles.size(); ++i) {
    if (places_between(places, i - 1, i) == 1 && whole_turns(angles[i - 1], angles[i]) != 0.0) {
      return true;
    }
  }
  return false;
}

}  // namespace

double nearest_turn(double angle, double near) { return angle + kTurn * std::round((near - angle) / kTurn); }

std::vector<double> continuous_angle(std::span<const double> angles, std::span<const std::size_t> places) {
  std::vector<double> out(angles.begin(), angles.end());
  if (!starts_again(angles, places)) {
    return out;
  }
  std::size_t last = 0;  // the last finite one
  double pace = 0.0;     // of the last step, per place
  for (std::size_t i = 1; i < out.size(); ++i) {
    if (!std::isfinite(out[i])) {
      continue;
    }
    if (std::isfinite(out[last])) {
      const auto gap = static_cast<double>(places_between(places, last, i));
      out[i] = nearest_turn(out[i], out[last] + (gap > 1.0 ? pace * gap : 0.0));
      pace = (out[i] - out[last]) / gap;
    }
    last = i;
  }
  return out;
}

std::vector<double> slope(std::span<const double> values, double dt_s) {
  std::vector<double> d(values.size(), 0.0);
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    d[i] = i == 0 ? (values[1] - values[0]) / dt_s : (values[i + 1] - values[i - 1]) / (2.0 * dt_s);
  }
  if (values.size() > 1) {
    d.back() = (values.back() - values[values.size() - 2]) / dt_s;
  }
  return d;
}

std::vector<double> rate_of_angle(std::span<const double> angles, double dt_s) {
  std::vector<double> rate(angles.size(), 0.0);
  for (std::size_t i = 0; i < angles.size() && angles.size() > 1; ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t behind = std::min(i + 1, angles.size() - 1);
    double turns = 0.0;
    for (std::size_t k = before; k < behind; ++k) {
      turns += whole_turns(angles[k], angles[k + 1]);
    }
    // Fused, so that what is left of a whole turn is as exact as the angles are.
    const double turned = std::fma(-turns, kTurn, angles[behind] - angles[before]);
    rate[i] = turned / (static_cast<double>(behind - before) * dt_s);
  }
  return rate;
}

}  // namespace driftlab
