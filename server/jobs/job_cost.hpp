#pragma once
/// What a job will take, from its request alone: jobs are admitted against budgets of memory and time before they
/// begin, so that neither one nor several together bring the machine down.
///
/// Each kind estimates memory on the high side and time as measured, from recordings of several sizes
/// (tests/RELIABILITY.md). A job larger than a whole budget is refused when it is asked for; one whose memory does not
/// fit beside those that run waits. What takes longer than its budget all the same is ended then.
#include "core/signal/result.hpp"
#include "schema/json/json.hpp"
#include "server/store/budgets.hpp"
#include "server/store/store.hpp"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <vector>

namespace driftlab::server {

struct JobCost {
  std::int64_t memory_bytes = std::int64_t{32} << 20;
  double seconds = 0.0;         ///< however many threads it has
  double shared_seconds = 0.0;  ///< of one thread; all on which jobs compute share it among them
};

/// The size of a stored recording.
struct RecordingSize {
  std::int64_t rows = 0;
  std::int64_t columns = 0;
};

/// Of the recordings [{"id"}] of a canonical request, in its order; one that is gone has no size.
[[nodiscard]] std::vector<RecordingSize> sizes_of(const Json& recordings, Store& store);

/// The budget job_memory_bytes, or half of the memory that this process may use where it is 0.
[[nodiscard]] std::int64_t memory_for_jobs(const Budgets& budgets);

/// Error: LimitExceeded naming the budget, for a job that could never run, or never end in time on `computing` threads
/// (0: one for each core).
[[nodiscard]] Status admit_cost(const JobCost& cost, const Budgets& budgets, int computing);

/// Shares memory out among running jobs, in the order in which they came: a large one is not passed by small ones for
/// ever. Thread safe.
class MemoryGate {
 public:
  explicit MemoryGate(std::int64_t bytes) : left_(bytes), whole_(bytes) {}

  /// Bytes held until it is destroyed. The constructor waits for them, or until `stop` is requested (`held` is then
  /// false); `waiting` is called once if it has to. More than there is in all is taken as all there is.
  class Share {
   public:
    Share(MemoryGate& gate, std::int64_t bytes, const std::stop_token& stop, const std::function<void()>& waiting);
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;
    ~Share();
    [[nodiscard]] bool held() const { return held_; }

   private:
    MemoryGate& gate_;
    std::int64_t bytes_;
    bool held_ = false;
  };

 private:
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<const Share*> queue_;
  std::int64_t left_;
  const std::int64_t whole_;
};

}  // namespace driftlab::server
