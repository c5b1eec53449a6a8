#pragma once
/// What each method of the store does inside a transaction: one source file per resource, with its SQL texts on top.
///
/// Functions take the connection of a running transaction; those that write take the time as `now`. Contracts are those
/// of the methods of the same name in server/store/store.hpp.
#include "core/signal/result.hpp"
#include "core/signal/text.hpp"
#include "server/store/sql/connection.hpp"
#include "server/store/sql/seals.hpp"
#include "server/store/store.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server::tables {

// ---- helpers for the row readers of each file: one returns the row, or a Result where the row has a seal

template <class Read>
struct RowRead {
  using Row = Read;
};
template <class Sound>
struct RowRead<Result<Sound>> {
  using Row = Sound;
};
template <class Read>
using RowOf = typename RowRead<Read>::Row;

/// The present row as `read` finds it.
template <class Read>
[[nodiscard]] Result<RowOf<Read>> present_row(const Statement& statement, Read (*read)(const Statement&)) {
  return read(statement);
}

/// The first row of a query, read by `read`; nothing without rows.
template <class Read>
[[nodiscard]] Result<std::optional<RowOf<Read>>> first_row(Statement& statement, Read (*read)(const Statement&)) {
  const Result<bool> row = statement.step();
  if (!row || !*row) {
    return row ? Result<std::optional<RowOf<Read>>>(std::nullopt) : fail(row.error());
  }
  return present_row(statement, read).map([](RowOf<Read> found) { return std::optional(std::move(found)); });
}

/// The first row of a query; `absent` where there is none.
template <class Read>
[[nodiscard]] Result<RowOf<Read>> one_row(Statement& statement, Read (*read)(const Statement&), Error absent) {
  const Result<bool> row = statement.step();
  if (!row) {
    return fail(row.error());
  }
  if (!*row) {
    return fail(std::move(absent));
  }
  return present_row(statement, read);
}

/// Every row of a query.
template <class Read>
[[nodiscard]] Result<std::vector<RowOf<Read>>> all_rows(Statement& statement, Read (*read)(const Statement&)) {
  std::vector<RowOf<Read>> rows;
  while (true) {
    const Result<bool> row = statement.step();
    if (!row) {
      return fail(row.error());
    }
    if (!*row) {
      return rows;
    }
    Result<RowOf<Read>> found = present_row(statement, read);
    if (!found) {
      return fail(std::move(found.error()));
    }
    rows.push_back(std::move(*found));
  }
}

/// The jobs that a caller limited to devices sees: those asked for by its token (first value), and those that name only
/// devices of its list (second value, a JSON list of names).
constexpr std::string_view kVisibleJob =
    "(EXISTS (SELECT 1 FROM owners WHERE object_id = jobs.id AND token_id = ?) OR (EXISTS (SELECT 1 FROM job_devices "
    "WHERE job_id = jobs.id) AND NOT EXISTS (SELECT 1 FROM job_devices JOIN devices ON devices.id = "
    "job_devices.device_id WHERE job_id = jobs.id AND devices.name NOT IN (SELECT value FROM json_each(?)))))";

