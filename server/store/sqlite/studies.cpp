#include "server/store/sqlite/tables.hpp"

namespace driftlab::server::tables {
namespace {

constexpr std::string_view kSelect = "SELECT id, device_id, unique_key, document_json, created_at FROM studies";
constexpr std::string_view kById =
    "SELECT id, device_id, unique_key, document_json, created_at FROM studies WHERE id = ?";
constexpr std::string_view kByKey =
    "SELECT id, device_id, unique_key, document_json, created_at FROM studies WHERE unique_key = ?";
constexpr std::string_view kInsert =
    "INSERT INTO studies (id, device_id, unique_key, document_json, created_at) VALUES (?, ?, ?, ?, ?)";

Study read_study(const Statement& row) {
  Study study;
  study.id = row.text(0);
  study.device_id = row.text(1);
  study.unique_key = row.text(2);
  study.document_json = row.text(3);
  study.created_at = row.integer(4);
  return study;
}

}  // namespace

Result<Store::StudyOutcome> add_study(Connection& connection, const Study& study, UtcMicros now) {
  Statement statement = connection.prepare(kByKey);
  statement.bind(study.unique_key);
  Result<std::vector<Study>> existing = all_rows(statement, read_study);  // one at most
  if (!existing) {
    return fail(existing.error());
  }
  if (!existing->empty()) {
    return Store::StudyOutcome{std::move(existing->front()), false};
  }
  Study made = study;
  made.id = study.id.empty() ? make_id("stu", now) : study.id;
  made.created_at = now;
  Status inserted = connection.prepare(kInsert)
                        .bind(made.id, made.device_id, made.unique_key, made.document_json, made.created_at)
                        .run();
  if (!inserted) {
    return fail(inserted.error());
  }
  return Store::StudyOutcome{std::move(made), true};
}

Result<Study> study(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kById);
  statement.bind(id);
  return one_row(statement, read_study,
                 {ErrorCode::NotFound, "There is no study \"" + std::string(id) + "\".", {{"study", std::string(id)}}});
}

Result<std::vector<Study>> studies(Connection& connection, const std::optional<std::string>& device_id,
                                   const Page& page) {
  FilteredQuery query(kSelect);
  query.where("device_id = ?", device_id);
  return query.visible(page, "device_id").read_page(connection, page, read_study);
}

}  // namespace driftlab::server::tables
