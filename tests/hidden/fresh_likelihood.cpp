#include "tests/hidden/fresh_likelihood.hpp"

#include "tests/hidden/fresh_noise.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>

namespace driftlab::hidden {
namespace {

using investigate::Baseline;
using investigate::ChannelGroup;
using investigate::GivenEffect;
using investigate::Series;
using investigate::StudyRecording;

constexpr double kPi = std::numbers::pi;

// ---- the equations of the mean effects, once more -----------------------------------------------------------------

std::vector<double> each(const StudyRecording& recording, const std::function<double(std::size_t)>& f) {
  std::vector<double> values(recording.length);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = f(i);
  }
  return values;
}

/// Temperature behind a first-order lag, less its mean over the recording.
std::vector<double> lagged(const StudyRecording& recording, double lag_s) {
  std::vector<double> value = recording.temperature.values();
  const double step = lag_s > 0.0 ? 1.0 - std::exp(-recording.dt_s / lag_s) : 1.0;
  for (std::size_t i = 1; i < value.size(); ++i) {
    value[i] = value[i - 1] + step * (recording.temperature[i] - value[i - 1]);
  }
  double mean = 0.0;
  for (const double v : value) {
    mean += v / static_cast<double>(value.size());
  }
  for (double& v : value) {
    v -= mean;
  }
  return value;
}

/// Variance of the specific force in a centred window of 1 s.
std::vector<double> vibration(const StudyRecording& recording, const Series& f) {
  const auto half = static_cast<std::ptrdiff_t>(0.5 / recording.dt_s);
  const auto n = static_cast<std::ptrdiff_t>(f.size());
  return each(recording, [&](std::size_t i) {
    const std::ptrdiff_t from = std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(i) - half);
    const std::ptrdiff_t to = std::min(n, static_cast<std::ptrdiff_t>(i) + half + 1);
    double mean = 0.0;
    double square = 0.0;
    for (std::ptrdiff_t k = from; k < to; ++k) {
      mean += f[static_cast<std::size_t>(k)];
    }
    mean /= static_cast<double>(to - from);
    for (std::ptrdiff_t k = from; k < to; ++k) {
      square += std::pow(f[static_cast<std::size_t>(k)] - mean, 2.0);
    }
    return square / static_cast<double>(to - from);
  });
}

/// What a mean effect of fixed form adds; empty where it is none.
std::vector<double> mean_of(const GivenEffect& effect, const StudyRecording& recording, const ChannelGroup& group) {
  const std::size_t axis = group.axis();
  const Series& w = recording.rate[axis];
  const Series& a = recording.acceleration[axis];
  const double p = effect.values[0];
  const double q = effect.values.size() > 1 ? effect.values[1] : 0.0;
  const auto time = [&](std::size_t i) { return recording.time_s(i); };
  const std::map<std::string, std::function<double(std::size_t)>> forms{
      {"linear_drift", [&](std::size_t i) { return p * time(i); }},
      {"bias_step", [&](std::size_t i) { return time(i) >= q - 1e-9 ? p : 0.0; }},
      {"warm_up_transient", [&](std::size_t i) { return p * std::exp(-time(i) / q); }},
      {"scale_factor_error", [&](std::size_t i) { return p * at(w, i); }},
      {"scale_factor_asymmetry", [&](std::size_t i) { return p * std::fabs(at(w, i)); }},
      {"scale_factor_nonlinearity",
       [&](std::size_t i) {
         const double v = at(w, i);
         return p * (q > 2.5 ? v * v * v : v * std::fabs(v));
       }},
      {"reference_time_offset", [&](std::size_t i) { return -p * at(a, i); }},
      {"reference_clock_drift", [&](std::size_t i) { return p * time(i) * at(a, i); }},
      {"axis_misalignment", [&](std::size_t i) { return p * at(recording.rate[2], i); }},
      {"g_sensitivity", [&](std::size_t i) { return p * at(recording.force[axis], i); }},
      {"lever_arm",
       [&](std::size_t i) {
         const double v = at(recording.rate[2], i);
         return axis == 0 ? -p * v * v : p * at(recording.acceleration[2], i);
       }},
  };
  const auto form = forms.find(effect.cause);
  if (form != forms.end()) {
    return each(recording, form->second);
  }
  std::vector<double> values;
  if (effect.cause == "temperature_bias" && !recording.temperature.empty()) {
    values = lagged(recording, q);
  } else if (effect.cause == "vibration_rectification" && !recording.force[axis].empty()) {
    values = vibration(recording, recording.force[axis]);
  }
  for (double& v : values) {
    v *= p;
  }
  return values;
}

