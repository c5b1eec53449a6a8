/// The equations of effects on the mean, as functions of the motion in closed form, and that motion.
#include "tests/hidden/equations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace driftlab::hidden {
namespace {

using investigate::Figure;
using Figures = std::vector<Figure>;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// What was added follows an equation in the sample's time; `tolerance` covers what the recording's own differences,
/// sums and lags are off from the closed forms at its sampling rate.
Figures follows(const Injected& injected, double tolerance, const std::function<double(double)>& equation) {
  std::vector<double> expected(injected.samples());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    expected[i] = equation(static_cast<double>(i) * injected.dt_s());
  }
  return {deviation("what was added, against the equation", injected.added(), expected, tolerance)};
}

/// What was added is amplitude times a sinusoid of `phase(t)`, begun anywhere.
Figures turns(const Injected& injected, double tolerance, const std::function<double(double)>& phase) {
  const std::vector<double> added = injected.added();
  double ss = 0.0;
  double sc = 0.0;
  double cc = 0.0;
  double sy = 0.0;
  double cy = 0.0;
  for (std::size_t i = 0; i < added.size(); ++i) {
    const double p = phase(static_cast<double>(i) * injected.dt_s());
    ss += std::sin(p) * std::sin(p);
    sc += std::sin(p) * std::cos(p);
    cc += std::cos(p) * std::cos(p);
    sy += std::sin(p) * added[i];
    cy += std::cos(p) * added[i];
  }
  const double a = (cc * sy - sc * cy) / (ss * cc - sc * sc);
  const double b = (ss * cy - sc * sy) / (ss * cc - sc * sc);
  std::vector<double> fitted(added.size());
  for (std::size_t i = 0; i < added.size(); ++i) {
    const double p = phase(static_cast<double>(i) * injected.dt_s());
    fitted[i] = a * std::sin(p) + b * std::cos(p);
  }
  const double amplitude = injected.values[0];
  return {{"amplitude", std::hypot(a, b), amplitude, tolerance * amplitude},
          deviation("sinusoid", added, fitted, tolerance)};
}

Figures linear_drift(const Injected& in) {
  return follows(in, 1e-9, [&](double t) { return in.values[0] * t; });
}

Figures bias_step(const Injected& in) {
  return follows(in, 1e-9, [&](double t) { return t >= in.values[1] ? in.values[0] : 0.0; });
}

Figures warm_up_transient(const Injected& in) {
  return follows(in, 1e-9, [&](double t) { return in.values[0] * std::exp(-t / in.values[1]); });
}

Figures temperature_bias(const Injected& in) {  // c (T_lag - mean), the mean over the analysed part
  const investigate::StudyRecording& recording = *in.before.recording;
  double mean = 0.0;
  for (std::size_t i = recording.begin; i < recording.end; ++i) {
    mean +=
        motion::temperature(static_cast<double>(i) * in.dt_s()) / static_cast<double>(recording.end - recording.begin);
  }
  return follows(in, 5e-3,
                 [&](double t) { return in.values[0] * (motion::lagged_temperature(t, in.values[1]) - mean); });
}

Figures scale_factor_error(const Injected& in) {
  return follows(in, 1e-9, [&](double t) { return in.values[0] * motion::rate(t); });
}

Figures scale_factor_asymmetry(const Injected& in) {
  return follows(in, 1e-9, [&](double t) { return in.values[0] * std::fabs(motion::rate(t)); });
}

Figures scale_factor_nonlinearity(const Injected& in) {  // S2 w |w| or S3 w^3, by the power that goes with the value
  return follows(in, 1e-9, [&](double t) {
    const double w = motion::rate(t);
    return in.values[1] == 3.0 ? in.values[0] * w * w * w : in.values[0] * w * std::fabs(w);
  });
}

Figures axis_misalignment(const Injected& in) {  // of an axis that should see none of the rate about z
  return follows(in, 1e-9, [&](double t) { return in.values[0] * motion::rate(t); });
}

Figures reference_time_offset(const Injected& in) {  // measured w(t - delta), to first order in delta
  return follows(in, 2e-3, [&](double t) { return motion::rate(t - in.values[0]) - motion::rate(t); });
}

Figures reference_clock_drift(const Injected& in) {  // measured w(t (1 + eps)), to first order in eps t
  return follows(in, 5e-3, [&](double t) { return motion::rate(t + in.values[0] * t) - motion::rate(t); });
}

Figures periodic_disturbance(const Injected& in) {
  return turns(in, 1e-9, [&](double t) { return kTurn * in.values[1] * t; });
}

