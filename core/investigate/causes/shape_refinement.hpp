#pragma once
/// How the shape of a mean effect is refined. A cause tries a list of shapes; the best of them is kept as it is, or
/// refined as a time constant or as a phase.
#include "core/signal/estimate.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {

class ShapeRefinement {
 public:
  /// No refinement: the shape is one of the tried values.
  ShapeRefinement() = default;
  /// A time [s], zero or more.
  [[nodiscard]] static ShapeRefinement time() { return ShapeRefinement(Kind::Time, 0.0); }
  /// A phase. Adding half a period changes the sign of the effect, so that its amplitude can always be made positive.
  [[nodiscard]] static ShapeRefinement phase(double period) { return ShapeRefinement(Kind::Phase, period); }

  [[nodiscard]] bool refined() const { return kind_ != Kind::Tried; }
  /// Whether the shape is a phase.
  [[nodiscard]] bool turns() const { return kind_ == Kind::Phase; }

  /// Step of a difference quotient at `shape`.
  [[nodiscard]] double difference(double shape) const {
    return turns() ? period_ / 360.0 : std::max(0.02 * shape, 0.05);
  }

  /// A typical standard error of the shape of a clear effect, with which the search for the end of an interval begins.
  [[nodiscard]] double usual_error(double shape) const {
    return turns() ? period_ / 100.0 : std::max(0.5, 0.15 * shape);
  }

  /// The largest interval about `shape`.
  [[nodiscard]] Interval bounds(double shape) const {
    constexpr double kLongest = 1e5;  // [s]
    return turns() ? Interval{shape - 0.5 * period_, shape + 0.5 * period_} : Interval{0.0, kLongest};
  }

  /// The nearest valid shape: times are not negative.
  [[nodiscard]] double nearest(double shape) const { return turns() ? shape : std::max(0.0, shape); }

  /// The shape at which the effect of `shape` and `amplitude` has a positive amplitude. A time is returned unchanged.
  [[nodiscard]] double for_positive(double shape, double amplitude) const {
    return turns() ? std::fmod(shape + (amplitude < 0.0 ? 0.5 * period_ : 0.0) + period_, period_) : shape;
  }

  /// The shape near `start` with the largest `score(shape)`, by steps of decreasing length to either side.
  template <class Score>
  [[nodiscard]] double best_near(double start, const Score& score) const {
    if (!refined()) {
      return start;
    }
    const bool by_share = !turns() && start >= 1.0;  // steps are shares of a time, but seconds near zero
    const double shrink = turns() ? 0.6 : 0.55;
    double width = turns() ? period_ / 72.0 : (by_share ? 0.4 : 2.0);
    double best = start;
    double top = score(start);
    for (int i = 0; i < (turns() ? 12 : 7); ++i, width *= shrink) {
      const double from = best;
      for (const double step : {-width, width}) {
        const double trial = by_share ? from * std::exp(step) : from + step;
        if (!turns() && trial < 0.0) {
          continue;
        }
        const double here = score(trial);
        if (here > top) {
          top = here;
          best = trial;
          break;
        }
      }
    }
    return best;
  }

 private:
  enum class Kind { Tried, Time, Phase };
  ShapeRefinement(Kind kind, double period) : kind_(kind), period_(period) {}

  Kind kind_ = Kind::Tried;
  double period_ = 0.0;
};

}  // namespace driftlab::investigate
