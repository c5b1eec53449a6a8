#pragma once
/// The design of a comparison, written down unit by unit from what the sessions measured: the rows that both arms reach
/// with enough degrees of freedom, their margins, the levels of the pooled model and which of them must be shown.
#include "core/campaign/regression/compared_sessions.hpp"
#include "core/campaign/regression/design.hpp"
#include "core/campaign/regression/report.hpp"

#include <cstddef>
#include <stop_token>
#include <vector>

namespace driftlab::regression {

class DesignBuilder {
 public:
  /// Both must outlive the builder.
  DesignBuilder(const ComparedSessions& sessions, const Settings& settings);

  /// Adds the rows of one unit and writes its scales, model and degrees of freedom into `told`. False, and nothing
  /// added, where no scale has enough degrees of freedom in both arms, or once `stop` is requested.
  [[nodiscard]] bool add(const NamedUnit& named, UnitReport& told, const std::stop_token& stop = {});

  /// Once, after the last unit: the sessions with their rows and the laws of their errors of sampling.
  void finish();

  [[nodiscard]] const Design& design() const { return design_; }
  /// Whether a unit had recordings of different rates.
  [[nodiscard]] bool mixed_rates() const { return mixed_rates_; }

 private:
  [[nodiscard]] Arm arm_of(std::size_t session) const;
  [[nodiscard]] std::size_t release_of(std::size_t session) const;
  /// As far as both arms reach with enough degrees of freedom in one session of each.
  [[nodiscard]] std::size_t rows_of(const PooledUnit& pooled) const;
  void add_session(std::size_t s, const SessionCurve& curve, std::size_t rows, UnitReport& told);

  const ComparedSessions& sessions_;
  const Settings& settings_;
  std::vector<const PowerUp*> all_;
  std::vector<std::vector<double>> x_;
  std::vector<std::vector<bool>> has_;
  std::vector<Sampling> sampling_;
  Design design_;
  bool mixed_rates_ = false;
};

}  // namespace driftlab::regression