/// A SELECT with those conditions that a filter asks for. Texts are constants of our own; values are bound.
class FilteredQuery {
 public:
  explicit FilteredQuery(std::string_view select) : sql_(select) {}
  /// Adds `condition`, for example "device_id = ?", if there is a value.
  void where(std::string_view condition, const std::optional<std::string>& value) {
    if (value) {
      where(condition);
      values_.push_back(*value);
    }
  }
  /// Rows of one value, if there is a value, where an index of (column, id) has them one behind the other. The only
  /// such column leads the order of the page with PostgreSQL. Ordered by the id alone its plan may walk all rows of the
  /// table in the hope that those of the value stand everywhere among them; rows of a campaign do not.
  void along(std::string_view column, const std::optional<std::string>& value) {
    if (value) {
      along_.emplace_back(column, *value);
    }
  }
  /// Rows made at that time or later: their ids, which begin with `prefix`, say when.
  void made_since(std::string_view prefix, const std::optional<UtcMicros>& since) {
    where("id >= ?", since ? std::optional(first_id(prefix, *since)) : std::nullopt);
  }
  /// Keeps rows whose `columns` contain a text, in upper or lower case of ASCII letters. The pattern, in which any
  /// character stands for one that patterns are made of, lets an index of trigrams find them.
  void holds(std::string_view columns, const std::optional<std::string>& text) {
    const std::string lower = "lower(" + std::string(columns) + ")";
    by_values_ = by_values_ || text;
    where(lower + " LIKE ?", text ? std::optional(pattern_of(*text)) : std::nullopt);
    where("instr(" + lower + ", lower(?)) > 0", text);
  }
  void where(std::string_view condition) {
    sql_.append(first_ ? " WHERE " : " AND ").append(condition);
    first_ = false;
  }
  /// For a caller limited to devices (Page::visible), keeps the rows that belong to one of them. `column` holds the
  /// device's id. A page for such a caller is read only after this call or one of its variants below.
  FilteredQuery& visible(const Page& page, std::string_view column) {
    if (page.visible) {
      where(std::string(column) + " IN (SELECT id FROM devices WHERE name IN (SELECT value FROM json_each(?)))",
            page.visible->devices_json);
    }
    guarded_ = true;
    return *this;
  }
  /// The same for objects that may belong to no device: who asked for one sees it too.
  FilteredQuery& visible_or_own(const Page& page, std::string_view column, std::string_view id) {
    if (page.visible) {
      where("(" + std::string(column) +
                " IN (SELECT id FROM devices WHERE name IN (SELECT value FROM json_each(?))) OR EXISTS (SELECT 1 FROM "
                "owners WHERE object_id = " +
                std::string(id) + " AND token_id = ?))",
            page.visible->devices_json);
      values_.push_back(page.visible->token);
    }
    guarded_ = true;
    return *this;
  }
  /// The same for jobs, which name any number of devices.
  FilteredQuery& visible_jobs(const Page& page) {
    if (page.visible) {
      where(kVisibleJob, page.visible->token);
      values_.push_back(page.visible->devices_json);
    }
    guarded_ = true;
    return *this;
  }
  /// Ends the query as a keyset page over `id` and reads it. Errors: Internal where the page is for a caller limited to
  /// devices and the query does not say what such a caller sees.
  template <class Read>
  [[nodiscard]] Result<std::vector<RowOf<Read>>> read_page(Connection& connection, const Page& page,
                                                           Read (*read)(const Statement&)) {
    if (page.visible && !guarded_) {
      return fail(ErrorCode::Internal, "A list does not say what a token limited to devices sees of it.");
    }
    const bool has_lead =
        along_.size() == 1 && page.order != PageOrder::ByName && connection.engine() == Engine::Postgres;
    for (const auto& [column, value] : along_) {
      if (!has_lead) {
        where(column + " = ?", value);
      }
    }
    switch (page.order) {
      case PageOrder::OldestFirst:
        order_by_id(page.after, " > ", "", has_lead);
        break;
      case PageOrder::NewestFirst:
        order_by_id(page.after, " < ", " DESC", has_lead);
        break;
      case PageOrder::ByName:
        if (!page.after.empty()) {
          where("(name, id) > (?, ?)", page.after_name);
          values_.push_back(page.after);
        }
        sql_.append(" ORDER BY name, id");
        break;
    }
    sql_.append(" LIMIT ?");
    if (by_values_) {
      Statement planned = connection.prepare(kPlanByValues);
      if (const Status set = planned.run(); !set) {
        return fail(set.error());
      }
    }
    Statement statement = connection.prepare(sql_);
    for (const std::string& value : values_) {
      statement.bind(value);
    }
    statement.bind(page.limit);
    return all_rows(statement, read);
  }

 private:
  /// What comes behind the last row of the page before, if there was one, by the leading column and the id.
  void order_by_id(const std::string& after, std::string_view behind, std::string_view direction, bool has_lead) {
    std::string key = "id";
    std::string order = key;
    std::string last = "?";
    if (has_lead) {
      const auto& [column, value] = along_.front();
      where(column + " >= ?", value);
      where(column + " <= ?", value);  // were it said to be equal, it would be left out of the order
      key = "(" + column + ", id)";
      order = column + std::string(direction) + ", id";
      last = "(?, ?)";
    }
    if (!after.empty()) {
      where(key + std::string(behind) + last);
      if (has_lead) {
        values_.push_back(along_.front().second);
      }
      values_.push_back(after);
    }
    sql_.append(" ORDER BY ").append(order).append(direction);
  }

