#include "core/investigate/causes/chirp_search.hpp"

#include "core/signal/turns.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr double kShortestPiece = 4.0;      ///< [s], but no more than kFewSamples
constexpr std::size_t kFewSamples = 512;    ///< of a piece, where a recording is short
constexpr std::size_t kMostSamples = 2048;  ///< of a piece
constexpr double kMostAdded = 4e8;          ///< samples of a recording times those of a piece, beyond kFewSamples
constexpr std::size_t kPieces = 32;         ///< of a recording, where a piece has samples between these two
constexpr std::size_t kMostRows = 1500;     ///< of a map: neighbouring pieces are added where there are more
constexpr std::size_t kFewest = 6;          ///< pieces: in fewer any slope fits
constexpr double kLowest = 0.5;             ///< [Hz]: below, slow noise runs too
constexpr double kLeastRun = 0.5;           ///< [Hz] from one end to the other: less is a line that wanders
constexpr double kSlope = 4.0;           ///< from a map to the next, in 1/L^2: a seventh of the power is lost half-way
constexpr std::size_t kCandidates = 64;  ///< lines that go to stage 2
constexpr double kMostFollowed = 20e6;   ///< samples that stage 2 beats, of all its lines together
constexpr double kMostWeighed = 4e6;     ///< samples of all recordings, beyond which stage 2 takes innovations as white
constexpr std::size_t kCell = 8;         ///< ordinates: of one cell the best line alone is a candidate

std::size_t piece_of(const FullRate& data) {
  std::size_t shortest = data.innovation.front().size();
  for (const Series& e : data.innovation) {
    shortest = std::min(shortest, e.size());
  }
  const auto least = std::min(kFewSamples, static_cast<std::size_t>(std::max(16.0, kShortestPiece / data.dt_s)));
  const auto most = static_cast<std::size_t>(kMostAdded / static_cast<double>(shortest));
  return fast_length(std::clamp(std::min(shortest / kPieces, most), least, std::max(least, kMostSamples)));
}

std::size_t ordinates_of(std::size_t piece) { return 2 * (piece / 2) + 1; }

/// Power of the pieces of one recording against one slope, at ordinates of half a reciprocal length of a piece, each in
/// units of its mean. Between two frequencies of the transform, the difference of their values is what a line half-way
/// adds to with both; without it the power of a line is 0.77 of the whole on the average, with it 0.88.
class Map {
 public:
  Map(const FullRate& data, std::size_t r, std::size_t piece)
      : e_(&data.innovation[r]),
        piece_(piece),
        bins_(ordinates_of(piece)),
        pieces_(e_->size() / piece),
        together_(pieces_ / kMostRows + 1),
        rows_((pieces_ + together_ - 1) / together_) {}

  /// Adds the power along lines from ordinate a to a + run, both on the map, for every a from `begin` to `end`.
  void add_lines(long run, std::size_t begin, std::size_t end, std::vector<float>& sums) {
    const long slope = std::lround(std::fabs(static_cast<double>(run)) / (2.0 * kSlope * static_cast<double>(pieces_)));
    if (slope != slope_) {
      take(slope);
    }
    const double per_row = static_cast<double>(run) / static_cast<double>(rows_);
    for (std::size_t row = 0; row < rows_; ++row) {
      const auto offset = static_cast<long>(std::floor(per_row * (static_cast<double>(row) + 0.5) + 0.5));
      const float* const power =
          (run > 0 ? rising_ : falling_).data() + static_cast<std::ptrdiff_t>(row * bins_) + offset;
      for (std::size_t a = begin; a < end; ++a) {
        sums[a] += power[a];
      }
    }
  }

