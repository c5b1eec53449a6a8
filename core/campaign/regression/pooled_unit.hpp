#pragma once
/// The curves of one unit (condition x sensor x axis) over all sessions, on one list of rows, with the covariance of
/// their errors of sampling.
///
/// Rows are the octaves of the coarsest sample interval: scales are compared at equal tau in seconds. Where a recording
/// has no scale at that tau, its nearest is taken times the ratio of the mixture at both. Several recordings of a
/// session are averaged with weights edf_j. S and eta come from the mixture fitted to the pooled curve of both arms,
/// not from that of a session, so that its own fluctuation does not choose its weight; what the samples' kurtosis adds
/// is taken from the degrees of freedom that were stored. If a channel of either arm has gross errors, all sessions are
/// compared by their robust variances, also those without gross errors: heavy-tailed noise has a smaller robust
/// variance than classical variance, so that a different estimator in each arm would look like a change of the noise.
/// Kurtosis is then not corrected for, and each estimate has the efficiency that was stored with its recording.
///
/// The model is the candidate with the least sum of criteria over all recordings, fitted to the pooled curve. Its
/// levels are named by the registry, so that a new process is compared as soon as it is fitted.
#include "core/campaign/regression/recordings.hpp"

#include <Eigen/Core>

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace driftlab::regression {

/// One session's recordings of the channel; empty where it has none.
using SessionChannels = std::vector<const ReportedChannel*>;

struct SessionCurve {
  Eigen::VectorXd x;         ///< per row, eq. (1)
  Eigen::VectorXd edf;       ///< per row; 0 where the session has none
  Eigen::MatrixXd sampling;  ///< S/4
};

struct PooledUnit {
  std::vector<double> tau_s;           ///< rows, rising by octaves
  std::vector<SessionCurve> sessions;  ///< as given
  std::string model;                   ///< of the pooled curve; empty: none
  std::vector<Level> levels;           ///< without margins
  Eigen::VectorXd modelled;            ///< 1/2 ln nu per row
  Eigen::MatrixXd sensitivity;
  std::size_t shapes = 0;
  bool robust = false;       ///< by robust variances, for one of the arms has gross errors
  bool mixed_rates = false;  ///< the recordings have different sample intervals
};

/// `sessions`: those of both arms and, after them, those of earlier releases; the first `compared` make the pooled
/// curve. Nothing where no curve is left. Cost: one lag plan per length of recording, some ms each.
/// `stop` is polled before each session; nothing then.
[[nodiscard]] std::optional<PooledUnit> pool_unit(const std::vector<SessionChannels>& sessions, std::size_t compared,
                                                  const std::stop_token& stop = {});

}  // namespace driftlab::regression