  [[nodiscard]] static std::string pattern_of(std::string_view text) {
    std::string pattern = "%" + lower_case(text) + "%";
    std::replace_if(
        pattern.begin() + 1, pattern.end() - 1, [](char c) { return c == '%' || c == '_' || c == '\\'; }, '_');
    return pattern;
  }

  /// Whether an index of trigrams finds few rows or the page is soon full by itself depends on what is sought: for this
  /// transaction PostgreSQL plans by the values, where it would take to one plan for all after five times.
  static constexpr EngineTexts kPlanByValues{"SELECT 1",
                                             "SELECT set_config('plan_cache_mode', 'force_custom_plan', true)"};

  std::string sql_;
  std::vector<std::string> values_;
  std::vector<std::pair<std::string, std::string>> along_;  ///< columns and the values that they equal
  bool by_values_ = false;
  bool first_ = true;
  bool guarded_ = false;
};

// ---- devices
[[nodiscard]] Result<Store::DeviceOutcome> ensure_device(Connection& connection, const Device& device, UtcMicros now);
[[nodiscard]] Result<Device> device(Connection& connection, std::string_view id_or_name);
[[nodiscard]] Result<std::vector<Device>> devices(Connection& connection, const DeviceFilter& filter, const Page& page);
[[nodiscard]] Result<Device> update_device(Connection& connection, std::string_view id, const DeviceChange& change,
                                           std::int64_t expected_revision, UtcMicros now);

// ---- blobs and recordings
[[nodiscard]] Result<std::optional<Blob>> blob(Connection& connection, std::string_view sha256);
[[nodiscard]] Result<RecordingOutcome> add_recording(Connection& connection, const Blob& blob,
                                                     const Recording& recording, UtcMicros now);
[[nodiscard]] Result<DeviceUsage> usage_of(Connection& connection, std::string_view device_id, std::string_view sha256);
[[nodiscard]] Result<DeviceUsage> usage_of_token(Connection& connection, std::string_view token,
                                                 std::string_view sha256);
