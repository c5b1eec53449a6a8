#include "server/store/sql/seals.hpp"

#include "server/store/digest.hpp"

#include <algorithm>
#include <ranges>
#include <span>

namespace driftlab::server {
namespace {

/// Each value with its length before it, so that no letter can move from one to the next unnoticed.
class Seal {
 public:
  void add(std::string_view text) {
    const std::string length = std::to_string(text.size()) + ":";
    digest_.update(std::as_bytes(std::span(length)));
    digest_.update(std::as_bytes(std::span(text)));
  }
  void add(const std::string& text) { add(std::string_view(text)); }
  void add(std::int64_t number) { add(std::to_string(number)); }
  void add(int number) { add(std::int64_t{number}); }
  void add(const std::optional<std::int64_t>& number) { add(number ? std::to_string(*number) : std::string()); }
  [[nodiscard]] std::string finish() { return digest_.finish(); }

 private:
  Sha256 digest_;
};

template <class... Values>
std::string sealed(const Values&... values) {
  Seal seal;
  (seal.add(values), ...);
  return seal.finish();
}

template <class Texts>
std::string joined(const Texts& parts, std::string_view between) {
  std::string text;
  for (const auto& part : parts) {
    text.append(text.empty() ? std::string_view() : between).append(part);
  }
  return text;
}

std::size_t count_of(std::string_view columns) {
  return static_cast<std::size_t>(std::ranges::count(columns, ',')) + 1;
}

std::vector<std::string> texts_of(const Statement& row, std::size_t first, std::size_t count) {
  std::vector<std::string> texts;
  for (std::size_t i = first; i < first + count; ++i) {
    texts.push_back(row.text(static_cast<int>(i)));
  }
  return texts;
}

/// Whether the row of that key has a seal that does not fit; one that is gone has none.
Result<bool> has_wrong_seal(Connection& connection, const SealedTable& table, const std::vector<std::string>& key) {
  std::string text = "SELECT " + std::string(table.seal) + ", " + std::string(table.columns) + " FROM " +
                     std::string(table.name) + " WHERE ";
  for (std::size_t i = 0; i < key.size(); ++i) {
    text.append(i > 0 ? " AND " : "").append(table.key[i]).append(" = ?");
  }
  Statement statement = connection.prepare(text);
  for (const std::string& part : key) {
    statement.bind(part);
  }
  Result<bool> found = statement.step();
  if (!found || !*found) {
    return found;
  }
  const std::vector<std::string> values = texts_of(statement, 1, count_of(table.columns));
  return !seal_fits(statement.text(0), seal_of_texts({values.begin(), values.end()}));
}

}  // namespace

// The columns of a table, and below the members of its row: in the same order.
const std::vector<SealedTable>& sealed_tables() {
  static const std::vector<SealedTable> tables = {
      {"devices", "device", {"id"}, "id, name, model, imu, serial, labels_json, revision"},
      {"blobs", "file", {"sha256"}, "sha256, bytes, format, compression, row_count, columns_json, notes_json"},
      {"recordings",
       "recording",
       {"id"},
       "id, device_id, blob_sha256, revision, metadata_json, condition, quality_json, tags_json, tags_revision, "
       "file_name, name"},
      {"jobs", "job", {"id"}, "id, kind, request_json"},
      {"jobs",
       "job",
       {"id"},
       "id, state, stage, priority, attempt, failures, cancel_requested, created_at, started_at, finished_at, "
       "problem_json",
       "end_seal",
       "finished_at IS NOT NULL"},
      {"job_attempts",
       "failed attempt",
       {"job_id", "CAST(attempt AS TEXT)"},
       "job_id, attempt, started_at, failed_at, fault_signal, problem_json"},
      {"job_results", "result", {"job_id"}, "job_id, document_json"},
      {"channel_results",
       "result of a channel",
       {"id"},
       "id, job_id, device_id, recording_id, recording_revision, channel, quantity, axis, condition, document_json, "
       "settings_json, glance_json, glance_level"},
      {"fits",
       "fit",
       {"id"},
       "id, channel_result_id, job_id, device_id, recording_id, recording_revision, channel, quantity, axis, "
       "condition, model, rank, document_json"},
      {"studies", "study", {"id"}, "id, device_id, unique_key, document_json"},
      {"drives", "drive", {"id"}, "id, device_id, unique_key, document_json"},
      {"calibrations", "calibration", {"id"}, "id, device_id, unique_key, document_json"},
      {"models", "model", {"id"}, "id, parent_id, device_id, unique_key, name, document_json, provenance_json"},
      {"investigations",
       "investigation",
       {"id"},
       "id, job_id, device_id, study_id, baseline_id, model_id, summary_json, page"},
      {"verdicts", "verdict", {"id"}, "id, job_id, recording_id, channel, level, verdict"},
      {"anchors", "anchor", {"id"}, "id, device_id, label, reason, settings_json"},
      {"artefacts", "file of a result", {"job_id", "name"}, "job_id, name, content"},
      {"idempotent_replies", "reply", {"key"}, "key, method, target, body_sha256, status, headers_json, body"},
      {"tokens", "token", {"id"}, "id, name, scope, devices_json, secret_sha256, created_at, expires_at, revoked_at"},
      {"webhooks", "webhook", {"id"}, "id, url, description, events_json, secret, previous_secret"},
  };
  return tables;
}

std::string seal_of(const Device& d) {
  return sealed(d.id, d.name, d.model, d.imu, d.serial, d.labels_json, d.revision);
}

std::string seal_of(const Blob& b) {
  return sealed(b.sha256, b.bytes, b.format, b.compression, b.rows, b.columns_json, b.notes_json);
}

std::string seal_of(const Recording& r) {
  return sealed(r.id, r.device_id, r.blob_sha256, r.revision, r.metadata_json, r.condition, r.quality_json, r.tags_json,
                r.tags_revision, r.file_name, r.name);
}

std::string seal_of(const Job& j) { return sealed(j.id, j.kind, j.request_json); }

std::string end_seal_of(const Job& j) {
  return sealed(j.id, name_of(j.state), j.stage, j.priority, j.attempt, j.failures, j.cancel_requested ? 1 : 0,
                j.created_at, j.started_at, j.finished_at, j.problem_json);
}

std::string seal_of(const ChannelResult& c) {
  return sealed(c.id, c.job_id, c.device_id, c.recording_id, c.recording_revision, c.channel, c.quantity, c.axis,
                c.condition, c.document_json, c.settings_json, c.glance.json, c.glance.level);
}

std::string seal_of(const Fit& f) {
  return sealed(f.id, f.channel_result_id, f.job_id, f.device_id, f.recording_id, f.recording_revision, f.channel,
                f.quantity, f.axis, f.condition, f.model, f.rank, f.document_json);
}

std::string seal_of(const Study& s) { return sealed(s.id, s.device_id, s.unique_key, s.document_json); }

std::string seal_of(const StoredDrive& d) { return sealed(d.id, d.device_id, d.unique_key, d.document_json); }

std::string seal_of(const StoredCalibration& c) { return sealed(c.id, c.device_id, c.unique_key, c.document_json); }

std::string seal_of(const Model& m) {
  return sealed(m.id, m.parent_id, m.device_id, m.unique_key, m.name, m.document_json, m.provenance_json);
}

std::string seal_of(const Investigation& i) {
  return sealed(i.id, i.job_id, i.device_id, i.study_id, i.baseline_id, i.model_id, i.summary_json, i.page);
}

std::string seal_of(const ResultVerdict& v) {
  return sealed(v.id, v.job_id, v.recording_id, v.channel, v.level, v.verdict);
}

std::string seal_of(const Anchor& a) { return sealed(a.id, a.device_id, a.label, a.reason, a.settings_json); }

std::string seal_of(const IdempotentReply& r) {
  return sealed(r.key, r.method, r.target, r.body_sha256, r.status, r.headers_json, r.body);
}

std::string seal_of_texts(const std::vector<std::string_view>& texts) {
  Seal seal;
  for (const std::string_view text : texts) {
    seal.add(text);
  }
  return seal.finish();
}

Result<std::string> sound_text(std::string_view table, std::vector<std::string> texts, const std::string& seal) {
  if (!seal_fits(seal, seal_of_texts({texts.begin(), texts.end()}))) {
    const std::vector<std::string> key(texts.begin(), texts.end() - 1);
    return fail(damaged_in(table, joined(key, "/")));
  }
  return std::move(texts.back());
}

Error damaged_in(std::string_view table, std::string_view key) {
  return damaged_row(table, sealed_table(table).noun, key);
}

const SealedTable& sealed_table(std::string_view name) {
  const auto& tables = sealed_tables();
  const auto found = std::ranges::find(tables, name, &SealedTable::name);
  return found != tables.end() ? *found : tables.front();
}

Result<ReadBack> read_back(Connection& connection, const SealedTable& table, const std::vector<std::string>& after,
                           int limit) {
  const std::size_t keys = table.key.size();
  const std::string key = joined(table.key, ", ");
  std::string text = "SELECT " + key + ", " + std::string(table.seal) + ", " + std::string(table.columns) + " FROM " +
                     std::string(table.name);
  if (!after.empty()) {
    text += " WHERE (" + key + ") > (" + joined(std::vector<std::string_view>(keys, "?"), ", ") + ")";
  }
  Statement statement = connection.prepare(text + " ORDER BY " + key + " LIMIT ?");
  for (const std::string& part : after) {
    statement.bind(part);
  }
  statement.bind(limit);
  ReadBack read;
  while (true) {
    const Result<bool> row = statement.step();
    if (!row) {
      return fail(row.error());
    }
    if (!*row) {
      return read;
    }
    read.last = texts_of(statement, 0, keys);
    const std::string seal = statement.text(static_cast<int>(keys));
    const std::vector<std::string> values = texts_of(statement, keys + 1, count_of(table.columns));
    ++read.rows;
    for (const std::string& value : values) {
      read.bytes += static_cast<std::int64_t>(value.size());
    }
    if (!seal_fits(seal, seal_of_texts({values.begin(), values.end()}))) {
      read.damaged.push_back(damaged_row_of(damaged_row(table.name, table.noun, joined(read.last, "/"))));
    }
  }
}

Result<std::optional<bool>> is_damaged(Connection& connection, std::string_view row) {
  std::vector<std::string> key;
  for (const auto part : std::views::split(row, '/')) {
    key.emplace_back(part.begin(), part.end());
  }
  const std::string name = key.front();
  key.erase(key.begin());
  std::optional<bool> damaged;
  for (const SealedTable& table : sealed_tables()) {
    if (table.name != name || table.key.size() != key.size()) {
      continue;
    }
    const Result<bool> one = has_wrong_seal(connection, table, key);
    if (!one) {
      return fail(one.error());
    }
    damaged = damaged.value_or(false) || *one;
  }
  return damaged;
}

Result<int> seal_rows(Connection& connection, const SealedTable& table, int limit) {
  const std::size_t keys = table.key.size();
  const std::string name(table.name);
  const std::string unsealed = std::string(table.seal) + " = ''";
  std::vector<std::vector<std::string>> sealed_rows;  // the seal, then the key
  {
    Statement statement =
        connection.prepare("SELECT " + joined(table.key, ", ") + ", " + std::string(table.columns) + " FROM " + name +
                           " WHERE " + unsealed + " AND " + std::string(table.when) + " LIMIT ?");
    statement.bind(limit);
    while (true) {
      const Result<bool> row = statement.step();
      if (!row) {
        return fail(row.error());
      }
      if (!*row) {
        break;
      }
      const std::vector<std::string> values = texts_of(statement, keys, count_of(table.columns));
      std::vector<std::string> made = texts_of(statement, 0, keys);
      made.insert(made.begin(), seal_of_texts({values.begin(), values.end()}));
      sealed_rows.push_back(std::move(made));
    }
  }
  std::string update = "UPDATE " + name + " SET " + std::string(table.seal) + " = ? WHERE " + unsealed;
  for (const std::string_view part : table.key) {
    update.append(" AND ").append(part).append(" = ?");
  }
  for (const std::vector<std::string>& values : sealed_rows) {
    Statement statement = connection.prepare(update);
    for (const std::string& value : values) {
      statement.bind(value);
    }
    if (Status done = statement.run(); !done) {
      return fail(done.error());
    }
  }
  return static_cast<int>(sealed_rows.size());
}

Status run_and_seal(Connection& connection, std::string_view table, Statement& change) {
  constexpr int kMost = 1000;
  if (Status changed = change.run(); !changed) {
    return changed;
  }
  const Result<int> sealed = seal_rows(connection, sealed_table(table), kMost);
  return sealed ? Status{} : fail(sealed.error());
}

}  // namespace driftlab::server
