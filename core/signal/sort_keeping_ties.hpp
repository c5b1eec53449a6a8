#pragma once
/// Sorting of short lists in which equal elements keep their order.
///
/// std::stable_sort of libstdc++ 12 calls a function that C++17 deprecates, which Clang reports as an error here. Lists
/// of models, tests and findings have dozens of entries: insertion is as good.
#include <algorithm>
#include <iterator>
#include <vector>

namespace driftlab {

/// Sorts `values` by `less`, a strict weak order. O(n log n) comparisons, O(n^2) moves.
template <class T, class Less>
void sort_keeping_ties(std::vector<T>& values, const Less& less) {
  for (auto next = values.begin(); next != values.end(); ++next) {
    std::rotate(std::upper_bound(values.begin(), next, *next, less), next, std::next(next));
  }
}

}  // namespace driftlab
