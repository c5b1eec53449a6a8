#include "core/variance/square_projections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace driftlab {
namespace {

constexpr std::size_t kBatches = 1024;
/// Blocks in a half filter of the largest scale that a level holds.
constexpr std::size_t kBlocks = 8;
constexpr std::size_t kPiece = 2048;

/// Windows of `level` (sums of equally long stretches) that start in batch `k` of `batches`.
std::size_t batch_start(std::size_t k, std::size_t batches, std::size_t windows) {
  return static_cast<std::size_t>(static_cast<double>(k) / static_cast<double>(batches) * static_cast<double>(windows));
}

/// Sums of squared differences of neighbouring stretches of blocks, with room for one piece of a level.
class Squares {
 public:
  /// Over the windows that start in [first, last), for stretches of 1, 2, 4 and 8 blocks; only for 8 unless `all`.
  std::array<double, 4> between(std::span<const double> level, double pivot, std::size_t first, std::size_t last,
                                bool all) {
    std::array<double, 4> total{};
    for (std::size_t start = first; start < last; start += kPiece) {
      const std::size_t length = std::min(kPiece, last - start);
      std::size_t held = length + 2 * kBlocks - 1;
      for (std::size_t t = 0; t < held; ++t) {
        a_[t] = level[start + t] - pivot;
      }
      for (std::size_t c = 0, m = 1; c < total.size(); ++c, m *= 2) {
        if (all || m == kBlocks) {
          total[c] += squares(m, length);
        }
        held -= m;
        for (std::size_t t = 0; t < held; ++t) {
          b_[t] = a_[t] + a_[t + m];
        }
        std::swap(a_, b_);
      }
    }
    return total;
  }

 private:
  [[nodiscard]] double squares(std::size_t m, std::size_t length) const {
    std::array<double, 8> lanes{};  // of independent sums, which is what a vector register wants
    std::size_t t = 0;
    for (; t + lanes.size() <= length; t += lanes.size()) {
      for (std::size_t k = 0; k < lanes.size(); ++k) {
        const double difference = a_[t + m + k] - a_[t + k];
        lanes[k] += difference * difference;
      }
    }
    for (; t < length; ++t) {
      lanes[0] += (a_[t + m] - a_[t]) * (a_[t + m] - a_[t]);
    }
    return std::accumulate(lanes.begin(), lanes.end(), 0.0);
  }

  std::vector<double> a_ = std::vector<double>(kPiece + 2 * kBlocks);
  std::vector<double> b_ = std::vector<double>(kPiece + 2 * kBlocks);
};

/// Mean and projections of one scale from the sums of Y in batches.
void project(std::span<const double> sums, std::span<const std::size_t> edges, std::size_t half,
             const Eigen::MatrixXd& cosines, SquareProjections& result) {
  const auto count = static_cast<double>(edges.back());
  double total = 0.0;
  for (const double sum : sums) {
    total += sum;
  }
  const double mean = total / count;
  Eigen::VectorXd centred(static_cast<Eigen::Index>(sums.size()));
  for (std::size_t k = 0; k < sums.size(); ++k) {
    centred(static_cast<Eigen::Index>(k)) = sums[k] - mean * static_cast<double>(edges[k + 1] - edges[k]);
  }
  const auto column = static_cast<Eigen::Index>(result.half.size());
  result.half.push_back(half);
  result.mean.push_back(mean / (4.0 * static_cast<double>(half) * static_cast<double>(half)));
  result.relative.conservativeResize(Eigen::NoChange, column + 1);
  if (mean > 0.0) {
    result.relative.col(column).noalias() = (std::numbers::sqrt2 / (count * mean)) * (cosines.transpose() * centred);
  } else {
    result.relative.col(column).setZero();
  }
}

/// cos(pi k (i + 1/2)/batches), batches x kMostProjections.
Eigen::MatrixXd cosine_table(std::size_t batches) {
  std::vector<double> quarter(4 * batches);
  for (std::size_t i = 0; i < quarter.size(); ++i) {
    quarter[i] = std::cos(std::numbers::pi * static_cast<double>(i) / static_cast<double>(2 * batches));
  }
  Eigen::MatrixXd table(static_cast<Eigen::Index>(batches), static_cast<Eigen::Index>(kMostProjections));
  for (std::size_t k = 1; k <= kMostProjections; ++k) {
    for (std::size_t i = 0; i < batches; ++i) {
      table(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k - 1)) = quarter[k * (2 * i + 1) % quarter.size()];
    }
  }
  return table;
}

}  // namespace

SquareProjections square_projections(std::span<const double> samples, double pivot, std::size_t largest_half,
                                     const RunControl& control) {
  SquareProjections result;
  result.relative.resize(static_cast<Eigen::Index>(kMostProjections), 0);
  std::vector<double> halved;
  std::span<const double> level = samples;
  Eigen::MatrixXd cosines;
  Squares squares;
  for (std::size_t stretch = 1; stretch == 1 || stretch * kBlocks <= largest_half; stretch *= 2) {
    if (control.stop.stop_requested()) {
      return {};
    }
    if (stretch > 1) {  // in place once the first halving has left the samples alone
      const std::size_t pairs = level.size() / 2;
      if (halved.empty()) {
        halved.resize(pairs);
      }
      const double shift = stretch == 2 ? 2.0 * pivot : 0.0;
      for (std::size_t i = 0; i < pairs; ++i) {
        halved[i] = level[2 * i] + level[2 * i + 1] - shift;
      }
      level = std::span<const double>(halved).first(pairs);
    }
    const std::size_t windows = level.size() - (2 * kBlocks - 1);
    const std::size_t batches = std::min(kBatches, windows);
    if (static_cast<std::size_t>(cosines.rows()) != batches) {
      cosines = cosine_table(batches);
    }
    std::array<std::vector<double>, 4> sums;
    std::vector<std::size_t> edges{0};
    for (std::size_t k = 0; k < batches; ++k) {
      edges.push_back(batch_start(k + 1, batches, windows));
      const auto total = squares.between(level, stretch == 1 ? pivot : 0.0, edges[k], edges[k + 1], stretch == 1);
      for (std::size_t c = 0; c < sums.size(); ++c) {
        sums[c].push_back(total[c]);
      }
    }
    for (std::size_t c = stretch == 1 ? 0 : 3; c < sums.size(); ++c) {
      if (const std::size_t half = stretch << c; half <= largest_half) {
        project(sums[c], edges, half, cosines, result);
      }
    }
  }
  return result;
}

}  // namespace driftlab