Figures once_per_revolution(const Injected& in) { return turns(in, 1e-3, motion::angle); }

Figures g_sensitivity(const Injected& in) {
  return follows(in, 1e-9, [&](double t) { return in.values[0] * motion::force(t); });
}

/// The coefficient times the variance of f in a centred window of 1 s, by the definition; a window of one sample more
/// or less differs by about one part in fifty.
Figures vibration_rectification(const Injected& in) {
  const double end = static_cast<double>(in.samples() - 1) * in.dt_s();
  return follows(in, 0.05, [&](double t) {
    double sum = 0.0;
    double square = 0.0;
    double count = 0.0;
    for (double s = std::max(0.0, t - 0.5); s <= std::min(end, t + 0.5); s += in.dt_s()) {
      const double f = motion::force(s);
      sum += f;
      square += f * f;
      count += 1.0;
    }
    return in.values[0] * (square / count - sum * sum / (count * count));
  });
}

Figures lever_arm(const Injected& in) {  // centripetal on x, towards the axis; tangential on y
  return follows(in, 1e-4, [&](double t) {
    const double w = motion::rate(t);
    return in.axis() == 0 ? -in.values[0] * w * w : in.values[0] * motion::acceleration(t);
  });
}

}  // namespace

namespace motion {

double rate(double t) { return 1.2 * std::sin(kTurn * 0.02 * t) + 0.7 * std::sin(kTurn * 0.05 * t + 0.4); }

double acceleration(double t) {
  return kTurn * (1.2 * 0.02 * std::cos(kTurn * 0.02 * t) + 0.7 * 0.05 * std::cos(kTurn * 0.05 * t + 0.4));
}

double angle(double t) {
  const auto from_zero = [](double amplitude, double f, double phase, double time) {
    return amplitude / (kTurn * f) * (std::cos(phase) - std::cos(kTurn * f * time + phase));
  };
  return from_zero(1.2, 0.02, 0.0, t) + from_zero(0.7, 0.05, 0.4, t);
}

double force(double t) {
  return 9.8 + 2.0 * std::sin(kTurn * 0.013 * t) +
         3.0 * (1.0 + std::sin(kTurn * 0.3 * t)) * std::sin(kTurn * 7.0 * t + 0.3);
}

double temperature(double t) { return 300.0 + 6.0 * std::sin(kTurn * t / 150.0); }

double lagged_temperature(double t, double lag_s) {
  const double w = kTurn / 150.0;
  const double wl = w * lag_s;
  const double decay = lag_s > 0.0 ? std::exp(-t / lag_s) : 0.0;
  return 300.0 + 6.0 / (1.0 + wl * wl) * (std::sin(w * t) - wl * std::cos(w * t) + wl * decay);
}

}  // namespace motion

std::vector<Equation> mean_equations() {
  return {
      {"linear_drift", {-2e-4}, {"y/s"}, linear_drift},
      {"periodic_disturbance", {0.03, 1.7}, {"y", "1/s"}, periodic_disturbance},
      {"bias_step", {-0.04, 300.01}, {"y", "s"}, bias_step},
      {"warm_up_transient", {-0.05, 60.0}, {"y", "s"}, warm_up_transient},
      {"temperature_bias", {3e-3, 30.0}, {"y/K", "s"}, temperature_bias},
      {"scale_factor_error", {4e-3}, {"1"}, scale_factor_error},
      {"scale_factor_asymmetry", {4e-3}, {"1"}, scale_factor_asymmetry},
      {"scale_factor_nonlinearity", {4e-3, 2.0}, {"s/rad", "s^2/rad^2"}, scale_factor_nonlinearity},
      {"scale_factor_nonlinearity", {4e-3, 3.0}, {"s/rad", "s^2/rad^2"}, scale_factor_nonlinearity},
      {"axis_misalignment", {5e-3, 2.0}, {"rad"}, axis_misalignment},
      {"reference_time_offset", {4e-3}, {"s"}, reference_time_offset},
      {"reference_clock_drift", {1e-5}, {"1"}, reference_clock_drift},
      {"once_per_revolution", {0.02}, {"y"}, once_per_revolution},
      {"g_sensitivity", {1e-3}, {"y/(m/s^2)"}, g_sensitivity},
      {"vibration_rectification", {2e-3}, {"y/(m/s^2)^2"}, vibration_rectification},
      {"lever_arm", {0.05}, {"m"}, lever_arm},
  };
}

}  // namespace driftlab::hidden
