#include "core/investigate/consistency/reference_clock.hpp"

#include "core/investigate/study/lattice.hpp"
#include "core/signal/turns.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr double kBlock = 0.2;  ///< [s]
constexpr std::size_t kOrder = 8;
constexpr Eigen::Index kCommon = 9;  ///< columns that stand beside every break

/// Means of one channel over blocks: the error, the columns beside the break, w' and t w'.
struct BlockMeans {
  std::size_t channel = 0;
  double block_s = 0.0;
  Eigen::VectorXd time;  ///< middle of each block, from the first sample of the file [s]
  Eigen::VectorXd error;
  Eigen::MatrixXd common;  ///< 1, t, w, |w|, w|w|, w^3, w', t w', t^2
  Eigen::VectorXd slope, slope_time;
  Eigen::VectorXd used;  ///< 1 or 0
};

/// The reference about the channel's axis varies; nothing else moves a clock into sight.
bool moves(const StudyRecording& recording, const Channel& channel) {
  if (channel.role.quantity != Quantity::AngularRate || channel.reference.empty() || channel.error.empty()) {
    return false;
  }
  const ConditionKind kind = recording.condition.kind;
  return kind == ConditionKind::Profile || kind == ConditionKind::Drive;
}

BlockMeans blocks_of(const StudyRecording& recording, std::size_t c) {
  const Channel& channel = recording.channels[c];
  const auto length = static_cast<std::size_t>(std::max(1.0, std::round(kBlock / recording.dt_s)));
  const std::size_t count = recording.count() / length;
  const std::vector<double> slopes = slope(channel.reference.values(), recording.dt_s);
  const double limit = clipped_at(channel) * std::fabs(channel.unit.factor);
  BlockMeans blocks;
  blocks.channel = c;
  blocks.block_s = static_cast<double>(length) * recording.dt_s;
  const auto n = static_cast<Eigen::Index>(count);
  blocks.time = blocks.error = blocks.slope = blocks.slope_time = blocks.used = Eigen::VectorXd::Zero(n);
  blocks.common = Eigen::MatrixXd::Zero(n, kCommon);
  const double span = std::max(recording.dt_s, recording.time_s(recording.length));
  double largest = 1e-300;
  for (const double w : channel.reference) {
    largest = std::max(largest, std::fabs(w));
  }
  for (std::size_t b = 0; b < count; ++b) {
    const auto row = static_cast<Eigen::Index>(b);
    double samples = 0.0;
    bool clipped = false;
    for (std::size_t i = recording.begin + b * length; i < recording.begin + (b + 1) * length; ++i) {
      const double t = recording.time_s(i) / span;
      const double w = channel.reference[i] / largest;
      clipped = clipped || (limit > 0.0 && std::fabs(channel.measured[i]) > 0.98 * limit);
      blocks.time(row) += recording.time_s(i) / static_cast<double>(length);
      if (channel.valid[i] == 0) {
        continue;
      }
      samples += 1.0;
      blocks.error(row) += channel.error[i];
      blocks.slope(row) += slopes[i];
      blocks.slope_time(row) += slopes[i] * recording.time_s(i);
      const std::array<double, kCommon> values{
          1.0, t, w, std::fabs(w), w * std::fabs(w), w * w * w, slopes[i], t * slopes[i], t * t};
      for (Eigen::Index k = 0; k < kCommon; ++k) {
        blocks.common(row, k) += values.at(static_cast<std::size_t>(k));
      }
    }
    if (clipped || samples < 0.5 * static_cast<double>(length)) {
      blocks.error(row) = blocks.slope(row) = blocks.slope_time(row) = 0.0;
      blocks.common.row(row).setZero();
      continue;
    }
    blocks.used(row) = 1.0;
    blocks.error(row) /= samples;
    blocks.slope(row) /= samples;
    blocks.slope_time(row) /= samples;
    blocks.common.row(row) /= samples;
  }
  return blocks;
}

