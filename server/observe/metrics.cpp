#include "server/observe/metrics.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace driftlab::server {
namespace {

/// The shortest text that reads back as the same number.
std::string number_text(double value) {
  std::array<char, 32> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), written.ptr};
}

void head(std::string& text, std::string_view name, std::string_view type, std::string_view help) {
  text.append("# HELP ").append(name).append(" ").append(help).append("\n# TYPE ");
  text.append(name).append(" ").append(type).append("\n");
}

void sample(std::string& text, std::string_view name, const std::string& labels, double value) {
  text.append(name);
  if (!labels.empty()) {
    text.append("{").append(labels).append("}");
  }
  text.append(" ").append(number_text(value)).append("\n");
}

/// A label whose value holds nothing to escape: all come from closed sets of our own.
std::string label(std::string_view name, std::string_view value) {
  return std::string(name) + "=\"" + std::string(value) + "\"";
}

void single(std::string& text, std::string_view name, std::string_view type, std::string_view help, double value) {
  head(text, name, type, help);
  sample(text, name, "", value);
}

/// Methods that routes have; whatever else a client sends is one.
std::string_view known_method(std::string_view method) {
  static constexpr std::array<std::string_view, 7> kMethods{"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"};
  return std::find(kMethods.begin(), kMethods.end(), method) == kMethods.end() ? "other" : method;
}

}  // namespace

template <std::size_t N>
void Metrics::observe(Histogram<N>& histogram, const std::array<double, N>& bounds, double value) {
  for (std::size_t i = 0; i < N; ++i) {
    histogram.counts[i] += value <= bounds[i] ? 1 : 0;
  }
  ++histogram.count;
  histogram.sum += value;
}

template <std::size_t N>
void Metrics::write(std::string& text, std::string_view name, const std::string& labels, const Histogram<N>& histogram,
                    const std::array<double, N>& bounds) {
  const std::string bucket = std::string(name) + "_bucket";
  for (std::size_t i = 0; i < N; ++i) {
    sample(text, bucket, labels + "," + label("le", number_text(bounds[i])), static_cast<double>(histogram.counts[i]));
  }
  sample(text, bucket, labels + "," + label("le", "+Inf"), static_cast<double>(histogram.count));
  sample(text, std::string(name) + "_sum", labels, histogram.sum);
  sample(text, std::string(name) + "_count", labels, static_cast<double>(histogram.count));
}

void Metrics::count_request(std::string_view method, std::string_view route, int status, double seconds,
                            std::uint64_t bytes_in, std::uint64_t bytes_out) {
  const std::string shown(route.empty() ? "none" : route);
  const std::lock_guard<std::mutex> guard(mutex_);
  ++requests_[{std::string(known_method(method)), shown, std::to_string(status / 100) + "xx"}];
  observe(request_seconds_[shown], kRequestBounds, seconds);
  bytes_in_ += bytes_in;
  bytes_out_ += bytes_out;
}

void Metrics::count_helped(std::string_view kind, int parts) {
  const std::lock_guard<std::mutex> guard(mutex_);
  helped_[std::string(kind)] += static_cast<std::uint64_t>(parts);
}

void Metrics::count_attempt(std::string_view kind, std::string_view outcome, double seconds) {
  const std::lock_guard<std::mutex> guard(mutex_);
  ++attempts_[{std::string(kind), std::string(outcome)}];
  observe(job_seconds_[std::string(kind)], kJobBounds, seconds);
}

void Metrics::count_delivery(std::string_view outcome) {
  const std::lock_guard<std::mutex> guard(mutex_);
  ++deliveries_[std::string(outcome)];
}

