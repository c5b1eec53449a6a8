#pragma once
/// What a regression run compares: the curves of several sessions of one sensor before and after a change, on one list
/// of rows.
///
/// A row is one scale of one unit (device x condition x sensor x axis). The value of a row is the logarithm of a
/// deviation, x = 1/2 [ln nu^ - psi(eta/2) + ln(eta/2)] (spec/regression.md, eq. 1), so that a difference of 0.095 is
/// ten per cent. A session is one power-up of the device and the replicate of everything that follows: what several
/// recordings of one power-up say together is one value per row.
///
/// The model (eq. 2): x_r = mu_arm(r) + b_r + e_r; e_r is the error of sampling with covariance S_r/4, known from the
/// length of the session, and b_r is what the session adds, with the covariance K of session_scatter.hpp.
#include "core/campaign/regression/measured_constants.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace driftlab::regression {

/// A level of a process of the model fitted to the pooled curve of a unit.
struct Level {
  std::string process;    ///< registry name
  std::string parameter;  ///< as declared by its kind: N, sigma, ...
  double margin = 0.0;    ///< [ln deviation]
  bool gated = false;     ///< must be shown to be within the margin
};

/// One unit and its place in the rows.
struct Unit {
  Tau0 tau0 = kGyroscopeTau0;
  std::size_t first = 0;  ///< its first row
  std::size_t count = 0;  ///< of its rows, which follow each other with rising tau
  /// Model of the pooled curve: 1/2 ln nu per row, and D = d ln deviation/d ln level (rows x levels). Empty without
  /// levels: the unit has no parameters to compare.
  std::vector<Level> levels = {};
  Eigen::VectorXd modelled = {};
  Eigen::MatrixXd sensitivity = {};
  std::size_t shapes = 0;  ///< parameters of the model that are no levels
};

struct Row {
  std::size_t unit = 0;
  int octave = 0;  ///< j: neighbours differ by one
  double tau_s = 0.0;
  double margin = 0.0;  ///< [ln deviation]
};

/// S_r/4 per unit of sessions of equal lengths, rows of the unit both ways. Sessions share it, and are then treated
/// alike at the cost of one.
using Sampling = std::vector<Eigen::MatrixXd>;

enum class Arm { Baseline, Candidate, History };

struct Session {
  Arm arm = Arm::Baseline;
  std::size_t release = 0;  ///< which of the earlier releases a session of the history belongs to
  std::size_t group = 0;    ///< sessions of one group are of one device under the same conditions
  Eigen::VectorXd x;        ///< per row
  std::vector<bool> has;    ///< per row: the session is long enough for it
  std::shared_ptr<const Sampling> sampling;
};

struct Design {
  std::vector<Unit> units;
  std::vector<Row> rows;  ///< by unit, in each with rising tau
  std::vector<Session> sessions;

  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(rows.size()); }
  [[nodiscard]] std::size_t count(Arm arm) const {
    std::size_t found = 0;
    for (const Session& session : sessions) {
      found += session.arm == arm ? 1U : 0U;
    }
    return found;
  }
};

}  // namespace driftlab::regression
