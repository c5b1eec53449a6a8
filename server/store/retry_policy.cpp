#include "server/store/retry_policy.hpp"

#include <algorithm>

namespace driftlab::server {

std::int64_t pause_bound_micros(int failures) {
  std::int64_t bound = 1'000'000;
  for (int i = 0; i < failures && bound < kLongestPauseMicros; ++i) {
    bound *= 4;
  }
  return std::min(bound, kLongestPauseMicros);
}

std::int64_t draw_pause_micros(int failures, std::mt19937_64& generator) {
  return std::uniform_int_distribution<std::int64_t>(0, pause_bound_micros(failures))(generator);
}

std::chrono::milliseconds draw_pause(std::chrono::milliseconds bound) {
  thread_local std::mt19937_64 generator{std::random_device{}()};
  return std::chrono::milliseconds(std::uniform_int_distribution<std::int64_t>(0, bound.count())(generator));
}

}  // namespace driftlab::server