 private:
  /// Of a slope up and down: against exp(i a) and exp(-i a), a row of cosines C and of sines S gives C + i S and C - i
  /// S.
  void take(long slope) {
    slope_ = slope;
    rising_.assign(rows_ * bins_, 0.0F);
    falling_.assign(rows_ * bins_, 0.0F);
    std::vector<std::complex<double>> turn(piece_);
    const auto n = static_cast<double>(piece_);
    for (std::size_t i = 0; i < piece_; ++i) {
      const double middle = static_cast<double>(i) - 0.5 * n;
      turn[i] = std::polar(1.0, std::numbers::pi * kSlope * static_cast<double>(slope) * middle * middle / (n * n));
    }
    std::vector<double> even(piece_);
    std::vector<double> odd(piece_);
    for (std::size_t p = 0; p < pieces_; ++p) {
      for (std::size_t i = 0; i < piece_; ++i) {
        const double value = (*e_)[p * piece_ + i];
        even[i] = value * turn[i].real();
        odd[i] = value * turn[i].imag();
      }
      const auto cosines = half_spectrum_of(even);
      auto sines = slope == 0 ? std::vector<std::complex<double>>(cosines.size()) : half_spectrum_of(odd);
      for (std::complex<double>& value : sines) {
        value = {-value.imag(), value.real()};
      }
      const std::size_t row = p / together_ * bins_;
      for (std::size_t k = 0; 2 * k < bins_; ++k) {
        add_ordinate(rising_.data() + row, k, cosines, sines, -1.0);
        add_ordinate(falling_.data() + row, k, cosines, sines, 1.0);
      }
    }
    normalise(rising_);
    normalise(falling_);
  }

  /// Power of cosines + sign sines at frequency k of the transform, and half-way to the next.
  void add_ordinate(float* row, std::size_t k, const std::vector<std::complex<double>>& cosines,
                    const std::vector<std::complex<double>>& sines, double sign) const {
    const std::complex<double> here = cosines[k] + sign * sines[k];
    row[2 * k] += static_cast<float>(std::norm(here));
    if (2 * k + 1 < bins_) {
      row[2 * k + 1] += static_cast<float>(0.5 * std::norm(here - cosines[k + 1] - sign * sines[k + 1]));
    }
  }

  void normalise(std::vector<float>& power) const {
    constexpr float kMost = 20.0F;
    std::vector<float> mean(bins_, 0.0F);
    for (std::size_t row = 0; row < rows_; ++row) {
      for (std::size_t k = 0; k < bins_; ++k) {
        mean[k] += power[row * bins_ + k] / static_cast<float>(rows_);
      }
    }
    for (std::size_t row = 0; row < rows_; ++row) {
      for (std::size_t k = 0; k < bins_; ++k) {
        float& value = power[row * bins_ + k];
        value = mean[k] > 0.0F ? std::min(value / mean[k], kMost) : 0.0F;
      }
    }
  }

  const Series* e_;
  std::size_t piece_, bins_, pieces_, together_, rows_;
  long slope_ = -1;  ///< none yet
  std::vector<float> rising_, falling_;
};

/// From ordinate `from` to `from` + `run`, and the power along it.
struct Line {
  float sum = 0.0F;
  std::size_t from = 0;
  long run = 0;
};

/// The best lines of different cells of both ends.
class BestLines {
 public:
  explicit BestLines(std::size_t bins) : across_(bins / kCell + 1), cells_(across_ * (2 * across_ + 1)) {}

  void take(const std::vector<float>& sums, std::size_t begin, std::size_t end, long run) {
    Line* const cells =
        cells_.data() + (static_cast<std::size_t>(run + static_cast<long>(across_ * kCell)) / kCell) * across_;
    for (std::size_t a = begin; a < end; ++a) {
      Line& cell = cells[a / kCell];
      if (sums[a] > cell.sum) {
        cell = {sums[a], a, run};
      }
    }
  }

