#include "server/api/live_keeper.hpp"

#include "core/signal/number.hpp"
#include "server/api/documents.hpp"
#include "server/api/live_about.hpp"
#include "server/api/record_blob.hpp"
#include "server/store/guarded_round.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <span>

namespace driftlab::server {
namespace {

constexpr UtcMicros kUnfinishedMicros = 3600LL * 1'000'000;

Status write_csv(IncomingBlob& blob, const LiveAbout& about, const LiveSamples& samples) {
  std::string text(kLiveTime);
  for (const std::string& column : about.columns) {
    text += ',' + column;
  }
  text += '\n';
  for (std::size_t row = 0; row < samples.time_s.size(); ++row) {
    text += driftlab::to_text(samples.time_s[row] - samples.time_s.front());
    for (const std::vector<double>& column : samples.columns) {
      text += ',';
      if (std::isfinite(column[row])) {
        std::array<char, 32> buffer{};
        const auto [stop, error] =
            std::to_chars(buffer.data(), buffer.data() + buffer.size(), static_cast<float>(column[row]));
        text.append(buffer.data(), error == std::errc{} ? stop : buffer.data());
      }
    }
    text += '\n';
    if (text.size() > kLongestLivePiece || row + 1 == samples.time_s.size()) {
      if (Status added = blob.append(std::as_bytes(std::span(text))); !added) {
        return added;
      }
      text.clear();
    }
  }
  if (samples.time_s.empty()) {
    return fail(ErrorCode::NoSamples, "No samples came; there is nothing to record.");
  }
  return blob.seal();
}

/// An exception over one recording leaves the others their turn.
void for_each(const std::vector<std::string>& ids, const std::function<void(const std::string& id)>& treat) {
  for (const std::string& id : ids) {
    (void)guarded_round("live recordings", [&] { treat(id); });
  }
}

}  // namespace

LiveKeeper::LiveKeeper(ApiContext& context)
    : context_(context), recordings_(context.data / "live", context.clock), sweeper_([this] { sweep(); }) {}

LiveKeeper::~LiveKeeper() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stopped_.notify_all();
  sweeper_.join();
}

bool LiveKeeper::is_admitted(const LiveRecording& recording) const {
  const auto principal = principal_of(recording);
  return !principal || context_.gate.is_valid(*principal);
}

Result<Json> LiveKeeper::finish(const std::string& id) {
  const std::lock_guard finishing(finish_);
  const auto live = recordings_.find(id);
  if (!live) {
    return fail(live.error());
  }
  Caller caller = caller_of_thread() != nullptr ? *caller_of_thread() : Caller{};
  std::optional<ActingFor> acting;
  if (auto principal = principal_of(*live)) {
    caller.principal = std::move(*principal);
    acting.emplace(caller);
  }
  auto about = about_of(*live);
  const auto samples = recordings_.samples(id);
  if (!about || !samples) {
    return fail(!about ? about.error() : samples.error());
  }
  auto blob = context_.blobs.begin();
  if (!blob) {
    return fail(blob.error());
  }
  if (Status written = write_csv(**blob, *about, *samples); !written) {
    return fail(written.error());
  }
  about->metadata.spec.columns[std::string(kLiveTime)] = {Quantity::Time, "", parse_unit("s").value()};
  about->metadata.spec.rate_hz.reset();  // the stamps say it
  auto made = record_blob(context_, **blob, about->metadata);
  if (!made) {
    return fail(made.error());
  }
  Json recording = stored(made->body);
  const Json job = characterise(recording.at("id").get<std::string>());
  (void)recordings_.remove(id);
  context_.bell.ring(id);
  return Json{{"recording", std::move(recording)}, {"job", job}};
}

Json LiveKeeper::characterise(const std::string& recording) {
  const Caller* const caller = caller_of_thread();
  const bool may = caller == nullptr || caller->principal.scope >= Scope::Run;
  if (!may || refuse_full_queue(context_.store, context_.budgets)) {
    return nullptr;
  }
  JobContext job_context = context_.job_context();
  const auto job = new_job(*find_job_kind("characterise"), Json{{"recordings", Json::array({recording})}},
                           Json::object(), job_context);
  const auto queued = job ? context_.store.enqueue(*job) : Result<EnqueuedJob>(fail(job.error()));
  if (!queued) {
    return nullptr;
  }
  announce_job(context_, queued->job.id);
  context_.wake_workers();
  return to_json(queued->job);
}

void LiveKeeper::sweep() {
  std::unique_lock lock(mutex_);
  while (!stopped_.wait_for(lock, std::chrono::minutes(1), [this] { return stopping_; })) {
    lock.unlock();
    (void)guarded_round("live recordings", [this] { finish_untouched(); });
    lock.lock();
  }
}

void LiveKeeper::finish_untouched() {
  const UtcMicros now = context_.clock.now();
  for_each(recordings_.due_since(now - kUnfinishedMicros), [this](const std::string& id) { try_to_finish(id); });
  for_each(recordings_.untouched_since(now - kLiveMicros),
           [this](const std::string& id) { (void)recordings_.remove(id); });
}

void LiveKeeper::try_to_finish(const std::string& id) {
  recordings_.put_off(id);  // an exception is a failure too
  if (const auto live = recordings_.find(id); live && is_admitted(*live)) {
    (void)finish(id);
  }
}

}  // namespace driftlab::server
