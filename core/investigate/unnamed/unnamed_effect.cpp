#include "core/investigate/unnamed/unnamed_effect.hpp"

#include "core/investigate/fullrate/spectrum.hpp"
#include "core/signal/angle.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iterator>
#include <numbers>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr std::array<std::pair<UnnamedKind, std::string_view>, 3> kKinds{
    {{UnnamedKind::Spectrum, "spectrum"}, {UnnamedKind::Variance, "variance"}, {UnnamedKind::Mean, "mean"}}};

struct AgainstWords {
  Against against;
  std::string_view name, words;
};
constexpr std::array<AgainstWords, 8> kAgainst{
    {{Against::Frequency, "frequency", "the frequency"},
     {Against::Time, "time", "the time since the start of the recording"},
     {Against::Phase, "phase", "the time within its period"},
     {Against::Rate, "rate", "the rate about the axis"},
     {Against::RateChange, "angular_acceleration", "the angular acceleration about the axis"},
     {Against::Temperature, "temperature", "the temperature"},
     {Against::Warming, "warming", "the rate at which the temperature changes"},
     {Against::Angle, "angle", "the angle that the unit is turned to"}}};

template <class List, class Key>
const auto& entry_of(const List& list, Key key) {
  return *std::find_if(list.begin(), list.end(), [&](const auto& entry) {
    if constexpr (requires { entry.against; }) {
      return entry.against == key;
    } else {
      return entry.first == key;
    }
  });
}

/// The slope of the temperature between its means over the four seconds before and after, for thermometers are coarse
/// [K/s].
Series warming_of(const StudyRecording& recording) {
  constexpr double kMeanOver = 4.0;  // [s], chosen, not measured
  const std::size_t n = recording.temperature.size();
  const auto width = static_cast<std::size_t>(std::lround(kMeanOver / recording.dt_s));
  if (width == 0 || n < 2 * width) {
    return {};
  }
  std::vector<double> sum(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    sum[i + 1] = sum[i] + recording.temperature[i];
  }
  std::vector<double> slope(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t at = std::clamp(i, width, n - width);
    slope[i] = (sum[at + width] - 2.0 * sum[at] + sum[at - width]) / std::pow(static_cast<double>(width), 2.0) /
               recording.dt_s;
  }
  return slope;
}

}  // namespace

std::string_view name_of(UnnamedKind kind) { return entry_of(kKinds, kind).second; }

std::string_view name_of(Against against) { return entry_of(kAgainst, against).name; }

std::string_view words_of(Against against) { return entry_of(kAgainst, against).words; }

std::optional<UnnamedKind> unnamed_kind(std::string_view name) {
  for (const auto& [kind, own] : kKinds) {
    if (own == name) {
      return kind;
    }
  }
  return std::nullopt;
}

std::optional<Against> unnamed_against(std::string_view name) {
  for (const AgainstWords& entry : kAgainst) {
    if (entry.name == name) {
      return entry.against;
    }
  }
  return std::nullopt;
}

ProfileUnit unit_of(Against against) {
  constexpr double kCelsius = -273.15;
  switch (against) {
    case Against::Frequency:
      return {"Hz", 1.0, 0.0};
    case Against::Time:
    case Against::Phase:
      return {"s", 1.0, 0.0};
    case Against::Rate:
      return {"deg/s", 1.0 / kDegree, 0.0};
    case Against::RateChange:
      return {"deg/s^2", 1.0 / kDegree, 0.0};
    case Against::Temperature:
      return {"degC", 1.0, kCelsius};
    case Against::Warming:
      return {"degC/min", 60.0, 0.0};
    case Against::Angle:
      break;
  }
  return {"deg", 1.0 / kDegree, 0.0};
}

std::vector<double> in_lab_units(const std::vector<double>& si, Against against) {
  const ProfileUnit unit = unit_of(against);
  std::vector<double> lab;
  std::transform(si.begin(), si.end(), std::back_inserter(lab), [&](double value) { return unit.to_lab(value); });
  return lab;
}

UnnamedEffect from_lab_units(UnnamedEffect effect, double value_factor) {
  const ProfileUnit unit = unit_of(effect.against);
  for (double& edge : effect.edge) {
    edge = unit.to_si(edge);
  }
  for (double& value : effect.value) {
    value *= effect.kind == UnnamedKind::Mean ? value_factor : 1.0;
  }
  return effect;
}

Series course_of(Against against, const StudyRecording& recording, std::size_t axis, double period_s) {
  switch (against) {
    case Against::Frequency:
      break;
    case Against::Time:
    case Against::Phase: {
      std::vector<double> time(recording.length);
      for (std::size_t i = 0; i < time.size(); ++i) {
        const double t = recording.time_s(i);
        time[i] = against == Against::Time ? t : t - period_s * std::floor(t / period_s);
      }
      return time;
    }
    case Against::Rate:
      return recording.rate[axis];
    case Against::RateChange:
      return recording.acceleration[axis];
    case Against::Temperature:
      return recording.temperature;
    case Against::Warming:
      return warming_of(recording);
    case Against::Angle: {
      std::vector<double> angle = recording.angle.values();
      for (double& value : angle) {
        value -= 2.0 * std::numbers::pi * std::floor(value / (2.0 * std::numbers::pi));
      }
      return angle;
    }
  }
  return {};
}

Series course_of(const UnnamedEffect& effect, const StudyRecording& recording, std::size_t axis) {
  return course_of(effect.against, recording, axis, effect.period_s);
}

double value_at(const UnnamedEffect& effect, double x) {
  const auto above = std::upper_bound(effect.edge.begin(), effect.edge.end(), x) - effect.edge.begin();
  const auto last = static_cast<std::ptrdiff_t>(effect.value.size()) - 1;
  return effect.value[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, last))];
}

bool acts_on(const UnnamedEffect& effect, const std::string& column, const std::string& recording) {
  const bool there = effect.recordings.empty() || std::find(effect.recordings.begin(), effect.recordings.end(),
                                                            recording) != effect.recordings.end();
  return effect.column == column && there;
}

namespace {

void shape(const UnnamedEffect& effect, double dt_s, std::vector<double>& noise) {
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> z;
  fft.fwd(z, noise);
  const std::size_t n = noise.size();
  for (std::size_t k = 0; k < n; ++k) {
    const double f_hz = static_cast<double>(std::min(k, n - k)) / (static_cast<double>(n) * dt_s);
    z[k] *= std::sqrt(std::max(value_at(effect, f_hz), 0.0));
  }
  fft.inv(noise, z);
}

}  // namespace

void shape_spectrum(const UnnamedEffect& effect, double dt_s, std::vector<double>& noise) {
  const std::size_t length = fast_length(noise.size());  // a prime length would take its square in time
  if (length < 2) {
    return;
  }
  const std::size_t rest = noise.size() - length;
  std::vector<double> last(noise.begin() + static_cast<std::ptrdiff_t>(rest), noise.end());
  noise.resize(length);
  shape(effect, dt_s, noise);
  if (rest > 0) {
    shape(effect, dt_s, last);
    noise.insert(noise.end(), last.end() - static_cast<std::ptrdiff_t>(rest), last.end());
  }
}

}  // namespace driftlab::investigate
