#include "core/signal/stretch.hpp"

#include <algorithm>
#include <numeric>

namespace driftlab {
namespace {

std::size_t rows_of(std::span<const RowRun> runs) {
  return std::accumulate(runs.begin(), runs.end(), std::size_t{0},
                         [](std::size_t sum, const RowRun& run) { return sum + run.count; });
}

/// Between the runs: what is missing before the first does not count.
std::size_t missing_of(std::span<const RowRun> runs) {
  return runs.empty() ? 0
                      : std::accumulate(runs.begin() + 1, runs.end(), std::size_t{0},
                                        [](std::size_t sum, const RowRun& run) { return sum + run.missing; });
}

bool little_missing(std::span<const RowRun> runs) {
  const auto missing = static_cast<double>(missing_of(runs));
  const auto rows = static_cast<double>(rows_of(runs));
  if (missing <= kMostMissing * (missing + rows)) {
    return true;
  }
  const auto longest = std::max_element(runs.begin() + 1, runs.end(),
                                        [](const RowRun& a, const RowRun& b) { return a.missing < b.missing; });
  return missing <= kMostScattered * (missing + rows) && static_cast<double>(longest->missing) <= kScattered * rows;
}

}  // namespace

std::size_t Stretch::rows() const { return rows_of(runs); }
std::size_t Stretch::missing() const { return missing_of(runs); }

std::vector<Gap> Stretch::gaps() const {
  std::vector<Gap> gaps;
  std::size_t row = 0;
  for (const RowRun& run : runs) {
    if (row > 0) {
      gaps.push_back({row, run.missing});
    }
    row += run.count;
  }
  return gaps;
}

RowRun Stretch::longest() const {
  const auto longest =
      std::max_element(runs.begin(), runs.end(), [](const RowRun& a, const RowRun& b) { return a.count < b.count; });
  return longest == runs.end() ? RowRun{} : *longest;
}

Stretch choose_stretch(std::span<const RowRun> runs) {
  std::span<const RowRun> part = runs;
  while (part.size() > 1 && !little_missing(part)) {
    const auto largest = std::max_element(part.begin() + 1, part.end(),
                                          [](const RowRun& a, const RowRun& b) { return a.missing < b.missing; });
    const auto before = part.first(static_cast<std::size_t>(largest - part.begin()));
    const auto after = part.subspan(before.size());
    part = rows_of(before) >= rows_of(after) ? before : after;
  }
  Stretch chosen{{part.begin(), part.end()}};
  const Stretch all{{runs.begin(), runs.end()}};
  if (const RowRun longest = all.longest(); longest.count > chosen.rows()) {
    chosen.runs = {longest};
  }
  return chosen;
}

std::vector<RowRun> cut_at_gaps(std::size_t first, std::size_t last, std::span<const Gap> gaps) {
  std::vector<RowRun> runs;
  std::size_t missing = 0;
  for (const Gap& gap : gaps) {
    if (gap.row > first && gap.row < last) {
      runs.push_back({first, gap.row - first, missing});
      first = gap.row;
      missing = gap.missing;
    }
  }
  if (last > first) {
    runs.push_back({first, last - first, missing});
  }
  return runs;
}

std::vector<RowRun> without_rows(std::span<const RowRun> runs, std::span<const std::size_t> removed,
                                 std::pair<std::size_t, std::size_t> block) {
  std::vector<RowRun> left;
  std::size_t missing = 0;
  auto next = removed.begin();
  for (const RowRun& run : runs) {
    missing += run.missing;
    std::size_t row = run.first;
    const std::size_t end = run.first + run.count;
    while (row < end) {
      next = std::lower_bound(next, removed.end(), row);
      std::size_t bad = next == removed.end() ? end : std::min(*next, end);
      const bool block_ahead = block.second > row;
      bad = block_ahead ? std::min(bad, std::max(block.first, row)) : bad;
      if (bad > row) {
        left.push_back({row, bad - row, missing});
        missing = 0;
        row = bad;
      }
      if (row < end) {
        const bool inside = block_ahead && block.first <= row;
        const std::size_t behind = std::min(inside ? block.second : row + 1, end);
        missing += behind - row;
        row = behind;
      }
    }
  }
  return left;
}

std::vector<RowRun> shared_runs(std::span<const RowRun> a, std::span<const RowRun> b) {
  std::vector<RowRun> shared;
  std::size_t place = 0;   // of the run of `a` on its grid
  std::size_t behind = 0;  // place behind the last shared row
  auto first_of_b = b.begin();
  for (const RowRun& mine : a) {
    place += &mine == a.data() ? 0 : mine.missing;
    while (first_of_b != b.end() && first_of_b->first + first_of_b->count <= mine.first) {
      ++first_of_b;
    }
    for (auto other = first_of_b; other != b.end() && other->first < mine.first + mine.count; ++other) {
      const std::size_t first = std::max(mine.first, other->first);
      const std::size_t last = std::min(mine.first + mine.count, other->first + other->count);
      const std::size_t at = place + first - mine.first;
      shared.push_back({first, last - first, shared.empty() ? 0 : at - behind});
      behind = at + last - first;
    }
    place += mine.count;
  }
  return shared;
}

}  // namespace driftlab
