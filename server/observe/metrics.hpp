#pragma once
/// What the daemon counts, in the text format of Prometheus (version 0.0.4).
///
/// Names begin with `driftlab_`, units are base units, counters end in `_total`. Labels come from closed sets (route
/// templates, methods, classes of status, job kinds, outcomes), never from what clients send, so that the number of
/// series is bounded. Thread safe.
#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace driftlab::server {

/// What is true at the moment of a scrape.
struct Gauges {
  double ready = 0.0;
  double connections = 0.0;
  double idle_connections = 0.0;
  double uploads = 0.0;
  double requests_in_flight = 0.0;
  double turned_away = 0.0;  ///< a counter kept elsewhere
  double devices = 0.0;
  double recordings = 0.0;
  double jobs_queued = 0.0;
  double jobs_running = 0.0;
  double deliveries_waiting = 0.0;
  double webhooks_disabled = 0.0;
  double oldest_queued_seconds = 0.0;
  double free_bytes = 0.0;
  double free_fraction = 0.0;
  double blob_bytes = 0.0;
  double log_pages = 0.0;  ///< of the database's write-ahead log
  /// How long writes to the store took: a histogram kept elsewhere.
  struct Writes {
    std::vector<std::pair<double, std::uint64_t>> buckets;  ///< upper bound [s], cumulative count
    std::uint64_t count = 0;
    double seconds = 0.0;
  };
  Writes writes;
  /// What is wrong, from closed sets: every state with every cause.
  struct State {
    std::string_view state;
    std::string_view cause;
    double count = 0.0;
  };
  std::vector<State> bad_states;
  /// Of the newest complete one; where there is none, since the daemon began. Nothing: none are made.
  std::optional<double> backup_age_seconds;
  double backup_period_seconds = 0.0;  ///< of the timer; 0: only when asked
  double blobs_damaged = 0.0;
  double blobs_healed = 0.0;       ///< a counter kept elsewhere
  double scrubbed_bytes = 0.0;     ///< a counter kept elsewhere
  double log_lines_dropped = 0.0;  ///< a counter kept elsewhere
  double resident_bytes = 0.0;
  double cpu_seconds = 0.0;  ///< a counter kept elsewhere
  double started_at = 0.0;   ///< [s since 1970]
};

class Metrics {
 public:
  /// One answered request. `route` is a template; empty: none matched. `seconds`: those that the daemon took, not those
  /// that the client sent its body in, asked to wait for, or let a stream go on.
  void count_request(std::string_view method, std::string_view route, int status, double seconds,
                     std::uint64_t bytes_in, std::uint64_t bytes_out);
  /// One attempt at a job that ended: `succeeded`, `failed`, `retried`, `dead`, `cancelled`, `released`,
  /// `lost`.
  void count_attempt(std::string_view kind, std::string_view outcome, double seconds);

  /// Parts of a job of that kind that were computed for the worker which runs it.
  void count_helped(std::string_view kind, int parts);
  /// One attempt at a delivery to a webhook that ended: `delivered`, `failed`, `given_up`.
  void count_delivery(std::string_view outcome);

  /// Everything, ready to be sent.
  [[nodiscard]] std::string text(const Gauges& gauges, std::string_view version) const;

 private:
  /// Cumulative counts by upper bound.
  template <std::size_t N>
  struct Histogram {
    std::array<std::uint64_t, N> counts{};
    std::uint64_t count = 0;
    double sum = 0.0;
  };
  static constexpr std::array<double, 9> kRequestBounds{0.001, 0.005, 0.025, 0.1, 0.5, 1.0, 5.0, 30.0, 120.0};
  static constexpr std::array<double, 8> kJobBounds{0.1, 1.0, 10.0, 60.0, 300.0, 1800.0, 7200.0, 21600.0};

  template <std::size_t N>
  static void observe(Histogram<N>& histogram, const std::array<double, N>& bounds, double value);
  template <std::size_t N>
  static void write(std::string& text, std::string_view name, const std::string& labels, const Histogram<N>& histogram,
                    const std::array<double, N>& bounds);

  mutable std::mutex mutex_;
  std::map<std::tuple<std::string, std::string, std::string>, std::uint64_t> requests_;  ///< method, route, class
  std::map<std::string, Histogram<9>> request_seconds_;                                  ///< by route
  std::uint64_t bytes_in_ = 0;
  std::uint64_t bytes_out_ = 0;
  std::map<std::pair<std::string, std::string>, std::uint64_t> attempts_;  ///< kind, outcome
  std::map<std::string, std::uint64_t, std::less<>> helped_;               ///< kind
  std::map<std::string, std::uint64_t, std::less<>> deliveries_;           ///< by outcome
  std::map<std::string, Histogram<8>> job_seconds_;                        ///< by kind
};

}  // namespace driftlab::server
