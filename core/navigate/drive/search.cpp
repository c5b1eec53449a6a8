#include "core/navigate/drive/joint_top.hpp"
#include "core/navigate/drive/profile.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace driftlab::drive {
namespace {

constexpr double kNamed = 5.0;  ///< score
constexpr double kSure = 3.0;   ///< standard errors
constexpr double kPair = 2.0;   ///< scores that differ by less are a pair
constexpr int kRefits = 2;
constexpr int kClimbs = 3;
constexpr double kWorthClimbing = 0.01;  ///< score
constexpr double kBound = 0.9;           ///< of the most that is sought: nearer to it an estimate is at its bound

/// One search: the causes that were named, and the options in which they are set.
class CauseSearch {
 public:
  CauseSearch(const Drive& drive, const FilterOptions& options, const RunControl& control)
      : drive_(drive), first_(options), profile_(drive, {true, true}, control) {
    result_.options = profile_.with_noise_fitted(options, 4.0);
  }

  /// Names the cause that the innovations show best; false where they show none.
  bool name_next() {
    std::vector<const Knob*> open;
    for (const Knob& knob : all_knobs()) {
      if (!knob.companion && is_open(knob)) {
        open.push_back(&knob);
      }
    }
    const double scale = profile_.scale(result_.options);
    const double at = profile_.values({result_.options}).front();
    auto estimates = profile_.estimates(result_.options, at, open, scale);
    std::vector<bool> tried(open.size(), false);
    const auto best_of = [&](auto&& counts) {
      while (true) {
        std::optional<std::size_t> best;
        for (std::size_t i = 0; i < open.size(); ++i) {
          const bool sure = estimates[i].sound && std::abs(estimates[i].value) >= kSure * estimates[i].se;
          if (sure && counts(i) && (!best || estimates[i].score > estimates[*best].score)) {
            best = i;
          }
        }
        if (!best || tried[*best]) {
          return best;
        }
        // A parabola through three points of a likelihood that is none promises a gain that is not there.
        const FilterOptions there = Profile::turned(result_.options, *open[*best], estimates[*best].value);
        const double gain = profile_.values({there}).front() - at;
        estimates[*best].score = std::min(estimates[*best].score, std::max(gain, 0.0) / scale);
        tried[*best] = true;
      }
    };
    const auto best = best_of([&](std::size_t i) { return estimates[i].score >= kNamed; });
    if (!best) {
      return false;
    }
    const Knob& knob = *open[*best];
    const auto rival = best_of([&](std::size_t i) { return open[i]->cause != knob.cause; });
    DriveFinding finding = finding_of(knob);
    if (rival && estimates[*best].score - estimates[*rival].score < kPair) {
      finding.pair = open[*rival]->cause;
    }
    add(knob, std::move(finding));
    result_.options = Profile::turned(result_.options, knob, estimates[*best].value);
    for (const Knob& beside : all_knobs()) {
      if (beside.companion && beside.cause == knob.cause && is_open(beside)) {
        add(beside, finding_of(beside));
      }
    }
    result_.options = profile_.refitted(result_.options, named_, 1);
    result_.options = profile_.with_noise_fitted(result_.options, 1.3);
    return true;
  }