  /// Those that hold most, the first before the others.
  [[nodiscard]] std::vector<Line> most(std::size_t count) {
    count = std::min(count, cells_.size());
    std::partial_sort(cells_.begin(), cells_.begin() + static_cast<std::ptrdiff_t>(count), cells_.end(),
                      [](const Line& a, const Line& b) { return std::pair(b.sum, a.run) < std::pair(a.sum, b.run); });
    return {cells_.begin(), cells_.begin() + static_cast<std::ptrdiff_t>(count)};
  }

 private:
  std::size_t across_;
  std::vector<Line> cells_;
};

/// ln of the chance that the mean of m unit exponentials exceeds `ratio`, about.
double surprise(double ratio, double m) { return ratio > 1.0 ? m * (ratio - 1.0 - std::log(ratio)) : 0.0; }

/// A sweep followed from nearby: sums against it, and what a step away from it makes of them.
class Follower {
 public:
  /// `power`: of the recordings of the scope, in its order; null: of white innovations.
  Follower(const FullRate& data, const std::vector<std::size_t>& scope, const std::vector<const BandPower*>& power,
           const Sweep& near, double reach_hz)
      : data_(&data), near_(near), longest_s_(longest_s(data, scope)) {
    const auto block = static_cast<std::size_t>(std::max(1.0, 2.0 / (kStretch * reach_hz * data.dt_s)));
    for (std::size_t k = 0; k < scope.size(); ++k) {
      beaten_.push_back(beat(data, scope[k], near, block));
      excess_.push_back(power[k] != nullptr ? power[k]->most_between(near.f_hz, near.at(longest_s_)) : 1.0);
    }
  }

  /// Over stretches of 2/reach, and of twice, four and eight times that, each on a grid of half the spacing about the
  /// best.
  void look_around() {
    for (int level = 0; level < 4; ++level) {
      look_over_twice_as_long();
    }
  }

  /// Over ever longer ones, to the whole.
  void look_closer() {
    while (kStretch * step_s() < longest_s_ && !data_->stopped()) {
      look_over_twice_as_long();
    }
    const auto whole = static_cast<std::size_t>(longest_s_ / step_s()) + 2;
    for (double spacing = 0.2 / longest_s_; spacing > 0.002 / longest_s_; spacing *= 0.4) {
      look(spacing, 2, whole);
    }
  }

  [[nodiscard]] double x() const { return best_; }
  /// Of the last look, in all recordings.
  [[nodiscard]] double stretches() const {
    double count = 0.0;
    for (std::size_t k = 0; k < beaten_.size(); ++k) {
      count += static_cast<double>(pieces_in(k, kStretch));
    }
    return count;
  }
  [[nodiscard]] Followed followed() const {
    return {{near_.f_hz + from_hz_, near_.slope_hz_s + (to_hz_ - from_hz_) / longest_s_}, best_};
  }

 private:
  [[nodiscard]] double step_s() const { return beaten_.front().step_s; }

  static constexpr std::size_t kStretch = 12;  ///< blocks

  void look_over_twice_as_long() {
    constexpr int kHalf = 4;
    if (looked_) {
      join_blocks();
    }
    looked_ = true;
    look(0.5 / (kStretch * step_s()), kHalf, kStretch);
  }

  /// Goes on from the best sweep so far, against which a block may be twice as long.
  void join_blocks() {
    const Sweep off{from_hz_, (to_hz_ - from_hz_) / longest_s_};
    for (Beaten& beaten : beaten_) {
      std::vector<std::complex<double>> joined((beaten.sums.size() + 1) / 2);
      for (std::size_t i = 0; i < beaten.sums.size(); ++i) {
        const double middle_s = (static_cast<double>(i) + 0.5) * beaten.step_s;
        joined[i / 2] += times(beaten.sums[i], std::polar(1.0, -off.phase(middle_s)));
      }
      beaten.sums = std::move(joined);
      beaten.step_s *= 2.0;
    }
    near_ = {near_.f_hz + off.f_hz, near_.slope_hz_s + off.slope_hz_s};
    from_hz_ = 0.0;
    to_hz_ = 0.0;
  }