std::string Metrics::text(const Gauges& gauges, std::string_view version) const {
  std::string text;
  const std::lock_guard<std::mutex> guard(mutex_);
  head(text, "driftlab_build_info", "gauge", "The release that runs.");
  sample(text, "driftlab_build_info", label("version", version), 1.0);
  single(text, "driftlab_ready", "gauge", "1 where the daemon can take work.", gauges.ready);
  single(text, "driftlab_start_time_seconds", "gauge", "When the daemon started.", gauges.started_at);

  head(text, "driftlab_http_requests_total", "counter", "Requests answered, by route template.");
  for (const auto& [key, count] : requests_) {
    const auto& [method, route, status] = key;
    sample(text, "driftlab_http_requests_total",
           label("method", method) + "," + label("route", route) + "," + label("status", status),
           static_cast<double>(count));
  }
  head(text, "driftlab_http_request_seconds", "histogram",
       "Time that the daemon took for a request: not that in which its body came, its client waited or a stream went "
       "on.");
  for (const auto& [route, histogram] : request_seconds_) {
    write(text, "driftlab_http_request_seconds", label("route", route), histogram, kRequestBounds);
  }
  single(text, "driftlab_http_received_bytes_total", "counter", "Bytes of bodies received.",
         static_cast<double>(bytes_in_));
  single(text, "driftlab_http_sent_bytes_total", "counter", "Bytes of bodies sent.", static_cast<double>(bytes_out_));
  single(text, "driftlab_http_connections", "gauge", "Connections open.", gauges.connections);
  single(text, "driftlab_http_idle_connections", "gauge", "Of these, waiting for a request.", gauges.idle_connections);
  single(text, "driftlab_http_connections_turned_away_total", "counter", "Connections closed for want of a place.",
         gauges.turned_away);
  single(text, "driftlab_http_requests_in_flight", "gauge", "Requests that are being answered.",
         gauges.requests_in_flight);
  single(text, "driftlab_uploads_running", "gauge", "Uploads under way.", gauges.uploads);

  head(text, "driftlab_job_attempts_total", "counter", "Attempts at jobs that ended, by kind and outcome.");
  for (const auto& [key, count] : attempts_) {
    sample(text, "driftlab_job_attempts_total", label("kind", key.first) + "," + label("outcome", key.second),
           static_cast<double>(count));
  }
  // From the start, for whoever watches it rise: a job given up is one that somebody must look at.
  double dead = 0.0;
  for (const auto& [key, count] : attempts_) {
    dead += key.second == "dead" ? static_cast<double>(count) : 0.0;
  }
  single(text, "driftlab_jobs_dead_total", "counter", "Jobs that were given up after their last attempt.", dead);
  head(text, "driftlab_job_seconds", "histogram", "Time that an attempt took, by kind.");
  for (const auto& [kind, histogram] : job_seconds_) {
    write(text, "driftlab_job_seconds", label("kind", kind), histogram, kJobBounds);
  }
  head(text, "driftlab_job_parts_helped_total", "counter",
       "Parts computed for jobs that another worker runs, by kind.");
  for (const auto& [kind, count] : helped_) {
    sample(text, "driftlab_job_parts_helped_total", label("kind", kind), static_cast<double>(count));
  }
  single(text, "driftlab_jobs_queued", "gauge", "Jobs that wait.", gauges.jobs_queued);
  single(text, "driftlab_jobs_running", "gauge", "Jobs that run.", gauges.jobs_running);
  single(text, "driftlab_jobs_oldest_queued_seconds", "gauge", "How long the oldest of them has waited.",
         gauges.oldest_queued_seconds);

  head(text, "driftlab_webhook_attempts_total", "counter", "Attempts at deliveries to webhooks, by outcome.");
  // All outcomes from the start: a counter that appears with its first count has not risen for who watches it.
  for (const char* const outcome : {"delivered", "failed", "given_up"}) {
    const auto found = deliveries_.find(outcome);
    const double count = found == deliveries_.end() ? 0.0 : static_cast<double>(found->second);
    sample(text, "driftlab_webhook_attempts_total", label("outcome", outcome), count);
  }
  single(text, "driftlab_webhook_deliveries_waiting", "gauge", "Deliveries to webhooks that wait.",
         gauges.deliveries_waiting);
  single(text, "driftlab_webhooks_disabled", "gauge", "Webhooks that were disabled.", gauges.webhooks_disabled);

  single(text, "driftlab_devices", "gauge", "Devices known.", gauges.devices);
  single(text, "driftlab_recordings", "gauge", "Recordings stored.", gauges.recordings);
  single(text, "driftlab_disk_free_bytes", "gauge", "Free where the daemon keeps its data.", gauges.free_bytes);
  single(text, "driftlab_disk_free_ratio", "gauge", "The same as a fraction of the disk.", gauges.free_fraction);
  head(text, "driftlab_bad_states", "gauge", "What is wrong now, by state and cause.");
  for (const Gauges::State& each : gauges.bad_states) {
    sample(text, "driftlab_bad_states", label("state", each.state) + "," + label("cause", each.cause), each.count);
  }
  head(text, "driftlab_store_write_seconds", "histogram", "Time until a write to the store was on disk.");
  for (const auto& [bound, count] : gauges.writes.buckets) {
    sample(text, "driftlab_store_write_seconds_bucket", label("le", number_text(bound)), static_cast<double>(count));
  }
  sample(text, "driftlab_store_write_seconds_bucket", label("le", "+Inf"), static_cast<double>(gauges.writes.count));
  sample(text, "driftlab_store_write_seconds_sum", "", gauges.writes.seconds);
  sample(text, "driftlab_store_write_seconds_count", "", static_cast<double>(gauges.writes.count));
  single(text, "driftlab_store_log_pages", "gauge", "Pages of the database's write-ahead log.", gauges.log_pages);
  single(text, "driftlab_blob_bytes", "gauge", "Bytes of all recordings as they were uploaded.", gauges.blob_bytes);
  if (gauges.backup_age_seconds) {
    single(text, "driftlab_backup_age_seconds", "gauge",
           "Since the newest complete backup began; without one, since the daemon did.", *gauges.backup_age_seconds);
    single(text, "driftlab_backup_period_seconds", "gauge", "Between two backups by the timer; 0: only when asked.",
           gauges.backup_period_seconds);
  }
  single(text, "driftlab_blobs_damaged", "gauge", "Stored files that are damaged and could not be healed.",
         gauges.blobs_damaged);
  single(text, "driftlab_blobs_healed_total", "counter", "Columns made anew from the uploaded bytes.",
         gauges.blobs_healed);
  single(text, "driftlab_scrubbed_bytes_total", "counter", "Stored bytes read back in the background.",
         gauges.scrubbed_bytes);
  single(text, "driftlab_log_lines_dropped_total", "counter", "Log lines that nobody took in time.",
         gauges.log_lines_dropped);
  single(text, "driftlab_resident_memory_bytes", "gauge", "Memory of the process.", gauges.resident_bytes);
  single(text, "driftlab_cpu_seconds_total", "counter", "CPU time of the process.", gauges.cpu_seconds);
  return text;
}

}  // namespace driftlab::server
