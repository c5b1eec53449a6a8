/// How statements run: one by one, or several in one message by the pipeline mode of libpq.
///
/// The connection is in that mode only while a message is under way, which ends with a Sync: whatever the outcome, the
/// server has then answered all of it and waits, within its time limits, for what comes next. What it answers to
/// statements without rows is far less than what was sent, and libpq reads while it cannot write, so that neither side
/// waits for the other with full buffers. https://www.postgresql.org/docs/15/libpq-pipeline-mode.html
#include "server/store/postgres/connection.hpp"

#include <charconv>
#include <cstring>

namespace driftlab::server {
namespace {

constexpr std::size_t kMostHeld = 512;
constexpr std::size_t kMostHeldBytes = 1U << 20U;
constexpr const char* kUnanswered = "08006";

/// By which a statement is prepared: the same text with other types is another one.
std::string key_of(const BoundStatement& statement) {
  std::string key = statement.sql;
  for (const BoundValue& value : statement.values) {
    key.append(1, '\n').append(std::to_string(value.type));
  }
  return key;
}

std::vector<Oid> types_of(const BoundStatement& statement) {
  std::vector<Oid> types;
  types.reserve(statement.values.size());
  for (const BoundValue& value : statement.values) {
    types.push_back(value.type);
  }
  return types;
}

std::vector<const char*> texts_of(const BoundStatement& statement) {
  std::vector<const char*> texts;
  texts.reserve(statement.values.size());
  for (const BoundValue& value : statement.values) {
    texts.push_back(value.type == 0 ? nullptr : value.text.c_str());
  }
  return texts;
}

std::size_t bytes_of(const BoundStatement& statement) {
  std::size_t bytes = 0;
  for (const BoundValue& value : statement.values) {
    bytes += value.text.size();
  }
  return bytes;
}

}  // namespace

Result<PostgresResult> PostgresConnection::accept_run(PostgresResult result) {
  auto accepted = accept(std::move(result));
  if (accepted) {
    const char* const count = PQcmdTuples(accepted->get());
    changes_ = 0;
    (void)std::from_chars(count, count + std::strlen(count), changes_);
  }
  return accepted;
}

Error PostgresConnection::lose(const std::string& reason) {
  lost_ = true;
  failure_ = failure_.empty() ? kUnanswered : failure_;
  return postgres_error(kUnanswered, reason, name_);
}

/// What is to be answered, one by one; nothing where libpq does not take it.
std::optional<std::vector<PostgresConnection::Expected>> PostgresConnection::send_together(
    std::span<const BoundStatement> statements) {
  std::unordered_map<std::string, std::string> fresh;
  std::vector<Expected> expected;
  bool sent = PQenterPipelineMode(handle_) == 1;
  for (std::size_t i = 0; sent && i < statements.size(); ++i) {
    const BoundStatement& statement = statements[i];
    const auto count = static_cast<int>(statement.values.size());
    std::string key = key_of(statement);
    const auto kept = prepared_.find(key);
    std::string& name = kept != prepared_.end() ? kept->second : fresh[key];
    if (name.empty()) {
      name = "s" + std::to_string(names_++);
      sent = PQsendPrepare(handle_, name.c_str(), numbered_parameters(statement.sql).c_str(), count,
                           types_of(statement).data()) == 1;
      expected.push_back({i, std::move(key), name});
    }
    sent = sent && PQsendQueryPrepared(handle_, name.c_str(), count, texts_of(statement).data(), nullptr, nullptr, 0);
    expected.push_back({i, {}, {}});
  }
  return sent && PQpipelineSync(handle_) == 1 ? std::optional(std::move(expected)) : std::nullopt;
}

/// The next result; none stands between those of two statements, once. No result: the connection is of no use any more.
PostgresResult PostgresConnection::next_result() {
  PostgresResult result(PQgetResult(handle_));
  return result ? std::move(result) : PostgresResult(PQgetResult(handle_));
}

/// The result of the last one. The first `held` were held back. One that fails ends all behind it.
Result<PostgresResult> PostgresConnection::run_together(std::span<const BoundStatement> statements, std::size_t held) {
  const auto expected = send_together(statements);
  if (!expected) {
    return fail(lose(PQerrorMessage(handle_)));
  }
  Result<PostgresResult> outcome = PostgresResult();
  for (const Expected& answer : *expected) {
    PostgresResult result = next_result();
    if (!outcome && PQresultStatus(result.get()) == PGRES_PIPELINE_ABORTED) {
      continue;
    }
    const bool runs = answer.prepares.empty();
    auto taken = runs ? accept_run(std::move(result)) : accept(std::move(result));
    if (!taken) {
      outcome = fail(taken.error());
      held_failure_ = answer.statement < held && !held_failure_ ? std::optional(taken.error()) : held_failure_;
      if (is_broken()) {
        return outcome;
      }
    } else if (runs) {
      outcome = std::move(taken);
    } else {
      prepared_.emplace(answer.prepares, answer.name);
    }
  }
  if (PQresultStatus(next_result().get()) != PGRES_PIPELINE_SYNC || PQexitPipelineMode(handle_) != 1) {
    return fail(lose(PQerrorMessage(handle_)));
  }
  return outcome;
}

Result<PostgresResult> PostgresConnection::run(BoundStatement statement) {
  if (held_.empty()) {
    if (const auto kept = prepared_.find(key_of(statement)); kept != prepared_.end()) {
      return accept_run(
          PostgresResult(PQexecPrepared(handle_, kept->second.c_str(), static_cast<int>(statement.values.size()),
                                        texts_of(statement).data(), nullptr, nullptr, 0)));
    }
  }
  std::vector<BoundStatement> statements = std::move(held_);
  held_.clear();
  held_bytes_ = 0;
  const std::size_t held = statements.size();
  statements.push_back(std::move(statement));
  return run_together(statements, held);
}

Status PostgresConnection::run_for_no_rows(BoundStatement statement) {
  if (!holds_) {
    const auto result = run(std::move(statement));
    return result ? Status{} : fail(result.error());
  }
  held_bytes_ += bytes_of(statement);
  held_.push_back(std::move(statement));
  return held_.size() < kMostHeld && held_bytes_ < kMostHeldBytes ? Status{} : settle();
}

Status PostgresConnection::settle(Status outcome) {
  if (outcome && !held_.empty()) {
    const std::vector<BoundStatement> statements = std::move(held_);
    held_.clear();
    held_bytes_ = 0;
    const auto last = run_together(statements, statements.size());
    outcome = last ? Status{} : fail(last.error());
  }
  return held_failure_ ? fail(*held_failure_) : outcome;
}

}  // namespace driftlab::server
