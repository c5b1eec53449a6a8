#include "core/signal/executor.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace driftlab {
namespace {

/// The executor whose seat this thread holds.
thread_local const Executor* seated_at = nullptr;

}  // namespace

/// One call of parallel_for.
struct Executor::Fork {
  const ThreadShare& share;
  const std::size_t count;
  const std::function<void(std::size_t)>& task;
  const std::stop_token& stop;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  unsigned helpers = 0;  ///< guarded by the pool's mutex
  std::mutex error_mutex;
  std::size_t failed_task = 0;
  std::exception_ptr error;

  [[nodiscard]] bool ended() const { return failed || next >= count || stop.stop_requested(); }

  /// Tasks are begun in the order of their numbers, so every task below one that failed has begun: the lowest that
  /// fails does so whatever the threads do.
  void fail(std::size_t number) {
    const std::lock_guard<std::mutex> guard(error_mutex);
    if (!error || number < failed_task) {
      failed_task = number;
      error = std::current_exception();
    }
    failed = true;
  }

  template <class Leave>
  void work(const Leave& leave) {
    while (!ended() && !leave()) {
      const std::size_t number = next++;
      if (number >= count) {
        return;
      }
      try {
        task(number);
      } catch (...) {
        fail(number);
      }
    }
  }
};

class Executor::Pool {
 public:
  Pool(const Executor& owner, unsigned threads) : seats_(threads), free_(threads) {
    helpers_.reserve(threads - 1);
    try {
      for (unsigned i = 1; i < threads; ++i) {  // one seat is always the caller's
        helpers_.emplace_back([this, &owner] { help(owner); });
      }
    } catch (const std::system_error&) {  // the system has no more threads to give
      const auto started = static_cast<unsigned>(helpers_.size()) + 1;
      const std::lock_guard<std::mutex> guard(mutex_);
      free_ -= seats_ - started;
      seats_ = started;
    }
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  ~Pool() {
    {
      const std::lock_guard<std::mutex> guard(mutex_);
      closing_ = true;
    }
    changed_.notify_all();
    for (std::thread& helper : helpers_) {
      helper.join();
    }
  }

  [[nodiscard]] unsigned seats() const { return seats_; }

  void sit() {
    std::unique_lock<std::mutex> guard(mutex_);
    ++wanted_;
    changed_.wait(guard, [this] { return free_ > 0; });
    --wanted_;
    --free_;
    if (free_ > 0) {
      changed_.notify_all();  // helpers stood back while this thread wanted a seat
    }
  }

  void stand_up() {
    {
      const std::lock_guard<std::mutex> guard(mutex_);
      ++free_;
    }
    changed_.notify_all();
  }

  /// The calling thread holds a seat.
  void run(Fork& fork) {
    {
      const std::lock_guard<std::mutex> guard(mutex_);
      forks_.push_back(&fork);
    }
    changed_.notify_all();
    fork.work([] { return false; });
    std::unique_lock<std::mutex> guard(mutex_);
    forks_.erase(std::find(forks_.begin(), forks_.end(), &fork));
    changed_.wait(guard, [&] { return fork.helpers == 0; });
  }

 private:
  /// What a thread of the pool does all its life.
  void help(const Executor& owner) {
    seated_at = &owner;  // it works only while it holds a seat
    std::unique_lock<std::mutex> guard(mutex_);
    while (true) {
      Fork* fork = nullptr;
      changed_.wait(guard, [&] { return closing_ || (fork = neediest()) != nullptr; });
      if (fork == nullptr) {
        return;
      }
      --free_;
      ++fork->helpers;
      guard.unlock();
      join(*fork);
      guard.lock();
      ++free_;
      --fork->helpers;
      changed_.notify_all();
    }
  }

  void join(Fork& fork) {
    const auto work = [&] { fork.work([this] { return wanted_ > 0; }); };
    try {
      if (fork.share.around) {
        fork.share.around(work);
      } else {
        work();
      }
    } catch (...) {  // of `around`; those of tasks are caught beside them
      fork.fail(fork.count);
    }
  }

  /// The open fork with the fewest helpers, the oldest of several; none while there is no seat for a helper.
  [[nodiscard]] Fork* neediest() const {
    Fork* found = nullptr;
    for (Fork* const fork : forks_) {
      if (free_ > 0 && wanted_ == 0 && !fork->ended() && (found == nullptr || fork->helpers < found->helpers)) {
        found = fork;
      }
    }
    return found;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  unsigned seats_;
  unsigned free_;
  std::atomic<unsigned> wanted_{0};  ///< threads that wait for a seat
  bool closing_ = false;
  std::vector<Fork*> forks_;
  std::vector<std::thread> helpers_;
};

Executor::Executor(unsigned threads) : pool_(std::make_unique<Pool>(*this, std::max(1U, threads))) {}

Executor::~Executor() = default;

unsigned Executor::threads() const { return pool_->seats(); }

Executor::Seat::Seat(Executor& executor) : executor_(executor), before_(seated_at) {
  if (before_ != &executor_) {
    executor_.pool_->sit();
    seated_at = &executor_;
  }
}

Executor::Seat::~Seat() {
  if (before_ != &executor_) {
    seated_at = before_;
    executor_.pool_->stand_up();
  }
}

void parallel_for(const ThreadShare& share, std::size_t count, const std::function<void(std::size_t)>& task,
                  const std::stop_token& stop) {
  if (share.executor == nullptr) {
    for (std::size_t i = 0; i < count && !stop.stop_requested(); ++i) {
      task(i);
    }
    return;
  }
  const Executor::Seat seat(*share.executor);
  Executor::Fork fork{.share = share, .count = count, .task = task, .stop = stop, .error_mutex = {}, .error = {}};
  if (count < 2 || share.executor->threads() < 2) {
    fork.work([] { return false; });
  } else {
    share.executor->pool_->run(fork);
  }
  if (fork.error) {
    std::rethrow_exception(fork.error);
  }
}

}  // namespace driftlab
