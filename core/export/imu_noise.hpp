#pragma once
/// The noise of an inertial sensor in the few numbers that filters and simulators of other projects ask for.
///
/// Every such program holds one of two models, and each is fitted here as what it is, not read off a richer one:
/// - White noise and a bias that walks (`WN+RW`): two numbers for each axis, N and K. Kalibr, VINS, ORB-SLAM3,
///   OpenVINS, GTSAM and the estimators of PX4 and ArduPilot mean this one.
/// - White noise and a bias that forgets (`WN+GM`, first-order Gauss-Markov): N, the standard deviation of the bias and
///   its correlation time. KF-GINS, NaveGo, gnss-ins-sim and Gazebo mean this one.
///
/// Both are joint GMWM fits to the Haar wavelet variances of all recordings of the axis (core/campaign/replicates.hpp):
/// the robust variances where gross errors move the classical ones.
///
/// N is the density at low frequencies, the coefficient N of IEEE Std 952 that a characterisation reports whatever its
/// best model is (core/fit/ieee952_coefficients.hpp): what a filter integrates. Where that is refused, the N of the fit
/// `WN+RW` stands for it and its remark says so.
///
/// A Gauss-Markov process is a bias only where it is slow against the sampling: its correlation time T is ten sample
/// intervals dt at least. What forgets faster is the noise of the readings as the sensor's own low-pass or an averaging
/// colours it, and N has its density at low frequencies already: it counts processes faster than five samples, and
/// never one slower than ten. As a bias it would count twice. Nor could the programs run it: they step a bias by
/// 1 - dt/T, which gives it 1/(1 - dt/2T) of the variance stated, 5 % more at ten intervals, twice as much at one, and
/// no bound at a half. Such a process is left out with the reason, and no walk stands for it: the fit `WN+RW` does
/// not know of the colour.
///
/// A bias instability is no standard deviation of a bias, and is not exported as one.
#include "core/campaign/sensor_sources.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/quantity.hpp"
#include "core/signal/result.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// A number in SI with its 95 % interval, or the reason why there is none.
struct NoiseFigure {
  std::optional<double> value;
  std::optional<double> low;   ///< empty: the data do not bound it there
  std::optional<double> high;  ///< likewise
  bool limit = false;          ///< the value is an upper limit (95 %), for the data do not identify it
  std::string remark;          ///< where it comes from, or why it is not there; a sentence, may be empty

  /// The figure in another unit or by another convention: all ends times `factor`.
  [[nodiscard]] NoiseFigure scaled(double factor) const;
  /// Of a deviation the variance.
  [[nodiscard]] NoiseFigure squared() const;
};

/// One axis of one sensor.
struct AxisNoise {
  std::string axis;           ///< x, y, z; empty: not stated
  std::string channel;        ///< column name in the first recording
  double rate_hz = 0.0;       ///< of the recording
  double duration_s = 0.0;    ///< of the longest recording
  NoiseFigure density;        ///< N [unit/sqrt(Hz)], two-sided: the variance of the integral over t is N^2 t
  NoiseFigure walk;           ///< K [unit/s/sqrt(Hz)]: the variance of the bias grows by K^2 a second
  NoiseFigure bias_sd;        ///< of the Gauss-Markov bias [unit]
  NoiseFigure correlation_s;  ///< of the Gauss-Markov bias, 1/beta
};

struct SensorNoise {
  std::vector<AxisNoise> axes;  ///< x before y before z
  std::string missing;          ///< why there are none; empty: there are
};

struct ImuNoise {
  std::string device;
  std::string condition;                ///< of the recordings used, for people
  std::vector<std::string> recordings;  ///< ids, each once
  SensorNoise gyroscope;                ///< rad/s
  SensorNoise accelerometer;            ///< m/s^2
  double rate_hz = 0.0;                 ///< at which the user of the numbers samples: the gyroscope's, or the only one
};

/// Of the channels of one device. Recordings at rest are used; where there are none, those of the first condition in
/// table order. Axes without a unit, or whose recordings are in units that do not convert into each other, are left
/// out, and the sensor says why. Where the Gauss-Markov fit does not identify the bias but the walk is known, the walk
/// is given as a Gauss-Markov process of the record's length, which grows by K^2 a second at first; its remark says so.
/// Errors: NotFound (neither a gyroscope nor an accelerometer); Cancelled.
[[nodiscard]] Result<ImuNoise> imu_noise_of(const std::string& device, const std::vector<SensorSources>& sensors,
                                            const RunControl& control);

}  // namespace driftlab
