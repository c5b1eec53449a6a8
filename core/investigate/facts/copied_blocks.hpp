#pragma once
/// Blocks of samples that a recording holds twice.
///
/// A logger that loses its place writes a buffer a second time. Two equal rows prove nothing, for numbers are rounded;
/// a run of equal rows does, once it is longer than chance allows. With p the probability that a row equals another if
/// the rows before them were equal, some pair of windows of L among n rows is equal by chance with a probability below
/// n^2/2 p^(L-1), so that windows of
///   L = 1 + ln(1e-4 / (n^2/2)) / ln p,   at least 8,
/// are found by chance in one recording of ten thousand. p is counted on pairs of equal rows more than one row apart
/// whose equality does not go on for six rows, for else the copies themselves would raise it. A window that hardly
/// changes is stuck and not copied.
#include <cstddef>
#include <span>
#include <stop_token>
#include <vector>

namespace driftlab::investigate {

/// Rows [copy, copy + length) repeat rows [first, first + length), which lie before them.
struct CopiedBlock {
  std::size_t first = 0;
  std::size_t copy = 0;
  std::size_t length = 0;
};

/// The copies among the rows of a recording, by place; a row is the values of all `columns` together, which are equally
/// long. O(n log n). None once `stop` is asked.
[[nodiscard]] std::vector<CopiedBlock> find_copied_blocks(const std::vector<std::span<const double>>& columns,
                                                          const std::stop_token& stop = {});

}  // namespace driftlab::investigate
