#include "server/store_gauges.hpp"

#include <algorithm>

namespace driftlab::server {

void add_store_gauges(Gauges& gauges, SqlStore& store, const Clock& clock) {
  if (const auto counts = store.counts(std::nullopt)) {
    gauges.devices = static_cast<double>(counts->devices);
    gauges.recordings = static_cast<double>(counts->recordings);
    gauges.jobs_queued = static_cast<double>(counts->queued);
    gauges.jobs_running = static_cast<double>(counts->running);
  }
  JobFilter waiting;
  waiting.state = JobState::Queued;
  if (const auto oldest = store.jobs(waiting, Page{"", 1}); oldest && !oldest->empty()) {
    gauges.oldest_queued_seconds = static_cast<double>(clock.now() - oldest->front().created_at) / 1e6;
  }
  if (const auto hooks = store.webhooks().webhook_counts()) {
    gauges.deliveries_waiting = static_cast<double>(hooks->waiting);
    gauges.webhooks_disabled = static_cast<double>(hooks->disabled);
  }
  if (const auto bytes = store.blob_bytes()) {
    gauges.blob_bytes = static_cast<double>(*bytes);
  }
  gauges.log_pages = static_cast<double>(store.log_pages().value_or(0));
  const WriteTimes::Counts writes = store.write_times();
  for (std::size_t i = 0; i < WriteTimes::kBounds.size(); ++i) {
    gauges.writes.buckets.emplace_back(WriteTimes::kBounds.at(i), writes.at_most.at(i));
  }
  gauges.writes.count = writes.count;
  gauges.writes.seconds = writes.seconds;
}

void add_disk_gauges(Gauges& gauges, BlobStore& blobs) {
  if (const auto space = blobs.space()) {
    gauges.free_bytes = static_cast<double>(space->free_bytes);
    gauges.free_fraction = space->free_fraction;
  }
}

void add_state_gauges(Gauges& gauges, const BadStates& states) {
  const std::vector<StandingState> standing = states.standing();
  for (const BadState state : all_bad_states()) {
    for (const std::string_view cause : causes_of_bad_states()) {
      const auto count = std::count_if(standing.begin(), standing.end(), [&](const StandingState& each) {
        return each.state == state && each.cause == cause;
      });
      gauges.bad_states.push_back({name_of(state), cause, static_cast<double>(count)});
    }
  }
}

}  // namespace driftlab::server
