#pragma once
/// What the server remembers of regression runs of one device: which recordings a label means, the anchor, the last
/// label that passed, the releases before, and how many looks a candidate has had (spec/regression.md, sections 2 and
/// 8).
#include "core/analysis/regression_history.hpp"
#include "schema/json/regression.hpp"
#include "server/store/store.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

inline constexpr std::string_view kRegressKind = "regress";

/// The ids of the recordings of an arm of a pinned request.
[[nodiscard]] std::vector<std::string> regressed_ids(const Json& arm);

/// The runs of a device that stand: queued, running or succeeded.
class RegressionMemory {
 public:
  [[nodiscard]] static Result<RegressionMemory> of(Store& store, const Device& device);

  [[nodiscard]] const RegressionHistory& history() const { return history_; }
  /// The label that was last accepted as the baseline; before that, the label of the first baseline that had one.
  /// Empty: none.
  [[nodiscard]] Result<std::string> anchor() const;
  /// What goes with the anchor of the settings: those that were kept when it was moved, else those of the run that made
  /// the first baseline. Nothing where neither is known.
  [[nodiscard]] Result<std::optional<regression::Settings>> kept_settings() const;
  /// The candidate of the newest run that passed; empty: none.
  [[nodiscard]] Result<std::string> last_pass() const;
  /// The device's recordings that have the label, `firmware=1.5.0,board=b` all of it; without any, those that runs
  /// named under that label. Never the latest few: leaving one out needs a reason.
  [[nodiscard]] Result<std::vector<WrittenRecording>> recordings(const std::string& label,
                                                                 const std::string& pointer) const;
  /// "No recording of imu-07 has the label …; labels of this device: …".
  [[nodiscard]] Result<std::string> unknown_label(const std::string& label) const;

 private:
  RegressionMemory(Store& store, const Device& device) : store_(&store), device_(device) {}

  Store* store_;
  Device device_;
  RegressionHistory history_;
  std::string first_baseline_;
  Json first_settings_ = nullptr;                       ///< of the run that named it
  std::vector<std::string> succeeded_;                  ///< ids of runs, oldest first
  std::map<std::string, std::set<std::string>> named_;  ///< recordings by label
};

}  // namespace driftlab::server
