#pragma once
/// Independent pieces of work on several threads; which thread does which does not matter to any result.
#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace driftlab::investigate {

inline void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      work(i);
    }
  };
  std::vector<std::jthread> others;
  for (unsigned t = 1; t < threads && t < count; ++t) {
    others.emplace_back(run);
  }
  run();
}

}  // namespace driftlab::investigate
