#include "core/investigate/fullrate/gaps.hpp"

#include "core/process/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace driftlab::investigate {
namespace {

// Chosen, not measured: a line in the place of fewer changes no level by more than its standard error.
constexpr double kMostOnLines = 0.005;
/// Places that are tried before a gap that is too long for this recording gets its line. Chosen, not measured.
constexpr int kTries = 20;

struct Gap {
  std::size_t begin = 0;
  std::size_t end = 0;
  [[nodiscard]] std::size_t length() const { return end - begin; }
};

std::vector<Gap> gaps_of(const std::vector<unsigned char>& used) {
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] != 0) {
      continue;
    }
    const std::size_t begin = i;
    while (i < used.size() && used[i] == 0) {
      ++i;
    }
    gaps.push_back({begin, i});
  }
  return gaps;
}

void put_on_line(std::vector<double>& values, const Gap& gap) {
  const double right = gap.end < values.size() ? values[gap.end] : gap.begin > 0 ? values[gap.begin - 1] : 0.0;
  const double left = gap.begin > 0 ? values[gap.begin - 1] : right;
  const auto steps = static_cast<double>(gap.length() + 1);
  for (std::size_t k = gap.begin; k < gap.end; ++k) {
    values[k] = left + (right - left) * static_cast<double>(k - gap.begin + 1) / steps;
  }
}

/// Sums over the samples that are there, from the first on.
class Present {
 public:
  Present(const std::vector<double>& values, const std::vector<unsigned char>& used, std::size_t beside)
      : beside_(beside), sum_(values.size() + 1, 0.0), count_(values.size() + 1, 0) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      sum_[i + 1] = sum_[i] + (used[i] != 0 ? values[i] : 0.0);
      count_[i + 1] = count_[i] + (used[i] != 0 ? 1U : 0U);
    }
  }
  /// Mean of the samples at most `beside` before `begin` and behind `end`; nothing where there is none.
  [[nodiscard]] std::optional<double> mean_beside(const Gap& gap) const {
    const std::size_t from = gap.begin - std::min(gap.begin, beside_);
    const std::size_t to = std::min(gap.end + beside_, sum_.size() - 1);
    const double sum = sum_[gap.begin] - sum_[from] + sum_[to] - sum_[gap.end];
    const std::uint32_t count = count_[gap.begin] - count_[from] + count_[to] - count_[gap.end];
    return count > 0 ? std::optional(sum / count) : std::nullopt;
  }
  [[nodiscard]] bool whole(const Gap& piece) const { return count_[piece.end] - count_[piece.begin] == piece.length(); }

 private:
  std::size_t beside_;
  std::vector<double> sum_;
  std::vector<std::uint32_t> count_;
};

/// A whole piece as long as the gap, and the mean beside it.
struct Piece {
  Gap place;
  double level = 0.0;
};

std::optional<Piece> piece_for(const Gap& gap, std::size_t samples, const Present& present, Random& random) {
  if (samples < 2 * gap.length()) {
    return std::nullopt;
  }
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const std::size_t begin = random.below(samples - gap.length());
    const Gap place{begin, begin + gap.length()};
    if (present.whole(place)) {
      const std::optional<double> level = present.mean_beside(place);
      return level ? std::optional(Piece{place, *level}) : std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace

FilledGaps fill_gaps(const Series& values, const std::vector<unsigned char>& used, std::size_t beside) {
  const std::vector<Gap> gaps = gaps_of(used);
  if (gaps.empty()) {
    return {values, 0.0};
  }
  double missing = 0.0;
  for (const Gap& gap : gaps) {
    missing += static_cast<double>(gap.length());
  }
  std::vector<double> filled = values.values();
  const auto samples = static_cast<double>(filled.size());
  if (missing <= kMostOnLines * samples) {
    for (const Gap& gap : gaps) {
      put_on_line(filled, gap);
    }
    return {std::move(filled), missing / samples};
  }
  const Present present(filled, used, beside);
  Random random(filled.size(), gaps.size());
  // Of white noise, the mean beside the gap and that beside the piece each add this share of the variance.
  const double of_mean = 0.5 / static_cast<double>(beside);
  const double scale = std::sqrt((1.0 - of_mean) / (1.0 + of_mean));
  double broken = 0.0;
  for (const Gap& gap : gaps) {
    const std::optional<double> here = present.mean_beside(gap);
    const std::optional<Piece> piece = here ? piece_for(gap, filled.size(), present, random) : std::nullopt;
    if (!piece) {
      put_on_line(filled, gap);
      broken += static_cast<double>(gap.length());
      continue;
    }
    for (std::size_t k = 0; k < gap.length(); ++k) {
      filled[gap.begin + k] = *here + scale * (values[piece->place.begin + k] - piece->level);
    }
    broken += 2.0;
  }
  return {std::move(filled), broken / samples};
}

}  // namespace driftlab::investigate
