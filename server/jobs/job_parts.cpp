#include "server/jobs/job_parts.hpp"

#include <condition_variable>

namespace driftlab::server {
namespace {

/// How often the job's own worker looks for what others have found, where it has nothing to do itself.
constexpr std::chrono::milliseconds kLook{50};
/// Texts read at once.
constexpr int kTexts = 16;

Error stopped() { return {ErrorCode::Cancelled, "The job was stopped.", {}}; }

/// Sleeps a moment, or until the stop.
void rest(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any woken;
  std::unique_lock<std::mutex> lock(mutex);
  (void)woken.wait_for(lock, stop, kLook, [] { return false; });
}

/// The text that a part leaves: an empty one where it failed. Error: Cancelled.
Result<std::string> text_of(Result<std::string> found) {
  return found || found.error().code == ErrorCode::Cancelled ? std::move(found) : Result<std::string>(std::string());
}

}  // namespace

Status PartsHere::share(std::size_t count, const Part& part, const Take& take, const RunControl& control) {
  for (std::size_t number = 0; number < count; ++number) {
    const auto done = static_cast<double>(number);
    const RunControl own = control.reporting([&](std::string_view stage, double fraction) {
      control.report(stage, (done + fraction) / static_cast<double>(count));
    });
    const Result<std::string> found = part(number, own);
    if (!found) {
      return fail(found.error());
    }
    const Result<bool> more = take(*found);
    if (!more || !*more) {
      return more ? Status{} : fail(more.error());
    }
  }
  return {};
}

void HeldPart::hold(const PartClaim& claim) {
  const std::lock_guard<std::mutex> guard(mutex_);
  claim_ = claim;
}

void HeldPart::let_go() {
  const std::lock_guard<std::mutex> guard(mutex_);
  claim_.reset();
}

bool HeldPart::renew() {
  std::optional<PartClaim> claim;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    claim = claim_;
  }
  if (!claim) {
    return true;
  }
  // A renewal that the store could not write is tried again at the next beat.
  const Result<LeaseStatus> renewed = store_.renew_part(*claim, lease_micros_);
  return !renewed || (renewed->held && !renewed->cancel_requested);
}

void HeldPart::put_back() {
  std::optional<PartClaim> claim;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    claim = std::exchange(claim_, std::nullopt);
  }
  if (claim) {
    (void)store_.put_back_part(*claim);
  }
}

SharedParts::SharedParts(PartStore& store, Lease lease, std::int64_t lease_micros, std::function<void()> divided)
    : store_(store),
      lease_(std::move(lease)),
      lease_micros_(lease_micros),
      divided_(std::move(divided)),
      held_(store, lease_micros) {}

Result<bool> SharedParts::work(std::size_t count, const Part& part, const RunControl& control) {
  const auto claimed = store_.claim_part(lease_.job_id, true, lease_micros_);
  if (!claimed) {
    return fail(claimed.error());
  }
  const std::optional<PartClaim>& claim = *claimed;
  if (!claim) {
    return false;
  }
  held_.hold(*claim);
  const auto finished = store_.count_finished_parts(lease_.job_id);
  const auto done = static_cast<double>(finished.value_or(0));
  const RunControl own = control.reporting([&](std::string_view stage, double fraction) {
    control.report(stage, (done + fraction) / static_cast<double>(count));
  });
  const Result<std::string> text = text_of(part(static_cast<std::size_t>(claim->number), own));
  if (!text) {
    held_.put_back();
    return fail(text.error());
  }
  const auto written = store_.finish_part(*claim, *text);
  held_.let_go();
  return written ? Result<bool>(true) : fail(written.error());
}

Status SharedParts::share(std::size_t count, const Part& part, const Take& take, const RunControl& control) {
  const auto divided = store_.divide(lease_, static_cast<std::int64_t>(count), DRIFTLAB_VERSION);
  if (!divided) {
    return fail(divided.error());
  }
  if (!divided->held) {
    return fail(stopped());
  }
  if (count > 1 && divided_) {
    divided_();
  }
  std::size_t taken = 0;
  while (taken < count) {
    const auto texts = store_.finished_parts(lease_.job_id, static_cast<std::int64_t>(taken), kTexts);
    if (!texts) {
      return fail(texts.error());
    }
    for (const std::string& text : *texts) {
      const Result<bool> more = take(text);
      if (!more || !*more) {
        return more ? Status{} : fail(more.error());
      }
      ++taken;
    }
    if (control.stop.stop_requested()) {
      return fail(stopped());
    }
    if (!texts->empty()) {
      continue;
    }
    const Result<bool> worked = work(count, part, control);
    if (!worked) {
      return fail(worked.error());
    }
    if (!*worked) {
      rest(control.stop);
    }
  }
  return {};
}

HelpedParts::HelpedParts(PartStore& store, std::string job_id, std::int64_t lease_micros, std::int64_t at_most_micros)
    : store_(store),
      job_id_(std::move(job_id)),
      lease_micros_(lease_micros),
      until_(std::chrono::steady_clock::now() + std::chrono::microseconds(at_most_micros)),
      held_(store, lease_micros) {}

Status HelpedParts::share(std::size_t count, const Part& part, const Take& /*take*/, const RunControl& control) {
  while (!control.stop.stop_requested() && std::chrono::steady_clock::now() < until_) {
    const auto claim = store_.claim_part(job_id_, false, lease_micros_).value_or(std::nullopt);
    if (!claim) {
      break;
    }
    held_.hold(*claim);
    const auto number = static_cast<std::size_t>(claim->number);
    const Result<std::string> text = number < count ? text_of(part(number, control)) : Result<std::string>("");
    if (!text) {
      held_.put_back();
      break;
    }
    const auto written = store_.finish_part(*claim, *text);
    held_.let_go();
    finished_ += written && written->held && !text->empty() ? 1 : 0;
    if (!written || !written->held || written->cancel_requested) {
      break;
    }
  }
  return fail(stopped());
}

}  // namespace driftlab::server
