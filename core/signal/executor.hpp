#pragma once
/// The threads that compute: one executor, shared by everything that a process computes at the same time.
///
/// An executor of N threads has N seats, and only a thread that holds a seat computes. A computation states how much it
/// can use by the number of independent tasks it hands to `parallel_for`. The calling thread works on its own tasks;
/// threads of the executor take the seats that are left and join the computation that has the fewest of them. When
/// another caller wants a seat, a helping thread gives its own up at the end of its task. So never more than N threads
/// compute, a computation that finds every seat taken goes on alone, and one that is left alone gets the whole machine.
///
/// Deterministic: a task may depend on its number alone, and results stand where the number says, whichever thread
/// worked them out. Tasks may hand out tasks of their own; a thread waits only for tasks that others are at work on,
/// and these wait for none but their own, so that nothing can wait in a circle.
#include <cstddef>
#include <functional>
#include <memory>
#include <stop_token>

namespace driftlab {

struct ThreadShare;

/// Thread safe. Where the system gives fewer threads than asked for, the executor does with fewer.
class Executor {
 public:
  /// At most `threads` threads compute at once; 0 counts as 1.
  explicit Executor(unsigned threads);
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;
  /// No computation may be under way.
  ~Executor();

  [[nodiscard]] unsigned threads() const;

  /// While it lives, the thread that made it holds a seat. The constructor waits for one; a thread that holds a seat of
  /// this executor already keeps that one.
  class Seat {
   public:
    explicit Seat(Executor& executor);
    Seat(const Seat&) = delete;
    Seat& operator=(const Seat&) = delete;
    ~Seat();

   private:
    Executor& executor_;
    const Executor* before_;
  };

 private:
  struct Fork;
  class Pool;
  friend void parallel_for(const ThreadShare& share, std::size_t count, const std::function<void(std::size_t)>& task,
                           const std::stop_token& stop);
  std::unique_ptr<Pool> pool_;
};

/// Which threads a computation may use beside its own.
struct ThreadShare {
  /// Null: the calling thread works alone.
  Executor* executor = nullptr;
  /// What a thread that joins the computation wraps around its work, for example to charge a fault to the right job.
  /// It must call what it is given once. May be empty.
  std::function<void(const std::function<void()>& work)> around = {};
};

/// Calls `task` with every number from 0 to `count` - 1 once and returns when all calls have ended. Once `stop` is
/// requested no further task begins, and the caller must look at the token before it uses the results.
///
/// An exception of a task comes out of this call in the calling thread, as it would from a loop: no further task
/// begins, and of several exceptions that of the lowest number is thrown, for any number of threads.
void parallel_for(const ThreadShare& share, std::size_t count, const std::function<void(std::size_t)>& task,
                  const std::stop_token& stop = {});

}  // namespace driftlab
