/// The equations of what is wrong with recordings as a whole, by another hand than their injections: what the output
/// stage makes of white noise and of a ramp, what the stamps say, and which motion is read.
#include "core/process/random.hpp"
#include "tests/hidden/equations.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace driftlab::hidden {
namespace {

using investigate::Draft;
using investigate::Figure;
using Figures = std::vector<Figure>;

std::vector<double> put_out(const Draft& draft, std::vector<double> values) {
  for (const auto& step : draft.output) {
    step(values);
  }
  return values;
}

/// A sequence in which no value comes twice and none is foreseen.
std::vector<double> distinct(std::size_t samples) {
  Random random(23);
  std::vector<double> values(samples);
  for (double& v : values) {
    v = random.uniform();
  }
  return values;
}

/// One sample that is not zero: what the output makes of it is its impulse response.
std::vector<double> pulse(std::size_t samples, std::size_t at) {
  std::vector<double> values(samples, 0.0);
  values[at] = 1.0;
  return values;
}

/// White noise in the reference; the reading stays.
Figures reference_noise(const Injected& injected) {
  double square = 0.0;
  double product = 0.0;
  const auto& u = injected.after.reference;
  for (std::size_t i = 1; i < u.size(); ++i) {
    square += u[i] * u[i];
    product += u[i] * u[i - 1];
  }
  const auto n = static_cast<double>(u.size());
  double moved = 0.0;
  for (const double v : injected.added()) {
    moved = std::max(moved, std::fabs(v));
  }
  return {{"N", std::sqrt(square / n * injected.dt_s()), injected.values[0], 0.03 * injected.values[0]},
          {"correlation of neighbours", product / square, 0.0, 5.0 / std::sqrt(n)},
          {"change of the reading", moved, 0.0, 0.0}};
}

Figures bursty_clock(const Injected& injected) {
  const auto& late = injected.after.stamp_error_s;
  const double dt = injected.dt_s();
  double bursts = 1.0;
  double least = 0.0;
  for (std::size_t i = 1; i < late.size(); ++i) {
    const double step = dt + late[i] - late[i - 1];
    bursts += step > 0.25 * dt ? 1.0 : 0.0;
    least = std::min(least, late[i]);
  }
  const auto n = static_cast<double>(late.size());
  return {{"samples to a burst", n / bursts, injected.values[0], 0.05 * injected.values[0]},
          {"samples per second", 1.0 / dt, injected.values[1], 1e-6 * injected.values[1]},
          {"a stamp before its sample", least, 0.0, 1e-12}};
}

/// A copy is a run of values, each of which was there before, at one distance.
Figures duplicated_blocks(const Injected& injected) {
  const std::vector<double> before = distinct(injected.samples());
  const std::vector<double> after = put_out(injected.after, before);
  double repeated = 0.0;
  double blocks = 0.0;
  double wrong = 0.0;
  for (std::size_t i = 0; i < after.size();) {
    std::size_t length = 0;
    while (i + length < after.size() && after[i + length] != before[i + length]) {
      ++length;
    }
    if (length > 0) {
      blocks += 1.0;
      repeated += static_cast<double>(length);
      for (std::size_t k = 0; k < length; ++k) {
        wrong += after[i + k] == before[i + k - length] ? 0.0 : 1.0;
      }
    }
    i += length + 1;
  }
  const double expected = injected.values[0] * static_cast<double>(after.size()) / injected.values[1];
  return {{"blocks", blocks, expected, 5.0 * std::sqrt(expected)},
          {"samples of a block", repeated / blocks, injected.values[1],
           5.0 * 0.35 * injected.values[1] / std::sqrt(expected)},
          {"samples that are no copies of the block before", wrong, 0.0, 0.0}};
}

Figures interpolated_samples(const Injected& injected) {
  const std::vector<double> before = distinct(injected.samples());
  const std::vector<double> after = put_out(injected.after, before);
  double kept = 0.0;
  double bent = 0.0;
  double inner = 0.0;
  for (std::size_t i = 1; i + 1 < after.size(); ++i) {
    kept += after[i] == before[i] ? 1.0 : 0.0;
    const bool straight = std::fabs(after[i] - 0.5 * (after[i - 1] + after[i + 1])) < 1e-9;
    bent += straight ? 0.0 : 1.0;
    inner += 1.0;
  }
  const double share = injected.values[0] * injected.dt_s();
  return {{"share of samples that were recorded", kept / inner, share, 0.02 * share},
          {"share of samples at which the course bends", bent / inner, share, 0.02 * share}};
}

Figures averaged_samples(const Injected& injected) {
  const std::size_t at = injected.samples() / 2;
  const std::vector<double> after = put_out(injected.after, pulse(injected.samples(), at));
  const double m = injected.values[0];
  double reached = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    reached += after[i] != 0.0 ? 1.0 : 0.0;
    sum += after[i];
  }
  return {{"samples that one sample reaches", reached, m, 0.0},
          {"each by", after[at], 1.0 / m, 1e-12},
          {"in all", sum, 1.0, 1e-12},
          {"before its time", after[at - 1], 0.0, 0.0}};
}