// ---- the filter ----------------------------------------------------------------------------------------------------

/// Innovations of several columns alike, with their variances; a sample without a say has variance 0.
struct Filtered {
  Eigen::MatrixXd innovation;    ///< samples x columns
  std::vector<double> variance;  ///< [SI^2]
};

Filtered filter(const Noise& noise, const std::vector<std::vector<double>>& columns,
                const std::vector<unsigned char>& used, std::size_t begin) {
  const States& s = noise.states;
  const auto m = s.h.size();
  const auto width = static_cast<Eigen::Index>(columns.size());
  const std::size_t n = columns[0].size();
  Filtered result{Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), width), std::vector<double>(n, 0.0)};
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(m, width);
  Eigen::MatrixXd p = s.p0;
  Eigen::VectorXd gain(m);
  const bool no_change = std::all_of(noise.white_factor.begin(), noise.white_factor.end(),
                                     [&](double v) { return v == noise.white_factor[0]; });
  double last = -1.0;
  int same = 0;
  const double rounding = noise.step * noise.step / 12.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double factor = noise.white_factor[begin + i];
    const double whole = noise.whole_factor[begin + i];
    const bool steady = no_change && same > 200;
    if (used[i] != 0) {
      const double white = s.white * factor * factor + rounding;
      const Eigen::VectorXd ph = p * s.h.transpose();
      const double variance = s.h.dot(ph) + white;
      gain = ph / variance;
      for (Eigen::Index c = 0; c < width; ++c) {
        const double e = columns[static_cast<std::size_t>(c)][i] / whole - s.h.dot(x.col(c));
        result.innovation(static_cast<Eigen::Index>(i), c) = e * whole;
        x.col(c) += gain * e;
      }
      result.variance[i] = variance * whole * whole;
      if (!steady) {
        p -= gain * ph.transpose();
      }
      same = std::fabs(variance / last - 1.0) < 1e-10 ? same + 1 : 0;
      last = variance;
    } else {
      same = 0;
    }
    x = (s.f * x).eval();
    if (!steady || used[i] == 0) {  // steady: p is that before the next sample already
      p = (s.f * p * s.f.transpose() + s.q).eval();
    }
  }
  return result;
}

double log_normal(double e, double variance) { return -0.5 * (std::log(2.0 * kPi * variance) + e * e / variance); }

/// Student-t of variance `variance` with nu > 2 degrees of freedom.
double log_student(double e, double variance, double nu) {
  const double scale2 = variance * (nu - 2.0) / nu;
  int sign = 0;  // of the Gamma function: lgamma_r keeps it apart for each thread
  return lgamma_r(0.5 * (nu + 1.0), &sign) - lgamma_r(0.5 * nu, &sign) - 0.5 * std::log(nu * kPi * scale2) -
         0.5 * (nu + 1.0) * std::log1p(e * e / (nu * scale2));
}

double log_density(const Noise& noise, double e, double variance) {
  if (noise.nu > 2.0) {
    return log_student(e, variance, noise.nu);
  }
  if (noise.fraction > 0.0) {
    const auto part = [&](double share, double shift) { return share * std::exp(log_normal(e - shift, variance)); };
    return std::log(part(1.0 - noise.fraction, 0.0) + part(0.5 * noise.fraction, noise.magnitude) +
                    part(0.5 * noise.fraction, -noise.magnitude) + 1e-300);
  }
  if (noise.step > 0.0) {  // the chance of the cell, per unit of its width
    const double sd = std::sqrt(std::max(1e-6 * variance, variance - noise.step * noise.step / 12.0));
    const auto below = [&](double v) { return 0.5 * std::erfc(-v / sd / std::sqrt(2.0)); };
    return std::log((below(e + 0.5 * noise.step) - below(e - 0.5 * noise.step)) / noise.step + 1e-300);
  }
  return log_normal(e, variance);
}

// ---- one channel ---------------------------------------------------------------------------------------------------

