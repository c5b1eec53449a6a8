#pragma once
/// One job, many workers: how a kind of job divides its work into parts that are computed wherever a worker is idle.
///
/// The worker that claimed the job divides it (`share`) and works on its parts like everybody else, first to last;
/// workers that find no job of their own help. What a part found is a text in the store. The job's own worker takes the
/// texts in the order of their parts, whoever made them and whenever they came, so that the result is the same to the
/// bit for any number of workers. A worker that dies takes one part with it: what was found stays with the job, also
/// for a later attempt, and its part goes back to the job's own worker when the lease runs out.
///
/// A part that fails leaves an empty text. The job's own worker computes it again when its turn comes, and the failure
/// is then that of its own attempt: the job fails as it would have failed alone.
#include "core/signal/progress.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/jobs/part_text.hpp"
#include "server/store/part_store.hpp"

#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

namespace driftlab::server {

class JobParts {
 public:
  /// What part `number` finds, as a text; depends on the job's request and the number alone. Errors: whatever a job may
  /// fail with; Cancelled.
  using Part = std::function<Result<std::string>(std::size_t number, const RunControl& control)>;
  /// Takes what the next part found. False: no further part is needed.
  using Take = std::function<Result<bool>(const std::string& found)>;

  JobParts() = default;
  JobParts(const JobParts&) = delete;
  JobParts& operator=(const JobParts&) = delete;
  virtual ~JobParts() = default;

  /// Has parts 0 to `count` - 1 computed and gives each to `take`. Called once in a job. Progress runs over the parts.
  /// Errors: those of `take`; Cancelled; those of the store. Of several parts that fail, the first.
  [[nodiscard]] virtual Status share(std::size_t count, const Part& part, const Take& take,
                                     const RunControl& control) = 0;
};

/// The same with values in place of texts (part_text.hpp). A text that cannot be read is a part to be computed here.
template <class Value, class Compute, class Take>
[[nodiscard]] Status share_values(JobParts& parts, std::size_t count, const Compute& compute, const Take& take,
                                  const RunControl& control) {
  std::size_t next = 0;
  return parts.share(
      count,
      [&](std::size_t number, const RunControl& part) {
        return compute(number, part).map([](const Value& value) { return part_text(value); });
      },
      [&](const std::string& found) -> Result<bool> {
        const std::size_t number = next++;
        std::optional<Value> value = from_part_text<Value>(found);
        if (!value) {
          Result<Value> here = compute(number, RunControl{control.stop, {}, control.threads});
          if (!here) {
            return fail(here.error());
          }
          value = std::move(*here);
        }
        return take(std::move(*value));
      },
      control);
}

/// One part after the other, where nobody helps.
class PartsHere final : public JobParts {
 public:
  [[nodiscard]] Status share(std::size_t count, const Part& part, const Take& take, const RunControl& control) override;
};

/// A kind whose work goes through parts; where nobody helps, one after the other.
class DividedKind : public JobKind {
 public:
  [[nodiscard]] Result<JobResults> run(const Json& request, JobContext& context,
                                       const RunControl& control) const final {
    PartsHere here;
    return run_in_parts(request, context, control, here);
  }
  [[nodiscard]] Result<JobResults> run_in_parts(const Json& request, JobContext& context, const RunControl& control,
                                                JobParts& parts) const override = 0;
};

/// The part that a worker has claimed, whose lease another thread renews meanwhile.
class HeldPart {
 public:
  HeldPart(PartStore& store, std::int64_t lease_micros) : store_(store), lease_micros_(lease_micros) {}

  void hold(const PartClaim& claim);
  void let_go();
  /// False: the part is somebody else's now, or its job is over or to be cancelled.
  [[nodiscard]] bool renew();
  /// Gives the part up, if there is one.
  void put_back();

 private:
  PartStore& store_;
  const std::int64_t lease_micros_;
  std::mutex mutex_;
  std::optional<PartClaim> claim_;
};

/// The parts of the job that this worker runs.
class SharedParts final : public JobParts {
 public:
  /// `divided` is called once others can help.
  SharedParts(PartStore& store, Lease lease, std::int64_t lease_micros, std::function<void()> divided);

  [[nodiscard]] Status share(std::size_t count, const Part& part, const Take& take, const RunControl& control) override;

  // From other threads.
  void renew() { (void)held_.renew(); }
  void put_back() { held_.put_back(); }

 private:
  /// Works on a part, if one is left. False: none is.
  [[nodiscard]] Result<bool> work(std::size_t count, const Part& part, const RunControl& control);

  PartStore& store_;
  const Lease lease_;
  const std::int64_t lease_micros_;
  const std::function<void()> divided_;
  HeldPart held_;
};

/// The parts of a job that another worker runs, for one that helps: until none is left or a moment has passed.
class HelpedParts final : public JobParts {
 public:
  HelpedParts(PartStore& store, std::string job_id, std::int64_t lease_micros, std::int64_t at_most_micros);

  /// Takes nothing. Always an error, for whatever would come after it is the other worker's: Cancelled.
  [[nodiscard]] Status share(std::size_t count, const Part& part, const Take& take, const RunControl& control) override;

  // From other threads.
  [[nodiscard]] bool renew() { return held_.renew(); }
  void put_back() { held_.put_back(); }
  /// How many parts it has finished.
  [[nodiscard]] int finished() const { return finished_; }

 private:
  PartStore& store_;
  const std::string job_id_;
  const std::int64_t lease_micros_;
  const std::chrono::steady_clock::time_point until_;
  HeldPart held_;
  int finished_ = 0;
};

}  // namespace driftlab::server