  /// Sum of X where the frequency is off by df at the first sample and the slope by dc.
  [[nodiscard]] double value(double df, double dc, std::size_t stretch) const {
    double x = 0.0;
    for (std::size_t k = 0; k < beaten_.size(); ++k) {
      const double h = step_s();
      // The phase at the middle of block i, (i + 1/2) h, and its first two differences.
      std::complex<double> turn = std::polar(1.0, -kTurn * (0.5 * df * h + 0.125 * dc * h * h));
      std::complex<double> next = std::polar(1.0, -kTurn * (df * h + dc * h * h));
      const std::complex<double> more = std::polar(1.0, -kTurn * dc * h * h);
      std::complex<double> sum = 0.0;
      double square = 0.0;
      std::size_t left = stretch;
      for (const std::complex<double>& of : beaten_[k].sums) {
        sum += times(of, turn);
        turn = times(turn, next);
        next = times(next, more);
        if (--left == 0) {
          square += std::norm(sum);
          sum = 0.0;
          left = stretch;
        }
      }
      square += std::norm(sum);
      x += 2.0 * square / std::max(1.0, beaten_[k].samples) / excess_[k] * static_cast<double>(pieces_in(k, stretch));
    }
    return x;
  }

  [[nodiscard]] std::size_t pieces_in(std::size_t k, std::size_t stretch) const {
    return std::max<std::size_t>(1, (beaten_[k].sums.size() + stretch - 1) / stretch);
  }

  void look(double step, int half, std::size_t stretch) {
    const double centre_from = from_hz_;
    const double centre_to = to_hz_;
    best_ = -1.0;
    for (int i = -half; i <= half && !data_->stopped(); ++i) {
      for (int j = -half; j <= half; ++j) {
        const double from = centre_from + i * step;
        const double to = centre_to + j * step;
        const double x = value(from, (to - from) / longest_s_, stretch);
        if (x > best_) {
          best_ = x;
          from_hz_ = from;
          to_hz_ = to;
        }
      }
    }
  }

  const FullRate* data_;
  Sweep near_;
  double longest_s_;
  bool looked_ = false;
  std::vector<Beaten> beaten_;
  std::vector<double> excess_;
  double from_hz_ = 0.0, to_hz_ = 0.0;  ///< off the sweep it began with, at the first and at the last sample
  double best_ = 0.0;
};

Sweep sweep_of(const Line& line, double piece_s, double seconds) {
  return {0.5 * static_cast<double>(line.from) / piece_s, 0.5 * static_cast<double>(line.run) / piece_s / seconds};
}

/// The best lines of every scope, whose maps are made once.
std::vector<std::vector<Line>> lines_of(const FullRate& data, const std::vector<std::vector<std::size_t>>& scopes,
                                        const std::vector<std::size_t>& counts, std::size_t piece) {
  const std::size_t bins = ordinates_of(piece);
  const double df = 0.5 / (static_cast<double>(piece) * data.dt_s);
  const auto first = static_cast<std::size_t>(std::ceil(kLowest / df));
  const long least = std::lround(std::ceil(kLeastRun / df));
  std::vector<Map> maps;
  for (std::size_t r = 0; r < data.members(); ++r) {
    maps.emplace_back(data, r, piece);
  }
  std::vector<BestLines> best(scopes.size(), BestLines(bins));
  std::vector<std::vector<float>> of(maps.size(), std::vector<float>(bins));
  std::vector<float> together(bins);
  const long widest = static_cast<long>(bins) - static_cast<long>(first) - 1;
  const auto look_along = [&](long run) {
    const auto begin =
        static_cast<std::size_t>(std::max<long>(static_cast<long>(first), static_cast<long>(first) - run));
    const auto end = static_cast<std::size_t>(std::min<long>(static_cast<long>(bins), static_cast<long>(bins) - run));
    for (std::size_t r = 0; r < maps.size(); ++r) {
      std::fill(of[r].begin(), of[r].end(), 0.0F);
      maps[r].add_lines(run, begin, end, of[r]);
    }
    for (std::size_t s = 0; s < scopes.size(); ++s) {
      std::fill(together.begin(), together.end(), 0.0F);
      for (const std::size_t r : scopes[s]) {
        for (std::size_t a = begin; a < end; ++a) {
          together[a] += of[r][a];
        }
      }
      best[s].take(together, begin, end, run);
    }
  };
  for (long run = least; run <= widest && !data.stopped(); ++run) {
    look_along(run);
    look_along(-run);
  }
  std::vector<std::vector<Line>> lines;
  for (std::size_t s = 0; s < scopes.size(); ++s) {
    lines.push_back(best[s].most(counts[s]));
  }
  return lines;
}

}  // namespace

