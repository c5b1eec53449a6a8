#pragma once
/// One parameter over all devices of a model: the mean of the production line, the spread between its devices, and the
/// devices that do not belong to it.
///
/// Model (random effects): y_i = ln value_i = mu + u_i + e_i over devices i = 1..k. u_i ~ N(0, tau^2) is the deviation
/// of a device from the mean; e_i ~ N(0, s_i^2) is the error of its estimate, s_i the half-width of its 95 % interval
/// on the log scale over 1.96. Error parameters are positive, so logarithms are their scale, and tau = 0.1 is 10 %.
///
/// Mean: weights 1/(s_i^2 + tau^2) with tau by restricted maximum likelihood.
///
/// Intervals and flags need more than a plug-in: where tau is of the size of s_i, few devices say little about it. A
/// prediction that takes it for known holds 84 % instead of 95, and the interval of Hartung and Knapp (2001) for the
/// mean is too short as well, for its weights are those of an estimate. All therefore average over tau,
///   p(tau | y) ~ 1/(s + tau) x restricted likelihood,   s the geometric mean of the s_i,
/// on 64 points.
///
/// Interval of the mean: quantiles of the mixture over tau of mu(tau) + t(k - 1) sqrt(q(tau)/((k - 1) W(tau))), W the
/// sum of the weights and q the weighted squares about mu: that of Hartung and Knapp at each tau. Where all s_i are
/// alike, and where tau is far above them, it is Student's interval, exactly.
///
/// Prediction: mu normal given tau. For tau far above the s_i this is Student's t(k - 1), exactly.
///
/// Outlying: device i is set against the prediction for an estimate of its precision from the k - 1 others (leave one
/// out), two-sided, and its p is corrected by Holm (1979) over the devices: of a population without outliers some 5 %
/// show one (6.1 % of 4,000 at 15 devices that differ by 10 %), per parameter and axis. Two outliers on one side hide
/// each other in small populations, for each widens the prediction for the other.
///
/// Sources: DerSimonian and Laird (1986); Viechtbauer (2005), eq. (11), for REML; Hartung and Knapp (2001), Stat. Med.
/// 20, 3875; Higgins, Thompson and Spiegelhalter (2009) for prediction; Holm (1979). Measured coverage and false flags:
/// tests/ACCURACY.md (tests/accuracy/population_test.cpp). Cost: O(k^2) with 64 points, some 10 ms at 100 devices.
#include "core/campaign/reported_channel.hpp"
#include "core/signal/result.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// One device's estimate. Units of all are equal where a value is there.
struct DeviceEstimate {
  std::string device;
  ReportedValue estimate;
};

/// Where a device stands.
struct DevicePlace {
  std::string device;
  ReportedValue estimate;
  double z = 0.0;  ///< (y - mu)/sqrt(tau^2 + s^2)
  /// Share of estimates of its precision that lie below it, by the other devices; nothing with fewer than four devices.
  std::optional<double> quantile;
  std::optional<double> p;       ///< two-sided
  std::optional<double> p_holm;  ///< corrected over the devices
  bool outlying = false;         ///< p_holm < 0.05
};

/// A device that is not used in the figures.
struct LeftOut {
  std::string device;
  std::string reason;
};

struct Population {
  std::string unit;
  std::vector<DevicePlace> places;      ///< in the order given
  std::vector<LeftOut> left_out;        ///< not identified, or with an interval that is open
  ReportedValue mean;                   ///< exp(mu) with its interval
  double spread = 0.0;                  ///< tau: standard deviation of ln value between devices
  double heterogeneity_q = 0.0;         ///< Cochran's Q
  double heterogeneity_p = 1.0;         ///< that all devices share one value
  std::optional<double> predicted_low;  ///< 95 % for the value of a further device; nothing with fewer than three
  std::optional<double> predicted_high;

  [[nodiscard]] std::size_t heterogeneity_dof() const { return places.size() - 1; }
  /// tau as people say it: by how many per cent a device differs from the mean, one standard deviation, to a tenth.
  [[nodiscard]] double differ_percent() const;
};

/// From here on a device is flagged.
inline constexpr double kOutlyingBelow = 0.05;

/// Error: TooFewSamples (fewer than two devices with a closed interval; the message says how many there are);
/// InvalidArgument (two units).
[[nodiscard]] Result<Population> describe_population(const std::vector<DeviceEstimate>& devices);

}  // namespace driftlab