/// The column of a break at t0.
Eigen::VectorXd broken(const BlockMeans& blocks, ClockBreak kind, double t0_s) {
  Eigen::VectorXd column = Eigen::VectorXd::Zero(blocks.time.size());
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    if (blocks.time(i) >= t0_s) {
      column(i) = kind == ClockBreak::Jump ? blocks.slope(i) : blocks.slope_time(i) - t0_s * blocks.slope(i);
    }
  }
  return column;
}

/// Coefficients of an autoregression by Yule and Walker.
Eigen::VectorXd autoregression(const Eigen::VectorXd& x) {
  const auto order = static_cast<Eigen::Index>(kOrder);
  Eigen::MatrixXd covariance(order, order);
  Eigen::VectorXd right(order);
  std::vector<double> lagged(kOrder + 1, 0.0);
  for (Eigen::Index lag = 0; lag <= order; ++lag) {
    lagged[static_cast<std::size_t>(lag)] = x.head(x.size() - lag).dot(x.tail(x.size() - lag));
  }
  for (Eigen::Index i = 0; i < order; ++i) {
    right(i) = lagged[static_cast<std::size_t>(i + 1)];
    for (Eigen::Index j = 0; j < order; ++j) {
      covariance(i, j) = lagged[static_cast<std::size_t>(std::abs(i - j))];
    }
    covariance(i, i) *= 1.0 + 1e-9;
  }
  return lagged[0] > 0.0 ? Eigen::VectorXd(covariance.ldlt().solve(right)) : Eigen::VectorXd::Zero(order);
}

/// The prediction errors of a column; 0 wherever they lean on a block that is left out.
Eigen::VectorXd whitened(const Eigen::VectorXd& column, const Eigen::VectorXd& ar, const Eigen::VectorXd& used) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(column.size());
  for (Eigen::Index i = ar.size(); i < column.size(); ++i) {
    double value = column(i);
    double all = used(i);
    for (Eigen::Index k = 0; k < ar.size(); ++k) {
      value -= ar(k) * column(i - 1 - k);
      all *= used(i - 1 - k);
    }
    out(i) = all > 0.0 ? value : 0.0;
  }
  return out;
}

BlockMeans whitened(const BlockMeans& blocks, const Eigen::VectorXd& ar) {
  BlockMeans white = blocks;
  white.error = whitened(blocks.error, ar, blocks.used);
  white.slope = whitened(blocks.slope, ar, blocks.used);
  white.slope_time = whitened(blocks.slope_time, ar, blocks.used);
  for (Eigen::Index k = 0; k < kCommon; ++k) {
    white.common.col(k) = whitened(blocks.common.col(k), ar, blocks.used);
  }
  return white;
}

/// What a break at each t0 of `times` takes off the sum of squares, by sums from t0 to the end.
struct Scan {
  double rows = 0.0;
  double rss = 0.0;  ///< without a break
  std::vector<double> taken, size, information;
};

Scan scan(const BlockMeans& blocks, ClockBreak kind, const std::vector<double>& times) {
  Scan result;
  const Eigen::MatrixXd& x = blocks.common;
  const Eigen::MatrixXd inverse =
      (x.transpose() * x + 1e-12 * (x.transpose() * x).trace() * Eigen::MatrixXd::Identity(kCommon, kCommon)).inverse();
  const Eigen::VectorXd left = blocks.error - x * (inverse * (x.transpose() * blocks.error));
  result.rss = left.squaredNorm();
  result.rows = (blocks.error.array() != 0.0).cast<double>().sum();
  const Eigen::Index n = blocks.time.size();
  // Sums over the blocks from the present one to the end.
  Eigen::VectorXd sx = Eigen::VectorXd::Zero(kCommon);
  Eigen::VectorXd stx = Eigen::VectorXd::Zero(kCommon);
  double se = 0.0, ste = 0.0, ss = 0.0, sst = 0.0, stt = 0.0;
  Eigen::Index i = n;
  result.taken.assign(times.size(), 0.0);
  result.size.assign(times.size(), 0.0);
  result.information.assign(times.size(), 0.0);
  for (std::size_t k = times.size(); k-- > 0;) {
    const double t0 = times[k];
    while (i > 0 && blocks.time(i - 1) >= t0) {
      --i;
      const double s = blocks.slope(i);
      const double st = blocks.slope_time(i);
      sx += s * x.row(i).transpose();
      stx += st * x.row(i).transpose();
      se += s * left(i);
      ste += st * left(i);
      ss += s * s;
      sst += s * st;
      stt += st * st;
    }
    const bool jump = kind == ClockBreak::Jump;
    const Eigen::VectorXd cx = jump ? sx : Eigen::VectorXd(stx - t0 * sx);
    const double ce = jump ? se : ste - t0 * se;
    const double cc = jump ? ss : stt - 2.0 * t0 * sst + t0 * t0 * ss;
    const double own = cc - cx.dot(inverse * cx);
    if (own > 1e-6 * cc && own > 0.0) {
      result.taken[k] = ce * ce / own;
      result.size[k] = ce / own;
      result.information[k] = own;
    }
  }
  return result;
}

