#pragma once
/// What a regression run is given: two sets of recordings of one device, what is known of each, and the settings.
///
/// Only stored results are read (core/campaign/reported_channel.hpp): curves, fits, contamination and the facts of each
/// file. No samples are needed.
#include "core/campaign/regression/critical.hpp"
#include "core/campaign/reported_channel.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::regression {

/// Facts of one channel as recorded.
struct ChannelFacts {
  std::size_t samples = 0;                    ///< of the file
  std::size_t missing = 0;                    ///< cells without a number, or with one that stands for none
  std::size_t frozen = 0;                     ///< samples of a stretch in which the sensor gives one value only
  std::size_t repeated = 0;                   ///< samples equal to the one before
  std::size_t saturated = 0;                  ///< samples at a full-scale value
  std::size_t bursts = 0;                     ///< of gross errors: those within 1 s of each other are one
  double resolution = 0.0;                    ///< step of the lattice [channel unit]; 0: none
  std::optional<double> mean = std::nullopt;  ///< of the analysed samples [channel unit]
  bool mean_of_error = false;                 ///< a reference was subtracted first
};

/// Of a column as the quality of its file and the test for gross errors of the channel (core/fit/characterisation.hpp)
/// tell them: cells that stand for no number count as missing, and where samples were not flagged one by one (or in
/// results of before bursts were counted) each flagged one is a burst by itself. `mean` and `mean_of_error` are not of
/// these.
[[nodiscard]] ChannelFacts facts_of(const Quality& quality, std::string_view column,
                                    const std::optional<Contamination>& contamination);

struct ComparedChannel {
  ReportedChannel result;
  ChannelFacts facts;
};

/// The stated full-scale range of a sensor; nothing if it was not stated.
struct FullScales {
  std::optional<double> gyroscope;      ///< [rad/s]
  std::optional<double> accelerometer;  ///< [m/s^2]
};

/// The stated sampling rate [Hz]: the rate of the time stamps divided by its ratio to the stated one, or the rate used
/// if there are no stamps. Nothing if there are stamps and no stated rate. An argument of zero is not known.
[[nodiscard]] inline std::optional<double> stated_rate_hz(double measured_hz, double clock_ratio, double used_hz) {
  if (!(measured_hz > 0.0)) {
    return used_hz;
  }
  return clock_ratio > 0.0 ? std::optional(measured_hz / clock_ratio) : std::nullopt;
}

struct ComparedRecording {
  std::string id;
  std::string session;            ///< empty: not stated
  std::optional<double> began_s;  ///< time of its first sample, seconds since 1970 (UTC)
  std::string condition;          ///< compact form, `static`
  double duration_s = 0.0;
  double rate_hz = 0.0;               ///< 1/dt of the analysed samples
  std::optional<double> declared_hz;  ///< as stated
  double jitter_s = 0.0;
  bool stamped = false;  ///< its samples have time stamps
  std::size_t samples = 0;
  std::size_t missing = 0;  ///< samples that the time column says are missing
  std::optional<double> temperature_degc;
  FullScales full_scale = {};
  bool investigated = false;        ///< an investigation looked for causes
  std::vector<std::string> causes;  ///< identified ones
  std::vector<std::string> notes;   ///< what the quality of its file says: a unit that looks wrong, a frozen sensor
  std::vector<ComparedChannel> channels;

  /// Sets rate and duration by the grid of the first channel, of which samples may be missing. Needs a channel.
  void time_by_channels();
  /// Copies the figures of the whole file from the quality: samples, gaps, jitter and the declared rate; and its notes.
  /// Needs `rate_hz`.
  void tell(const Quality& quality);
};

/// An arm, or an earlier release.
struct Recordings {
  std::string label;  ///< `firmware=1.5.0`; empty: not stated
  std::vector<ComparedRecording> recordings;
};

struct Exclusion {
  std::string recording;
  std::string reason;
};

/// Margins of a sensor in per cent of the deviation, by tau: to 1 s, to 10 s, above.
struct Margins {
  std::array<double, 3> percent = {10.0, 25.0, 50.0};
};

/// How far a bias may move; 0: it is told and not tested.
struct BiasMargins {
  double gyroscope = 0.0;      ///< [rad/s]
  double accelerometer = 0.0;  ///< [m/s^2]
  [[nodiscard]] bool any() const { return gyroscope > 0.0 || accelerometer > 0.0; }
};

/// How far a scale factor may move, as a ratio; 0: it is told and not tested.
struct ScaleMargins {
  double gyroscope = 0.0;
  double accelerometer = 0.0;
  [[nodiscard]] bool any() const { return gyroscope > 0.0 || accelerometer > 0.0; }
};

/// Where facts of the files begin to count (event_checks.hpp, comparability.hpp).
struct EventLimits {
  double missing = 0.005;            ///< share of missing, frozen or repeated samples above the baseline's largest
  double jitter = 2.0;               ///< of the stamps, times the baseline's largest, and
  double jitter_of_interval = 0.05;  ///< of the sample interval
  double resolution = 1.5;           ///< growth of the step of the values
  double contamination = 2.0;        ///< growth of the rate of bursts of gross errors
  std::size_t findings = 2;          ///< candidate sessions that show an identified cause
  double rate = 0.005;               ///< of the sampling rate
  double temperature_k = 5.0;        ///< between the arms
  double repeatability = 4.0;        ///< kL of session_scatter.hpp
};

struct Settings {
  TestSettings test;
  Margins gyroscope = {};
  Margins accelerometer = {{20.0, 25.0, 50.0}};
  double margin_sigma_percent = 25.0;  ///< of levels without a power of time: sigma, B
  double margin_slow_percent = 50.0;   ///< of the others beside N: K, Q, R
  Tau0 tau0_gyroscope = kGyroscopeTau0;
  Tau0 tau0_accelerometer = kAccelerometerTau0;
  double min_edf = 10.0;
  BiasMargins bias = {};
  ScaleMargins scale_factor = {};
  EventLimits limits = {};
};

struct Request {
  std::string device;
  Recordings baseline;
  Recordings candidate;
  std::vector<Recordings> history;  ///< earlier releases, oldest first
  /// How many of them came before the baseline; left out: all. Where every recording has a time, times decide.
  std::optional<std::size_t> before_baseline = std::nullopt;
  std::vector<Exclusion> excluded;
  Settings settings;
};

}  // namespace driftlab::regression
