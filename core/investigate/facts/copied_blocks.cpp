#include "core/investigate/facts/copied_blocks.hpp"

#include "core/signal/progress.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace driftlab::investigate {
namespace {

using Columns = std::vector<std::span<const double>>;
using Keyed = std::pair<std::uint64_t, std::size_t>;  ///< a hash, and the row at which it begins

/// Chosen, not measured: room for two blocks of the shortest length and for what is not copied.
constexpr std::size_t kFewestRows = 64;
/// Rows of a block. Chosen, not measured; whether a repeat is chance is judged by kByChance.
constexpr std::size_t kShortest = 8;
/// Pairs expected by chance in a file without a copy, at most. Chosen small, for a copied block is told as a fact.
constexpr double kByChance = 1e-4;

std::uint64_t mixed(std::uint64_t h) {
  h ^= h >> 30U;
  h *= 0xbf58476d1ce4e5b9ULL;
  h ^= h >> 27U;
  h *= 0x94d049bb133111ebULL;
  return h ^ (h >> 31U);
}

class Rows {
 public:
  explicit Rows(const Columns& columns) : columns_(columns) {}

  [[nodiscard]] std::size_t count() const { return columns_.empty() ? 0 : columns_.front().size(); }
  [[nodiscard]] bool equal(std::size_t i, std::size_t j) const {
    return std::all_of(columns_.begin(), columns_.end(), [&](const auto& column) { return column[i] == column[j]; });
  }
  [[nodiscard]] std::uint64_t hash(std::size_t i) const {
    std::uint64_t h = 0;
    for (const auto& column : columns_) {
      h = mixed(h + std::bit_cast<std::uint64_t>(column[i] + 0.0));  // -0 is 0
    }
    return h;
  }
  /// Rows that stay equal from i and j on, `most` at most.
  [[nodiscard]] std::size_t equal_from(std::size_t i, std::size_t j, std::size_t most) const {
    std::size_t run = 0;
    while (run < most && j + run < count() && equal(i + run, j + run)) {
      ++run;
    }
    return run;
  }
  [[nodiscard]] std::size_t changes(std::size_t from, std::size_t length) const {
    std::size_t changed = 0;
    for (std::size_t i = from + 1; i < from + length; ++i) {
      changed += equal(i, i - 1) ? 0 : 1;
    }
    return changed;
  }