/// Samples that facts of the file leave as they are.
std::vector<unsigned char> usable(const ChannelGroup::Member& member, const std::vector<Hidden>& facts) {
  const StudyRecording& recording = *member.recording;
  std::vector<unsigned char> used(recording.count());
  for (std::size_t i = 0; i < used.size(); ++i) {
    const std::size_t k = recording.begin + i;
    used[i] = member.channel->valid[k];
    for (const Hidden& fact : facts) {
      if (fact.cause == "stuck_samples" && k > 0 && member.channel->measured[k] == member.channel->measured[k - 1]) {
        used[i] = 0;
      }
      if (fact.cause == "saturation" && std::fabs(member.channel->measured[k]) > fact.values[0] * (1.0 - 1e-4)) {
        used[i] = 0;
      }
    }
  }
  return used;
}

/// The free phase of a sinusoid of known amplitude, integrated out over whitened quadratures.
double phase_gain(double amplitude, double ye, double yo, double ee, double oo, double eo) {
  constexpr int kPhases = 256;
  std::vector<double> exponent;
  for (int k = 0; k < kPhases; ++k) {
    const double c = amplitude * std::cos(2.0 * kPi * k / kPhases);
    const double s = amplitude * std::sin(2.0 * kPi * k / kPhases);
    exponent.push_back(c * ye + s * yo - 0.5 * (c * c * ee + s * s * oo + 2.0 * c * s * eo));
  }
  const double top = *std::max_element(exponent.begin(), exponent.end());
  double sum = 0.0;
  for (const double e : exponent) {
    sum += std::exp(e - top) / kPhases;
  }
  return top + std::log(sum);
}

struct ChannelScore {
  double log_likelihood = 0.0;
  std::vector<std::vector<double>> standard;  ///< innovations over their deviations, per recording
  std::vector<double> correlation;            ///< per recording
};

ChannelScore score_channel(const Baseline& model, const ChannelGroup& group, const std::vector<Hidden>& facts) {
  ChannelScore score;
  struct Part {
    Noise noise;
    Filtered filtered;
    double amplitude = 0.0;
  };
  std::vector<Part> parts;
  const double finest = group.role.quantity == Quantity::AngularRate ? 1e-5 * kPi / 180.0 : 1e-5;
  double information = 0.0;
  double product = 0.0;
  for (const auto& member : group.members) {
    const StudyRecording& recording = *member.recording;
    Part part;
    part.noise = noise_of(model, recording, group, finest);
    std::vector<double> error = member.channel->error.values();
    std::vector<std::vector<double>> quadratures;
    for (const GivenEffect& effect : model.effects) {
      if (!lists(effect.channels, group.column) || !lists(effect.recordings, recording.id)) {
        continue;
      }
      if (effect.cause == "periodic_disturbance" || effect.cause == "once_per_revolution") {
        const bool line = effect.cause == "periodic_disturbance";
        part.amplitude = effect.values[0];
        const auto angle = [&](std::size_t i) {
          return line ? 2.0 * kPi * effect.values[1] * recording.time_s(i) : at(recording.angle, i);
        };
        if (line || !recording.is_static()) {
          quadratures = {each(recording, [&](std::size_t i) { return std::cos(angle(i)); }),
                         each(recording, [&](std::size_t i) { return std::sin(angle(i)); })};
        }
        continue;
      }
      const std::vector<double> mean = mean_of(effect, recording, group);
      for (std::size_t i = 0; i < mean.size(); ++i) {
        error[i] -= mean[i];
      }
    }
    const auto cut = [&](const std::vector<double>& v) {
      return std::vector<double>(v.begin() + static_cast<std::ptrdiff_t>(recording.begin),
                                 v.begin() + static_cast<std::ptrdiff_t>(recording.end));
    };
    std::vector<std::vector<double>> columns{cut(error), std::vector<double>(recording.count(), 1.0)};
    for (const auto& quadrature : quadratures) {
      columns.push_back(cut(quadrature));
    }
    part.filtered = filter(part.noise, columns, usable(member, facts), recording.begin);
    for (std::size_t i = 0; i < part.filtered.variance.size(); ++i) {
      const double v = part.filtered.variance[i];
      if (v > 0.0) {
        const auto k = static_cast<Eigen::Index>(i);
        information += part.filtered.innovation(k, 1) * part.filtered.innovation(k, 1) / v;
        product += part.filtered.innovation(k, 1) * part.filtered.innovation(k, 0) / v;
      }
    }
    parts.push_back(std::move(part));
  }
  const double bias = information > 0.0 ? product / information : 0.0;
  for (const Part& part : parts) {
    const Eigen::MatrixXd& e = part.filtered.innovation;
    std::vector<double> standard(part.filtered.variance.size(), 0.0);
    double ye = 0.0, yo = 0.0, ee = 0.0, oo = 0.0, eo = 0.0;
    for (std::size_t i = 0; i < standard.size(); ++i) {
      const double v = part.filtered.variance[i];
      if (!(v > 0.0)) {
        continue;
      }
      const auto k = static_cast<Eigen::Index>(i);
      const double y = e(k, 0) - bias * e(k, 1);
      standard[i] = y / std::sqrt(v);
      score.log_likelihood += log_density(part.noise, y, v);
      if (e.cols() > 2) {
        ye += y * e(k, 2) / v;
        yo += y * e(k, 3) / v;
        ee += e(k, 2) * e(k, 2) / v;
        oo += e(k, 3) * e(k, 3) / v;
        eo += e(k, 2) * e(k, 3) / v;
      }
    }
    if (e.cols() > 2) {
      score.log_likelihood += phase_gain(part.amplitude, ye, yo, ee, oo, eo);
    }
    score.standard.push_back(std::move(standard));
    score.correlation.push_back(part.noise.correlation);
  }
  return score;
}