double longest_s(const FullRate& data, const std::vector<std::size_t>& scope) {
  double longest = 0.0;
  for (const std::size_t r : scope) {
    longest = std::max(longest, static_cast<double>(data.innovation[r].size()) * data.dt_s);
  }
  return longest;
}

Followed follow_chirp(const FullRate& data, const std::vector<std::size_t>& scope, const Sweep& near, double reach_hz) {
  std::vector<BandPower> power;
  power.reserve(scope.size());
  std::vector<const BandPower*> of_scope;
  for (const std::size_t r : scope) {
    of_scope.push_back(&power.emplace_back(data, r));
  }
  Follower follower(data, scope, of_scope, near, reach_hz);
  follower.look_around();
  follower.look_closer();
  return follower.followed();
}

std::vector<std::optional<Followed>> chirps_of(const FullRate& data,
                                               const std::vector<std::vector<std::size_t>>& scopes) {
  std::vector<std::optional<Followed>> found(scopes.size());
  const std::size_t piece = piece_of(data);
  double samples = 0.0;
  for (const Series& e : data.innovation) {
    if (e.size() < kFewest * piece) {
      return found;
    }
    samples += static_cast<double>(e.size());
  }
  std::vector<std::size_t> counts;
  for (const auto& scope : scopes) {
    const double share = scope.size() == data.members() ? 1.0 : 1.0 / static_cast<double>(data.members());
    const double most = std::min(static_cast<double>(kCandidates), kMostFollowed / samples);
    counts.push_back(static_cast<std::size_t>(std::ceil(share * most)));
  }
  const auto lines = lines_of(data, scopes, counts, piece);
  std::vector<BandPower> power;  // of very long recordings it is taken where a line is followed to the whole
  for (std::size_t r = 0; r < data.members() && samples < kMostWeighed; ++r) {
    power.emplace_back(data, r);
  }
  const double piece_s = static_cast<double>(piece) * data.dt_s;
  const double reach = 2.0 / piece_s;  // a line of the map may be two ordinates off at its ends, in opposite directions
  const double band = 0.5 / data.dt_s * 8.0 * piece_s;  // frequencies that differ over the last stretches
  for (std::size_t s = 0; s < scopes.size() && !data.stopped(); ++s) {
    std::vector<const BandPower*> of_scope;
    for (const std::size_t r : scopes[s]) {
      of_scope.push_back(power.empty() ? nullptr : &power[r]);
    }
    std::optional<Follower> best;
    for (const Line& line : lines[s]) {
      Follower follower(data, scopes[s], of_scope, sweep_of(line, piece_s, longest_s(data, scopes[s])), reach);
      follower.look_around();
      if (!best || follower.x() > best->x()) {
        best = std::move(follower);
      }
    }
    if (best && surprise(0.5 * best->x() / best->stretches(), best->stretches()) > std::log(band * band)) {
      found[s] = follow_chirp(data, scopes[s], best->followed().sweep, 0.5 / piece_s);
    }
  }
  return found;
}

}  // namespace driftlab::investigate
