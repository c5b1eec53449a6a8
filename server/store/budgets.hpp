#pragma once
/// Every budget of the daemon: the limits of one client, one document, one job, or all of them together.
///
/// This list is the one place where they are stated. Each is enforced before its cost arises, and what is refused says
/// which budget refused it. They are set by `--budget NAME=VALUE`, `DRIFTLAB_BUDGET_NAME` or the table `[budgets]` of
/// the configuration file; `driftlabd config` prints those in force, and schema/docs/budgets.md explains them (a test
/// compares the three).
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// BUDGET(name, default, least, most, meaning). The end of a name is its unit; a name without one counts things.
// clang-format off
#define DRIFTLAB_BUDGETS(BUDGET)                                                                                        \
  /* connections */                                                                                                     \
  BUDGET(connections, 1024, 1, 100'000, "Connections open at once; beyond it the one idle longest is closed")           \
  BUDGET(connections_per_address, 64, 1, 100'000,                                                                       \
         "Connections of one address; this machine and named proxies are exempt")                                       \
  BUDGET(requests_per_connection, 100, 1, 1'000'000, "Requests answered before a connection is closed")                 \
  BUDGET(idle_seconds, 60, 1, 86'400, "A connection may wait so long for its next request")                             \
  BUDGET(header_seconds, 10, 1, 600, "A request's header must be complete in this time")                                \
  BUDGET(header_bytes, 16'384, 1024, 1'048'576, "Size of a request's header")                                           \
  BUDGET(target_bytes, 8192, 256, 1'048'576, "Length of a request's target")                                            \
  BUDGET(body_stall_seconds, 30, 1, 600, "A body may stand still so long")                                              \
  BUDGET(body_bytes_per_second, 65'536, 0, 1'000'000'000, "A body longer than the time above must be this fast")        \
  BUDGET(write_stall_seconds, 60, 1, 3600, "A client may take nothing of its answer for so long")                       \
  BUDGET(send_buffer_bytes, 262'144, 4096, 67'108'864, "What the kernel holds of an answer that is not taken")          \
  BUDGET(requests_waiting, 256, 1, 100'000, "Requests that wait for a thread; beyond it 503")                           \
  BUDGET(requests_per_token, 32, 1, 100'000, "Requests of one token under way at once; beyond it 429")                  \
  /* documents */                                                                                                       \
  BUDGET(document_bytes, 1'048'576, 1024, 67'108'864, "Size of a JSON document that is sent")                           \
  BUDGET(page_bytes, 4'194'304, 4096, 268'435'456, "Size of a page of a list; one larger item comes alone")             \
  BUDGET(answer_cache_bytes, 33'554'432, 0, 17'179'869'184, "Answers kept until a row of the store changes; 0: none")    \
  BUDGET(look_bytes, 1'073'741'824, 4096, 1'099'511'627'776, "Memory of a spectrum, histogram or spectrogram, 24 a row") \
  BUDGET(labels, 64, 0, 10'000, "Labels of a device")                                                                   \
  BUDGET(label_bytes, 256, 1, 65'536, "Length of a label's name, and of its value")                                     \
  BUDGET(name_bytes, 256, 1, 65'536, "Length of a name")                                                                \
  BUDGET(note_bytes, 4096, 1, 1'048'576, "Length of a reason or another sentence by people")                            \
  /* uploads */                                                                                                         \
  BUDGET(upload_bytes, 8'589'934'592, 1, 1'099'511'627'776, "Size of an upload")                                        \
  BUDGET(uploads, 16, 1, 10'000, "Uploads at once")                                                                     \
  BUDGET(uploads_waiting, 1024, 0, 1'000'000, "Uploads that wait for a place, their bodies unread; beyond it 503")       \
  BUDGET(upload_wait_seconds, 60, 0, 3600, "An upload that has waited this long for a place gets 503")                  \
  BUDGET(uploads_per_address, 4, 1, 10'000, "Uploads of one address at once; this machine is exempt")                   \
  BUDGET(decodings, 16, 1, 256, "Uploads decoded at once, each on a thread of its own")                                 \
  BUDGET(decode_seconds, 60, 1, 86'400, "Time to decode an upload, beside that for its size")                           \
  BUDGET(decode_bytes_per_second, 1'048'576, 1024, 1'000'000'000'000, "For its size: an upload must decode this fast")  \
  BUDGET(columns_allowance_bytes, 134'217'728, 4096, 1'099'511'627'776, "Columns that any upload may become")           \
  BUDGET(columns_ratio, 200, 1, 100'000, "Bytes of columns that each byte of an upload may become beside that")         \
  BUDGET(notes_per_recording, 64, 1, 100'000, "Notes kept about a recording's file; the rest is counted")               \
  BUDGET(live_recordings, 256, 0, 100'000, "Live recordings that are not finished; beyond it 503")                      \
  BUDGET(live_recordings_per_token, 32, 0, 100'000, "Of these, those that one token began; beyond it 429")              \
  /* tokens: each secret that comes is compared with them all */                                                        \
  BUDGET(tokens, 1000, 1, 100'000, "Tokens that are valid")                                                             \
  BUDGET(tokens_ever, 10'000, 1, 1'000'000, "Tokens with those revoked or expired")                                     \
  /* what is kept */                                                                                                    \
  BUDGET(recordings_per_device, 100'000, 1, 1'000'000'000, "Recordings of a device")                                    \
  BUDGET(device_bytes, 1'099'511'627'776, 4096, 9'000'000'000'000'000, "Bytes uploaded for a device")                   \
  BUDGET(recordings_per_token, 1'000'000, 1, 1'000'000'000, "Recordings that one token has uploaded")                    \
  BUDGET(token_bytes, 10'995'116'277'760, 4096, 9'000'000'000'000'000, "Bytes that one token has uploaded")              \
  BUDGET(reply_bytes, 65'536, 0, 67'108'864, "Of an answer kept for its Idempotency-Key; a longer one is read again")   \
  BUDGET(least_free_bytes, 268'435'456, 0, 1'099'511'627'776, "Free on the disk, or uploads and jobs are refused")      \
  BUDGET(reserve_bytes, 16'777'216, 0, 1'099'511'627'776, "Kept in a file so that deleting works on a full disk")       \
  BUDGET(orphan_hours, 24, 0, 8760, "Files without a row are removed after this time; at once on a full disk")          \
  BUDGET(keep_jobs_days, 0, 0, 36'500, "Ended jobs without results are removed after this time; 0 keeps them")          \
  BUDGET(keep_recordings_days, 0, 0, 36'500, "Recordings and their results are removed after this time; 0 keeps them")  \
  /* jobs */                                                                                                            \
  BUDGET(job_memory_bytes, 0, 0, 9'000'000'000'000, "Memory of all running jobs; 0 is half of what the machine has")    \
  BUDGET(job_seconds, 21'600, 1, 31'536'000, "A job is ended after this time")                                          \
  BUDGET(running_jobs_per_token, 8, 1, 10'000, "Jobs of one token that run at once; the others of it wait")              \
  BUDGET(queued_jobs, 10'000, 1, 10'000'000, "Jobs that wait; beyond it 503")                                           \
  BUDGET(scrub_bytes_per_second, 8'388'608, 0, 1'000'000'000'000, "Stored files read again in the background; 0: none") \
  /* webhooks */                                                                                                        \
  BUDGET(webhooks, 32, 0, 10'000, "Webhooks")                                                                           \
  BUDGET(webhook_waiting, 10'000, 1, 10'000'000, "Deliveries of a webhook that wait; beyond it it is disabled")         \
  BUDGET(webhook_deliveries, 4, 1, 64, "Deliveries under way at once")                                                  \
  BUDGET(webhook_seconds, 15, 1, 600, "A receiver must have answered in this time")                                     \
  BUDGET(webhook_attempts, 8, 1, 100, "Attempts at a delivery before it is given up")                                   \
  BUDGET(webhook_pause_milliseconds, 5000, 1, 3'600'000, "Pause after the first attempt; six times as long each time")  \
  BUDGET(webhook_give_ups, 3, 1, 1000, "Deliveries given up in a row before the webhook is disabled")                   \
  BUDGET(keep_deliveries_days, 30, 1, 36'500, "Deliveries that ended are listed for this time")                         \
  /* the end */                                                                                                         \
  BUDGET(stop_seconds, 10, 1, 600, "From SIGTERM to the end")                                                           \
  BUDGET(drain_milliseconds, 500, 0, 600'000, "Of that, not ready but still answering, for load balancers to notice")
// clang-format on

namespace driftlab::server {

/// The budgets in force.
struct Budgets {
#define DRIFTLAB_DECLARE_BUDGET(name, value, least, most, meaning) std::int64_t name = value;
  DRIFTLAB_BUDGETS(DRIFTLAB_DECLARE_BUDGET)
#undef DRIFTLAB_DECLARE_BUDGET
};

/// The default budgets.
[[nodiscard]] inline const Budgets& default_budgets() {
  static const Budgets budgets;
  return budgets;
}

/// What there is to know about one.
struct Budget {
  std::string_view name;
  std::int64_t Budgets::* value;
  std::int64_t least;
  std::int64_t most;
  std::string_view meaning;
};

/// Every budget once, in the order above.
[[nodiscard]] inline const std::vector<Budget>& all_budgets() {
#define DRIFTLAB_LIST_BUDGET(name, value, least, most, meaning) {#name, &Budgets::name, least, most, meaning},
  static const std::vector<Budget> all{DRIFTLAB_BUDGETS(DRIFTLAB_LIST_BUDGET)};
#undef DRIFTLAB_LIST_BUDGET
  return all;
}

/// The one that is kept in that member.
[[nodiscard]] inline const Budget& budget_of(std::int64_t Budgets::* value) {
  return *std::find_if(all_budgets().begin(), all_budgets().end(),
                       [value](const Budget& budget) { return budget.value == value; });
}

/// The end of every refusal: "(budget page_bytes = 4194304)".
[[nodiscard]] inline std::string naming_budget(std::string_view name, std::int64_t value) {
  return "(budget " + std::string(name) + " = " + std::to_string(value) + ")";
}

}  // namespace driftlab::server