constexpr Eigen::Index kOffset = 6;  ///< columns of an offset and of a drift of the whole clock
constexpr Eigen::Index kDrift = 7;

/// Sum of squares that least squares on the columns of x leaves.
double sum_left(const Eigen::MatrixXd& x, const Eigen::VectorXd& error) {
  return (error - x * x.completeOrthogonalDecomposition().solve(error)).squaredNorm();
}

/// Twice the log likelihood that an offset and a drift of the whole clock gain beside a break.
double gain_of_whole_clock(const std::vector<BlockMeans>& all, ClockBreak kind, double t0_s) {
  double gain = 0.0;
  for (const BlockMeans& blocks : all) {
    Eigen::MatrixXd x(blocks.time.size(), kCommon + 1);
    x << blocks.common, broken(blocks, kind, t0_s);
    const double with = sum_left(x, blocks.error);
    x.col(kOffset).setZero();
    x.col(kDrift).setZero();
    gain += blocks.used.sum() * std::log(sum_left(x, blocks.error) / std::max(1e-300, with));
  }
  return gain;
}

void without_whole_clock(std::vector<BlockMeans>& all) {
  for (BlockMeans& blocks : all) {
    blocks.common.col(kOffset).setZero();
    blocks.common.col(kDrift).setZero();
  }
}

/// n ln(RSS/RSS'), of the common columns of one and of the other, without a break.
double log_ratio(const std::vector<BlockMeans>& one, const std::vector<BlockMeans>& other) {
  double sum = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const double left = sum_left(other[i].common, other[i].error);
    sum += one[i].used.sum() * std::log(sum_left(one[i].common, one[i].error) / std::max(1e-300, left));
  }
  return sum;
}

struct Best {
  double statistic = -1.0;
  std::size_t at = 0;
  std::vector<double> statistics;
  double size = 0.0;  ///< coefficient of the column
  double deviation = 0.0;
};

Best best_of(const std::vector<BlockMeans>& all, ClockBreak kind, const std::vector<double>& times) {
  Best best;
  best.statistics.assign(times.size(), 0.0);
  std::vector<Scan> scans;
  for (const BlockMeans& blocks : all) {
    scans.push_back(scan(blocks, kind, times));
    const Scan& s = scans.back();
    for (std::size_t k = 0; k < times.size(); ++k) {
      best.statistics[k] += s.rows * std::log(s.rss / std::max(1e-12 * s.rss, s.rss - s.taken[k]));
    }
  }
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (best.statistics[k] > best.statistic) {
      best.statistic = best.statistics[k];
      best.at = k;
    }
  }
  double weight = 0.0;
  for (const Scan& s : scans) {
    const double variance = (s.rss - s.taken[best.at]) / std::max(1.0, s.rows);
    const double w = variance > 0.0 ? s.information[best.at] / variance : 0.0;
    best.size += w * s.size[best.at];
    weight += w;
  }
  best.size /= std::max(1e-300, weight);
  best.deviation = 1.0 / std::sqrt(std::max(1e-300, weight));
  return best;
}