  /// Values, uncertainties and scores at the end. What is not sure beside all the others is taken out again: until the
  /// last cause is set, its effect stands in those before it.
  SearchResult told() {
    do {
      result_.options = profile_.refitted(result_.options, named_, kRefits);
      climb_together();
      result_.options = profile_.with_noise_fitted(result_.options, 1.2);
    } while (!judge_or_drop());
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool is_open(const Knob& knob) const {  // setting one may let another apply
    return std::find(named_.begin(), named_.end(), &knob) == named_.end() &&
           (knob.applies == nullptr || knob.applies(drive_, result_.options));
  }

  void add(const Knob& knob, DriveFinding finding) {
    named_.push_back(&knob);
    result_.findings.push_back(std::move(finding));
  }

  /// Shares are left alone: they have their own ends, and errors that are no curvature.
  [[nodiscard]] JointTop joint_top(const std::vector<ProfileEstimate>& alone, double scale) const {
    std::vector<double> steps;
    for (std::size_t i = 0; i < named_.size(); ++i) {
      steps.push_back(named_[i]->share || !alone[i].sound ? 0.0 : std::min(alone[i].scatter, named_[i]->most));
    }
    return {profile_, result_.options, named_, steps, scale};
  }

  /// From where no knob alone raises the likelihood to where all of them together do not.
  void climb_together() {
    for (int climb = 0; climb < kClimbs && named_.size() > 1; ++climb) {
      const double scale = profile_.scale(result_.options);
      const double at = profile_.values({result_.options}).front();
      const auto alone = profile_.estimates(result_.options, at, named_, scale);
      FilterOptions top = joint_top(alone, scale).at_top();
      if (profile_.values({top}).front() < at + kWorthClimbing * scale) {
        return;
      }
      result_.options = std::move(top);
    }
  }

  /// By how much the search has turned a knob.
  [[nodiscard]] double turned_by(const Knob& knob) const { return knob.value(result_.options) - knob.value(first_); }

  /// Fills in the findings, whose score is what the likelihood loses without each; false if one was not sure, which has
  /// been taken out then.
  bool judge_or_drop() {
    const double scale = profile_.scale(result_.options);
    const double at = profile_.values({result_.options}).front();
    const auto last = profile_.estimates(result_.options, at, named_, scale);
    const JointTop joint = joint_top(last, scale);
    result_.mean_square = scale / 3.0;
    std::optional<std::size_t> least;
    for (std::size_t i = 0; i < named_.size(); ++i) {
      const Knob& knob = *named_[i];
      DriveFinding& finding = result_.findings[i];
      const double value = turned_by(knob);
      finding.value = knob.value(result_.options) * knob.per_si;
      if (knob.magnitude) {
        finding.value = std::abs(finding.value);
      }
      const auto stated = [&](double scatter) {
        return std::hypot(last[i].se, std::sqrt(std::max(scatter * scatter - last[i].scatter * last[i].scatter, 0.0)));
      };
      finding.se = stated(joint.se(i)) * knob.per_si;
      const double change = profile_.change(result_.options, knob);
      const double wanted = std::max(std::abs(change), std::abs(change + last[i].value));
      finding.at_bound = !knob.share && wanted > kBound * knob.most;
      const double without = profile_.values({Profile::turned(result_.options, knob, -value)}).front();
      finding.score = std::max((at - without) / scale, 0.0);
      const bool doubted =
          finding.score < kNamed || (last[i].sound && std::abs(value) < kSure * stated(joint.se_beside_companions(i)));
      if (!knob.companion && doubted && (!least || finding.score < result_.findings[*least].score)) {
        least = i;
      }
    }
    if (least) {
      drop(*named_[*least]);
    }
    return !least;
  }

  /// Takes a parameter out, and its companions.
  void drop(const Knob& dropped) {
    for (std::size_t i = named_.size(); i-- > 0;) {
      const Knob& knob = *named_[i];
      if (&knob == &dropped || (knob.companion && knob.cause == dropped.cause)) {
        result_.options = Profile::turned(result_.options, knob, -turned_by(knob));
        named_.erase(named_.begin() + static_cast<std::ptrdiff_t>(i));
        result_.findings.erase(result_.findings.begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
  }

  const Drive& drive_;
  FilterOptions first_;  ///< without any cause
  Profile profile_;
  std::vector<const Knob*> named_;
  SearchResult result_;
};

}  // namespace

Result<SearchResult> search_causes(const Drive& drive, const FilterOptions& options, int most_causes,
                                   const RunControl& control) {
  if (auto sound = log_likelihood(drive, options); !sound) {
    return fail(sound.error());
  }
  CauseSearch search(drive, options, control);
  for (int causes = 0; causes < most_causes && !control.stop.stop_requested() && search.name_next(); ++causes) {
  }
  SearchResult result = search.told();
  return control.stop.stop_requested() ? fail(ErrorCode::Cancelled, "The search was cancelled.")
                                       : Result<SearchResult>(std::move(result));
}

}  // namespace driftlab::drive
