#include "core/variance/window_medians.hpp"

#include "core/variance/kernels.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {
namespace {

using Exchange = std::pair<std::uint16_t, std::uint16_t>;

/// Of a network that sorts `length` values.
std::vector<Exchange> sorting_network(std::size_t length) {
  std::vector<Exchange> all;
  std::size_t top = 1;
  while (2 * top < length) {
    top *= 2;
  }
  for (std::size_t p = top; p > 0 && length > 1; p /= 2) {
    std::size_t r = 0;
    std::size_t d = p;
    for (std::size_t q = top;; q /= 2) {
      for (std::size_t i = 0; i + d < length; ++i) {
        if ((i & p) == r) {
          all.emplace_back(static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(i + d));
        }
      }
      if (q == p) {
        break;
      }
      d = q - p;
      r = p;
    }
  }
  return all;
}

}  // namespace

WindowMedians::WindowMedians(std::size_t length) : length_(length), columns_(length * kWindowsAtOnce) {
  const std::vector<Exchange> all = sorting_network(length);
  std::vector<bool> wanted(length, false);
  wanted[length / 2] = true;
  std::vector<Exchange> kept;
  for (std::size_t k = all.size(); k-- > 0;) {
    const auto [low, high] = all[k];
    if (wanted[low] || wanted[high]) {
      wanted[low] = wanted[high] = true;
      kept.push_back(all[k]);
    }
  }
  for (std::size_t k = kept.size(); k-- > 0;) {
    pairs_.push_back(kept[k].first);
    pairs_.push_back(kept[k].second);
  }
}

void WindowMedians::find(const double* samples, std::size_t stride, std::size_t count, double* out) {
  for (std::size_t first = 0; first < count; first += kWindowsAtOnce) {
    const std::size_t windows = std::min(kWindowsAtOnce, count - first);
    for (std::size_t w = 0; w < kWindowsAtOnce; ++w) {  // the last one again where there are fewer
      const double* const from = samples + (first + std::min(w, windows - 1)) * stride;
      for (std::size_t i = 0; i < length_; ++i) {
        columns_[i * kWindowsAtOnce + w] = from[i];
      }
    }
    kernels().exchange(columns_.data(), pairs_.data(), exchanges());
    std::copy_n(columns_.data() + length_ / 2 * kWindowsAtOnce, windows, out + first);
  }
}

}  // namespace driftlab