 private:
  const Columns& columns_;
};

/// In order of hash and row, of what stands in order of row. Hashes spread evenly: each is put among those that begin
/// with the same bits, about eight, which are then sorted. Not in order where it was stopped.
std::vector<Keyed> sorted_by_hash(const std::vector<Keyed>& by_row, const std::stop_token& stop) {
  const int bits = std::clamp(static_cast<int>(std::bit_width(by_row.size())) - 3, 1, 24);
  const auto bucket_of = [&](std::uint64_t hash) { return static_cast<std::size_t>(hash >> (64 - bits)); };
  std::vector<std::size_t> begin((std::size_t{1} << bits) + 1, 0);
  for (const Keyed& keyed : by_row) {
    ++begin[bucket_of(keyed.first) + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Keyed> sorted(by_row.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < by_row.size() && !polled(stop, i); ++i) {
    const Keyed& keyed = by_row[i];
    sorted[next[bucket_of(keyed.first)]++] = keyed;
  }
  for (std::size_t b = 0; b + 1 < begin.size() && !polled(stop, b); ++b) {
    const auto at = [&](std::size_t i) { return sorted.begin() + static_cast<std::ptrdiff_t>(i); };
    std::sort(at(begin[b]), at(begin[b + 1]));
  }
  return sorted;
}

/// Chance that equality goes on for one more row, a little above what was counted. `keyed`: in order of hash and row.
double chance_of_going_on(const Rows& rows, const std::vector<Keyed>& keyed, const std::stop_token& stop) {
  // Runs of equal rows that end before this count for chance, from which its rate is estimated. Chosen, not measured.
  constexpr std::size_t kNoChance = 6;
  double pairs = 0.0;
  double go_on = 0.0;
  for (std::size_t k = 1; k < keyed.size() && !polled(stop, k); ++k) {
    const auto [h, j] = keyed[k];
    const std::size_t i = keyed[k - 1].second;
    if (keyed[k - 1].first != h || j - i < 2) {
      continue;
    }
    const std::size_t run = rows.equal_from(i, j, kNoChance);
    if (run > 0 && run < kNoChance) {
      pairs += 1.0;
      go_on += run > 1 ? 1.0 : 0.0;
    }
  }
  return (go_on + 1.0) / (pairs + 10.0);
}

std::vector<Keyed> windows_of(const std::vector<Keyed>& row_hashes, std::size_t length) {
  // 2^64 over the golden ratio, odd: the usual multiplier of a rolling hash.
  constexpr std::uint64_t kBase = 0x9e3779b97f4a7c15ULL;
  std::uint64_t leaving = 1;
  for (std::size_t k = 0; k < length; ++k) {
    leaving *= kBase;
  }
  std::vector<Keyed> windows;
  windows.reserve(row_hashes.size() - length + 1);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < row_hashes.size(); ++i) {
    sum = sum * kBase + row_hashes[i].first;
    if (i >= length) {
      sum -= leaving * row_hashes[i - length].first;
    }
    if (i + 1 >= length) {
      windows.emplace_back(mixed(sum), i + 1 - length);
    }
  }
  return windows;
}

}  // namespace

std::vector<CopiedBlock> find_copied_blocks(const std::vector<std::span<const double>>& columns,
                                            const std::stop_token& stop) {
  const Rows rows(columns);
  const std::size_t n = rows.count();
  if (n < kFewestRows) {
    return {};
  }
  std::vector<Keyed> keyed;
  keyed.reserve(n);
  for (std::size_t i = 0; i < n && !polled(stop, i); ++i) {
    keyed.emplace_back(rows.hash(i), i);
  }
  const std::vector<Keyed> by_hash = sorted_by_hash(keyed, stop);
  if (stop.stop_requested()) {
    return {};
  }
  const double p = chance_of_going_on(rows, by_hash, stop);
  const double pairs = 0.5 * static_cast<double>(n) * static_cast<double>(n);
  const double least = p < 1.0 ? 1.0 + std::log(kByChance / pairs) / std::log(p) : static_cast<double>(n);
  if (least > 0.25 * static_cast<double>(n)) {
    return {};
  }
  const std::size_t length = std::max(kShortest, static_cast<std::size_t>(std::ceil(least)));
  const std::vector<Keyed> windows = sorted_by_hash(windows_of(keyed, length), stop);
  if (stop.stop_requested()) {
    return {};
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs_of;  // copy, first
  for (std::size_t k = 1; k < windows.size() && !polled(stop, k); ++k) {
    const std::size_t first = windows[k - 1].second;
    const std::size_t copy = windows[k].second;
    if (windows[k - 1].first == windows[k].first && copy - first >= length) {
      pairs_of.emplace_back(copy, first);
    }
  }
  std::sort(pairs_of.begin(), pairs_of.end());
  std::vector<CopiedBlock> blocks;
  for (auto [copy, first] : pairs_of) {
    if (stop.stop_requested()) {
      return {};
    }
    const std::size_t taken = blocks.empty() ? 0 : blocks.back().copy + blocks.back().length;
    if (copy < taken || rows.equal_from(first, copy, length) < length) {
      continue;
    }
    while (first > 0 && copy > taken && rows.equal(first - 1, copy - 1)) {
      --first;
      --copy;
    }
    const std::size_t whole = rows.equal_from(first, copy, copy - first);
    if (rows.changes(first, whole) >= std::max<std::size_t>(4, whole / 3)) {
      blocks.push_back({first, copy, whole});
    }
  }
  return blocks;
}

}  // namespace driftlab::investigate