/// Where to look: every second, away from the ends, where a break is an offset or nothing.
std::vector<double> grid_of(const StudyRecording& recording, double step_s, double from_s, double to_s) {
  const double begin = std::max(from_s, recording.time_s(recording.begin) + 5.0);
  const double end = std::min(to_s, recording.time_s(recording.end) - 5.0);
  std::vector<double> times;
  for (double t = begin; t < end; t += step_s) {
    times.push_back(t);
  }
  return times;
}

/// Widens an interval by the times whose statistic is within 3.84 of the top.
void widen(Interval& interval, const Best& best, double top, const std::vector<double>& times, double step_s) {
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (best.statistics[k] > top - 3.84) {
      interval.low = std::min(interval.low, times[k] - step_s);
      interval.high = std::max(interval.high, times[k] + step_s);
    }
  }
}

}  // namespace

std::optional<ClockFault> find_clock_fault(const Study& study, std::size_t index, double least) {
  const StudyRecording& recording = study.recordings[index];
  std::vector<BlockMeans> raw;
  for (std::size_t c = 0; c < recording.channels.size(); ++c) {
    if (!recording.channels[c].input_only && moves(recording, recording.channels[c])) {
      BlockMeans blocks = blocks_of(recording, c);
      if (blocks.used.sum() > 200.0 && blocks.slope.squaredNorm() > 0.0) {
        raw.push_back(std::move(blocks));
      }
    }
  }
  const std::vector<double> times = grid_of(recording, 1.0, 0.0, 1e300);
  if (raw.empty() || times.size() < 20) {
    return std::nullopt;
  }
  constexpr std::array kKinds{ClockBreak::Jump, ClockBreak::RateChange};
  // What the better break leaves is the noise; by its autoregression everything is whitened.
  std::array<Best, 2> plain{best_of(raw, kKinds[0], times), best_of(raw, kKinds[1], times)};
  const std::size_t first = plain[0].statistic > plain[1].statistic ? 0 : 1;
  std::vector<BlockMeans> white;
  std::vector<Eigen::VectorXd> filters;
  for (const BlockMeans& blocks : raw) {
    Eigen::MatrixXd x(blocks.time.size(), kCommon + 1);
    x << blocks.common, broken(blocks, kKinds.at(first), times[plain.at(first).at]);
    const Eigen::VectorXd left = blocks.error - x * x.colPivHouseholderQr().solve(blocks.error);
    filters.push_back(autoregression(left));
    white.push_back(whitened(blocks, filters.back()));
  }
  const auto kind_of = [](const std::array<Best, 2>& best) -> std::size_t {
    return best[0].statistic > best[1].statistic ? 0 : 1;
  };
  std::array<Best, 2> best{best_of(white, kKinds[0], times), best_of(white, kKinds[1], times)};
  std::size_t k = kind_of(best);
  const double beside = best.at(k).statistic;
  if (beside < least) {
    std::vector<BlockMeans> alone = white;
    without_whole_clock(alone);
    best = {best_of(alone, kKinds[0], times), best_of(alone, kKinds[1], times)};
    k = kind_of(best);
    const double instead = best.at(k).statistic;
    if (instead < kClockBreaks || instead - log_ratio(alone, white) < kBreakSurpasses) {
      return std::nullopt;
    }
  }
  const double step = white.front().block_s;
  const double near = times[best.at(k).at];
  const std::vector<double> fine = grid_of(recording, step, near - 20.0, near + 20.0);
  // An offset and a drift that are not there would only blur the size of the break.
  constexpr double kThere = 12.0;
  const bool whole = gain_of_whole_clock(white, kKinds.at(k), near) > kThere;
  if (!whole) {
    without_whole_clock(white);
  }
  const Best found = best_of(white, kKinds.at(k), fine);
  const Best anywhere = best_of(white, kKinds.at(k), times);  // a small break may as well be far from there
  const double top = std::max(found.statistic, anywhere.statistic);
  ClockFault fault;
  fault.kind = kKinds.at(k);
  fault.recording = index;
  fault.statistic = beside;
  const double t0 = fine[found.at];
  const double sign = fault.kind == ClockBreak::Jump ? -1.0 : 1.0;
  const double half = 1.96 * found.deviation;
  double size = sign * found.size;
  for (int round = 0; round < 2; ++round) {  // beyond the first order
    StudyRecording moved = recording;
    move_reference(moved, reading_times(moved, fault.kind, size, t0));
    std::vector<BlockMeans> left;
    for (std::size_t b = 0; b < raw.size(); ++b) {
      left.push_back(whitened(blocks_of(moved, raw[b].channel), filters[b]));
    }
    if (!whole) {
      without_whole_clock(left);
    }
    size += sign * best_of(left, fault.kind, {t0}).size;
  }
  fault.t0_s = {t0, {t0 - step, t0 + step}};
  widen(fault.t0_s.ci95, found, top, fine, step);
  widen(fault.t0_s.ci95, anywhere, top, times, 1.0);
  fault.size = {size, {size - half, size + half}};
  for (const double end : {fault.t0_s.ci95.low, fault.t0_s.ci95.high}) {  // its size depends on when it was
    const double at_end = size + sign * (best_of(white, fault.kind, {end}).size - found.size);
    fault.size.ci95.low = std::min(fault.size.ci95.low, at_end);
    fault.size.ci95.high = std::max(fault.size.ci95.high, at_end);
  }
  for (const BlockMeans& blocks : raw) {
    fault.channels.push_back(blocks.channel);
  }
  return fault;
}