/// What equal correlation r between k axes adds: -1/2 [ln det C + e'(C^-1 - 1) e] over the samples.
double correlation_gain(const std::vector<ChannelScore>& channels) {
  if (channels.size() < 2) {
    return 0.0;
  }
  double gain = 0.0;
  const auto k = static_cast<double>(channels.size());
  for (std::size_t r = 0; r < channels[0].standard.size(); ++r) {
    const double c = channels[0].correlation[r];
    if (c == 0.0) {
      continue;
    }
    const double determinant = std::log(1.0 + (k - 1.0) * c) + (k - 1.0) * std::log(1.0 - c);
    for (std::size_t i = 0; i < channels[0].standard[r].size(); ++i) {
      double sum = 0.0;
      double square = 0.0;
      for (const ChannelScore& channel : channels) {
        sum += channel.standard[r][i];
        square += channel.standard[r][i] * channel.standard[r][i];
      }
      const double quadratic = (square - c * sum * sum / (1.0 + (k - 1.0) * c)) / (1.0 - c);
      gain += -0.5 * (determinant + quadratic - square);
    }
  }
  return gain;
}

}  // namespace

bool has_equation(const std::string& cause) {
  static const std::set<std::string> known{"white_noise_level",
                                           "gauss_markov",
                                           "random_walk",
                                           "flicker_noise",
                                           "quantization_noise",
                                           "turn_on_bias",
                                           "rate_dependent_noise",
                                           "acceleration_dependent_noise",
                                           "noise_level_change",
                                           "heavy_tailed_noise",
                                           "outliers",
                                           "output_resolution",
                                           "common_mode_noise",
                                           "band_limited_noise",
                                           "linear_drift",
                                           "bias_step",
                                           "warm_up_transient",
                                           "scale_factor_error",
                                           "scale_factor_asymmetry",
                                           "scale_factor_nonlinearity",
                                           "reference_time_offset",
                                           "reference_clock_drift",
                                           "axis_misalignment",
                                           "g_sensitivity",
                                           "lever_arm",
                                           "temperature_bias",
                                           "vibration_rectification",
                                           "periodic_disturbance",
                                           "once_per_revolution",
                                           "stuck_samples",
                                           "missing_samples",
                                           "saturation"};
  return known.contains(cause);
}

double log_likelihood(const Baseline& model, const SimulatedStudy& data, const std::vector<Hidden>& facts) {
  double sum = 0.0;
  std::vector<ChannelScore> channels;
  for (const ChannelGroup& group : investigate::group_channels(data.study)) {
    channels.push_back(score_channel(model, group, facts));
    sum += channels.back().log_likelihood;
  }
  return sum + correlation_gain(channels);
}

}  // namespace driftlab::hidden
