#include "server/store/sql/tables.hpp"

namespace driftlab::server::tables {
namespace {

constexpr std::string_view kSelectAnchors =
    "SELECT id, device_id, label, reason, created_at, settings_json, seal FROM anchors";
constexpr std::string_view kInsertAnchor =
    "INSERT INTO anchors (id, device_id, label, reason, created_at, settings_json, seal) VALUES (?, ?, ?, ?, ?, ?, ?)";
constexpr std::string_view kInsertArtefact = "INSERT INTO artefacts (job_id, name, content, seal) VALUES (?, ?, ?, ?)";
constexpr std::string_view kArtefact =
    "SELECT job_id, name, content, seal FROM artefacts WHERE job_id = ? AND name = ?";

Result<Anchor> read_anchor(const Statement& row) {
  return sound_row("anchors", row.text(0),
                   Anchor{row.text(0), row.text(1), row.text(2), row.text(3), row.integer(4), row.text(5)},
                   row.text(6));
}

Result<std::string> read_content(const Statement& row) {
  return sound_text("artefacts", {row.text(0), row.text(1), row.text(2)}, row.text(3));
}

}  // namespace

Result<Anchor> add_anchor(Connection& connection, const Anchor& anchor, UtcMicros now) {
  Anchor made = anchor;
  made.id = make_id("anc", now);
  made.created_at = now;
  Status inserted =
      connection.prepare(kInsertAnchor)
          .bind(made.id, made.device_id, made.label, made.reason, made.created_at, made.settings_json, seal_of(made))
          .run();
  return inserted ? Result<Anchor>(std::move(made)) : fail(inserted.error());
}

Result<std::vector<Anchor>> anchors(Connection& connection, const std::optional<std::string>& device_id,
                                    const Page& page) {
  FilteredQuery query(kSelectAnchors);
  query.where("device_id = ?", device_id);
  return query.visible(page, "device_id").read_page(connection, page, read_anchor);
}

Status insert_artefacts(Connection& connection, std::string_view job_id, const JobResults& results) {
  for (const Artefact& artefact : results.artefacts) {
    if (Status inserted =
            connection.prepare(kInsertArtefact)
                .bind(job_id, artefact.name, artefact.content, seal_of_texts({job_id, artefact.name, artefact.content}))
                .run();
        !inserted) {
      return inserted;
    }
  }
  return {};
}

Result<std::string> artefact(Connection& connection, std::string_view job_id, std::string_view name) {
  Statement statement = connection.prepare(kArtefact);
  statement.bind(job_id, name);
  return one_row(statement, read_content,
                 {ErrorCode::NotFound,
                  "The job " + std::string(job_id) + " has no " + std::string(name) + ".",
                  {{"job", std::string(job_id)}}});
}

}  // namespace driftlab::server::tables