std::vector<double> reading_times(const StudyRecording& recording, ClockBreak kind, double size, double t0_s) {
  std::vector<double> times(recording.length);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = recording.time_s(i);
    times[i] = t < t0_s ? t : kind == ClockBreak::Jump ? t - size : t0_s + (t - t0_s) * (1.0 + size);
  }
  return times;
}

std::vector<double> read_at(const std::vector<double>& series, double dt_s, const std::vector<double>& times_s) {
  std::vector<double> out(times_s.size());
  const auto last = static_cast<double>(series.size() - 1);
  const auto at = [&](double place) { return series[static_cast<std::size_t>(std::clamp(place, 0.0, last))]; };
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double place = std::clamp(times_s[i] / dt_s, 0.0, last);
    const double whole = std::floor(place);
    const double u = place - whole;
    const double a = at(whole - 1.0);
    const double b = at(whole);
    const double c = at(whole + 1.0);
    const double d = at(whole + 2.0);
    out[i] = b + 0.5 * u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * (3.0 * (b - c) + d - a)));
  }
  return out;
}

void move_reference(StudyRecording& recording, const std::vector<double>& times_s) {
  std::size_t main = 0;
  double most = -1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (recording.rate[k].empty()) {
      continue;
    }
    std::vector<double> rate = read_at(recording.rate[k].values(), recording.dt_s, times_s);
    recording.acceleration[k] = slope(rate, recording.dt_s);
    double sum = 0.0;
    for (const double w : rate) {
      sum += std::fabs(w);
    }
    recording.rate[k] = std::move(rate);
    main = sum > most ? k : main;
    most = std::max(most, sum);
  }
  if (!recording.angle.empty()) {  // from where it began
    std::vector<double> angle(recording.angle.size(), recording.angle[0]);
    for (std::size_t i = 1; i < angle.size(); ++i) {
      angle[i] = angle[i - 1] + 0.5 * recording.dt_s * (recording.rate[main][i - 1] + recording.rate[main][i]);
    }
    recording.angle = std::move(angle);
  }
  for (Channel& channel : recording.channels) {
    const auto axis = axis_index(channel.role.axis);
    if (channel.role.quantity != Quantity::AngularRate || channel.reference.empty() || !axis) {
      continue;
    }
    channel.reference = recording.rate[*axis];
    channel.error = channel.error.empty() ? Series() : channel.against_reference();
  }
}

}  // namespace driftlab::investigate
