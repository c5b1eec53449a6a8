#include "server/store/sql/tables.hpp"

namespace driftlab::server::tables {
namespace {

#define DRIFTLAB_INVESTIGATION_COLUMNS \
  "id, job_id, device_id, study_id, baseline_id, model_id, summary_json, page, created_at, seal"

constexpr std::string_view kSelect = "SELECT " DRIFTLAB_INVESTIGATION_COLUMNS " FROM investigations";
constexpr std::string_view kById = "SELECT " DRIFTLAB_INVESTIGATION_COLUMNS " FROM investigations WHERE id = ?";
constexpr std::string_view kSought =
    "(SELECT devices.name FROM devices WHERE devices.id = device_id) || ' ' || id || ' ' || summary_json";
constexpr std::string_view kInsert =
    "INSERT INTO investigations (" DRIFTLAB_INVESTIGATION_COLUMNS ") VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";

Result<Investigation> read_investigation(const Statement& row) {
  Investigation investigation;
  investigation.id = row.text(0);
  investigation.job_id = row.text(1);
  investigation.device_id = row.text(2);
  investigation.study_id = row.text(3);
  investigation.baseline_id = row.text(4);
  investigation.model_id = row.text(5);
  investigation.summary_json = row.text(6);
  investigation.page = row.text(7);
  investigation.created_at = row.integer(8);
  return sound_row("investigations", row.text(0), std::move(investigation), row.text(9));
}

}  // namespace

Status insert_investigations(Connection& connection, std::string_view job_id, const JobResults& results,
                             UtcMicros now) {
  for (const Model& model : results.models) {
    if (auto added = add_model(connection, model, now); !added) {
      return fail(added.error());
    }
  }
  for (Investigation made : results.investigations) {
    made.id = made.id.empty() ? make_id("inv", now) : made.id;
    made.job_id = job_id;
    Status inserted = connection.prepare(kInsert)
                          .bind(made.id, made.job_id, made.device_id, made.study_id, made.baseline_id, made.model_id,
                                made.summary_json, made.page, now, seal_of(made))
                          .run();
    if (!inserted) {
      return inserted;
    }
  }
  return {};
}

Result<Investigation> investigation(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kById);
  statement.bind(id);
  return one_row(statement, read_investigation,
                 {ErrorCode::NotFound,
                  "There is no investigation \"" + std::string(id) + "\".",
                  {{"investigation", std::string(id)}}});
}

Result<std::vector<Investigation>> investigations(Connection& connection, const InvestigationFilter& filter,
                                                  const Page& page) {
  FilteredQuery query(kSelect);
  query.where("device_id = ?", filter.device_id);
  query.where("study_id = ?", filter.study_id);
  query.where("job_id = ?", filter.job_id);
  query.holds(kSought, filter.text);
  query.made_since("inv", filter.since);
  return query.visible(page, "device_id").read_page(connection, page, read_investigation);
}

}  // namespace driftlab::server::tables