/// Bytes of all blobs, as uploaded.
[[nodiscard]] Result<std::int64_t> blob_bytes(Connection& connection);
[[nodiscard]] Result<Recording> recording(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<Recording>> recordings_of(Connection& connection, const std::vector<std::string>& ids);
[[nodiscard]] Result<std::vector<Recording>> recordings(Connection& connection, const RecordingFilter& filter,
                                                        const Page& page);
[[nodiscard]] Result<Counts> counts(Connection& connection, const std::optional<Visibility>& visible);
[[nodiscard]] Result<EndedCounts> ended_since(Connection& connection, UtcMicros since,
                                              const std::optional<Visibility>& visible);
[[nodiscard]] Result<DeviceOverviews> overviews(Connection& connection, const std::vector<std::string>& device_ids,
                                                const std::optional<Visibility>& visible);
[[nodiscard]] Result<int> settle_recordings(Connection& connection);
/// Adds up some of what changes have added to amounts (migration 0028); SQLite has one row of each. Whether there may
/// be more.
[[nodiscard]] Result<bool> settle_amounts(Connection& connection);
[[nodiscard]] Result<Recording> revise_recording(Connection& connection, const Recording& changed,
                                                 std::int64_t expected_revision, UtcMicros now);
[[nodiscard]] Status remove_recording(Connection& connection, std::string_view id, std::int64_t expected_revision,
                                      UtcMicros now);
[[nodiscard]] Result<std::vector<std::string>> blob_hashes(Connection& connection);
[[nodiscard]] Result<bool> remove_unused_blob(Connection& connection, std::string_view sha256);

// ---- jobs: asking and looking
[[nodiscard]] Result<EnqueuedJob> enqueue(Connection& connection, const NewJob& job, UtcMicros now);
/// Without its attempts, whether it is damaged or not.
[[nodiscard]] Result<Job> job(Connection& connection, std::string_view id);
/// With them, if it and they are what was written. Error: damaged_row.
[[nodiscard]] Result<Job> sound_job(Connection& connection, std::string_view id);
[[nodiscard]] Result<int> forget_ended_jobs(Connection& connection, UtcMicros before);
[[nodiscard]] Result<std::vector<Job>> jobs(Connection& connection, const JobFilter& filter, const Page& page);
[[nodiscard]] Result<std::vector<JobEvent>> events_after(Connection& connection, std::string_view job_id,
                                                         std::int64_t sequence, int limit);
/// Writes the job's present state into its history. `type`: "state" or "progress". A state that ends the job also
/// queues what webhooks are told of it (webhook_tables.hpp).
[[nodiscard]] Status add_event(Connection& connection, std::string_view job_id, std::string_view type, UtcMicros now);

// ---- jobs: working
[[nodiscard]] Result<std::optional<Job>> claim(Connection& connection, std::int64_t lease_micros,
                                               std::int64_t running_per_token, const std::vector<KnownKind>& known,
                                               UtcMicros now);
[[nodiscard]] Result<LeaseStatus> renew(Connection& connection, const Lease& lease, std::int64_t lease_micros,
                                        UtcMicros now);
[[nodiscard]] Result<LeaseStatus> report_progress(Connection& connection, const Lease& lease, std::string_view stage,
                                                  double progress, UtcMicros now);
[[nodiscard]] Result<LeaseStatus> succeed(Connection& connection, const Lease& lease, const JobResults& results,
                                          UtcMicros now);
[[nodiscard]] Result<LeaseStatus> fail_attempt(Connection& connection, const Lease& lease,
                                               const AttemptFailure& failure, std::mt19937_64& jitter, UtcMicros now);
[[nodiscard]] Result<LeaseStatus> acknowledge_cancel(Connection& connection, const Lease& lease, UtcMicros now);
[[nodiscard]] Result<LeaseStatus> release(Connection& connection, const Lease& lease, UtcMicros now);
[[nodiscard]] Result<Job> request_cancel(Connection& connection, std::string_view id, UtcMicros now);
/// Puts back every running job whose lease ends at `now` or before; with nothing for `deadline`: every running job.
[[nodiscard]] Result<int> end_leases(Connection& connection, std::optional<UtcMicros> deadline, UtcMicros now);

// ---- results
[[nodiscard]] Status insert_results(Connection& connection, std::string_view job_id, const JobResults& results,
                                    UtcMicros now);
[[nodiscard]] Result<std::string> result_document(Connection& connection, std::string_view job_id);
[[nodiscard]] Result<Fit> fit(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<Fit>> fits(Connection& connection, const FitFilter& filter, const Page& page);
[[nodiscard]] Result<std::vector<ChannelResult>> latest_channel_results(Connection& connection,
                                                                        std::string_view device_id,
                                                                        std::string_view quantity,
                                                                        std::string_view axis);
[[nodiscard]] Result<std::vector<std::string>> axes_with_results(Connection& connection, std::string_view device_id,
                                                                 std::string_view quantity);
/// The ids alone of the latest results of an axis.
[[nodiscard]] Result<std::vector<std::string>> latest_result_ids(Connection& connection, const SensorAxis& axis);

// ---- what results come to
[[nodiscard]] Result<std::vector<ResultVerdict>> verdicts(Connection& connection, const VerdictFilter& filter,
                                                          const Page& page);
/// The columns of a verdict, and one of them as it was read.
#define DRIFTLAB_VERDICT_COLUMNS                                                                                      \
  "id, job_id, (SELECT kind FROM jobs WHERE jobs.id = verdicts.job_id), coalesce(device_id, ''), "                    \
  "coalesce(recording_id, ''), channel, level, verdict, coalesce((SELECT investigations.id FROM investigations "      \
  "WHERE investigations.job_id = verdicts.job_id), ''), coalesce((SELECT devices.name FROM devices WHERE devices.id " \
  "= verdicts.device_id), ''), created_at, seal"
[[nodiscard]] Result<ResultVerdict> read_verdict(const Statement& row);
/// After the job's result document. What was said before of the recordings that they speak of is forgotten.
[[nodiscard]] Status insert_verdicts(Connection& connection, std::string_view job_id, const JobResults& results,
                                     UtcMicros now);

// ---- pooling of the results of an axis
/// Makes the row of each axis name its latest results: what pooled others is cancelled, a job for these queued. How
/// many were queued.
/// Marks the results that stand for these axes.
[[nodiscard]] Status show_results(Connection& connection, const std::vector<SensorAxis>& axes);
/// Glances of some results that lack theirs, and the marks of their axes. How many; 0: none lacks it.
[[nodiscard]] Result<int> keep_glances(Connection& connection, const GlanceOf& glance_of);
[[nodiscard]] Result<int> refresh_pools(Connection& connection, const std::vector<SensorAxis>& axes, UtcMicros now);
[[nodiscard]] Result<int> queue_missing_pools(Connection& connection, UtcMicros now);
/// Named axes that have results of one job, of one recording.
/// Axes of the recordings of a job's results, those without a name among them.
[[nodiscard]] Result<std::vector<SensorAxis>> axes_of_job(Connection& connection, std::string_view job_id);
[[nodiscard]] Result<std::vector<SensorAxis>> axes_of_recording(Connection& connection, std::string_view recording_id);
/// Whether the results that the job was to pool are still the latest of their axis.
[[nodiscard]] Result<bool> pools_latest(Connection& connection, std::string_view job_id);
[[nodiscard]] Result<AxisResults> axis_results(Connection& connection, const SensorAxis& axis);
[[nodiscard]] Result<std::optional<PooledArtefact>> pooled_artefact(Connection& connection, const SensorAxis& axis,
                                                                    std::string_view name);

// ---- studies
[[nodiscard]] Result<Store::StudyOutcome> add_study(Connection& connection, const Study& study, UtcMicros now);
[[nodiscard]] Result<Study> study(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<Study>> studies(Connection& connection, const std::optional<std::string>& device_id,
                                                 const Page& page);

// ---- drives
[[nodiscard]] Result<Store::DriveOutcome> add_drive(Connection& connection, const StoredDrive& drive, UtcMicros now);
[[nodiscard]] Result<StoredDrive> drive(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<StoredDrive>> drives(Connection& connection,
                                                      const std::optional<std::string>& device_id, const Page& page);

// ---- calibrations
[[nodiscard]] Result<Store::CalibrationOutcome> add_calibration(Connection& connection,
                                                                const StoredCalibration& calibration, UtcMicros now);
[[nodiscard]] Result<StoredCalibration> calibration(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<StoredCalibration>> calibrations(Connection& connection,
                                                                  const std::optional<std::string>& device_id,
                                                                  const Page& page);

// ---- models and investigations
[[nodiscard]] Result<Store::ModelOutcome> add_model(Connection& connection, const Model& model, UtcMicros now);
[[nodiscard]] Result<Model> model(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<Model>> models(Connection& connection, const ModelFilter& filter, const Page& page);
[[nodiscard]] Result<Investigation> investigation(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<Investigation>> investigations(Connection& connection,
                                                                const InvestigationFilter& filter, const Page& page);
/// After the job's result document.
[[nodiscard]] Status insert_investigations(Connection& connection, std::string_view job_id, const JobResults& results,
                                           UtcMicros now);

// ---- regression runs
[[nodiscard]] Result<Anchor> add_anchor(Connection& connection, const Anchor& anchor, UtcMicros now);
[[nodiscard]] Result<std::vector<Anchor>> anchors(Connection& connection, const std::optional<std::string>& device_id,
                                                  const Page& page);
/// After the job's result document.
[[nodiscard]] Status insert_artefacts(Connection& connection, std::string_view job_id, const JobResults& results);
[[nodiscard]] Result<std::string> artefact(Connection& connection, std::string_view job_id, std::string_view name);

// ---- removing what others may depend on
[[nodiscard]] Status remove_device(Connection& connection, std::string_view id, std::int64_t expected_revision);
[[nodiscard]] Status remove_study(Connection& connection, std::string_view id);
[[nodiscard]] Status remove_calibration(Connection& connection, std::string_view id);
[[nodiscard]] Status remove_model(Connection& connection, std::string_view id);
[[nodiscard]] Status remove_investigation(Connection& connection, std::string_view id);

// ---- idempotency
[[nodiscard]] Result<std::optional<IdempotentReply>> idempotent_reply(Connection& connection, std::string_view key,
                                                                      UtcMicros now);
[[nodiscard]] Status remember_reply(Connection& connection, const IdempotentReply& reply, UtcMicros now);
[[nodiscard]] Result<int> forget_old_replies(Connection& connection, UtcMicros now);

}  // namespace driftlab::server::tables