Figures unit_error(const Injected& injected) {
  const std::vector<double> before = distinct(injected.samples());
  const std::vector<double> after = put_out(injected.after, before);
  const double factor = injected.values[0];
  return {{"a reading", after[1234] / before[1234], factor, 1e-12},
          {"another", after[4321] / before[4321], factor, 1e-12}};
}

Figures turned_sign(const Injected& injected) {
  const std::vector<double> before = distinct(injected.samples());
  const std::vector<double> after = put_out(injected.after, before);
  return {{"a reading", after[1234], -before[1234], 1e-12}, {"another", after[4321], -before[4321], 1e-12}};
}

/// The recording turns about z alone: exchanged with x, its z channel no longer sees the motion.
Figures swapped_axes(const Injected& injected) {
  const std::vector<double> added = injected.added();
  double worst = 0.0;
  for (std::size_t i = 0; i < added.size(); ++i) {
    worst = std::max(worst, std::fabs(added[i] + motion::rate(static_cast<double>(i) * injected.dt_s())));
  }
  return {{"what is left of the motion", worst, 0.0, 1e-6}};
}

/// Relative root mean square of what was added against w read at `at(t)`.
Figures reads(const Injected& injected, const std::function<double(double)>& at) {
  const std::vector<double> added = injected.added();
  double off = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < added.size(); ++i) {
    const double t = static_cast<double>(i) * injected.dt_s();
    const double expected = motion::rate(at(t)) - motion::rate(t);
    off += (added[i] - expected) * (added[i] - expected);
    all += expected * expected;
  }
  return {{"what was added, against the motion at another time", std::sqrt(off / all), 0.0, 0.02}};
}

Figures clock_jump(const Injected& injected) {
  return reads(injected, [&](double t) { return t < injected.values[1] ? t : t - injected.values[0]; });
}

Figures sampling_rate_change(const Injected& injected) {
  return reads(injected, [&](double t) {
    return t < injected.values[1] ? t : injected.values[1] + (t - injected.values[1]) * (1.0 + injected.values[0]);
  });
}

}  // namespace

std::vector<Equation> recording_equations() {
  return {
      {"reference_noise", {3e-3}, {"y*sqrt(s)"}, reference_noise},
      {"bursty_clock", {8.0, 50.0}, {"1", "1/s"}, bursty_clock},
      {"duplicated_blocks", {0.2, 40.0}, {"1", "1"}, duplicated_blocks},
      {"interpolated_samples", {12.5}, {"1/s"}, interpolated_samples},
      {"averaged_samples", {3.0}, {"1"}, averaged_samples},
      {"unit_error", {0.02}, {"1"}, unit_error},
      {"turned_sign", {}, {}, turned_sign},
      {"swapped_axes", {}, {}, swapped_axes},
      {"clock_jump", {0.05, 300.01}, {"s", "s"}, clock_jump},
      {"sampling_rate_change", {-8e-4, 300.01}, {"1", "s"}, sampling_rate_change},
  };
}

}  // namespace driftlab::hidden
