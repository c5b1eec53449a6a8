#include "server/store/sql/tables.hpp"

namespace driftlab::server::tables {
namespace {

#define DRIFTLAB_MODEL_COLUMNS \
  "id, parent_id, device_id, unique_key, name, document_json, provenance_json, created_at, seal"

constexpr std::string_view kSelect = "SELECT " DRIFTLAB_MODEL_COLUMNS " FROM models";
constexpr std::string_view kById = "SELECT " DRIFTLAB_MODEL_COLUMNS " FROM models WHERE id = ?";
constexpr std::string_view kByKey = "SELECT " DRIFTLAB_MODEL_COLUMNS " FROM models WHERE unique_key = ?";
constexpr std::string_view kInsert =
    "INSERT INTO models (" DRIFTLAB_MODEL_COLUMNS ") VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)";

std::optional<std::string> some(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional<std::string>(text);
}

Result<Model> read_model(const Statement& row) {
  Model model;
  model.id = row.text(0);
  model.parent_id = row.text(1);
  model.device_id = row.text(2);
  model.unique_key = row.text(3);
  model.name = row.text(4);
  model.document_json = row.text(5);
  model.provenance_json = row.text(6);
  model.created_at = row.integer(7);
  return sound_row("models", row.text(0), std::move(model), row.text(8));
}

}  // namespace

Result<Store::ModelOutcome> add_model(Connection& connection, const Model& model, UtcMicros now) {
  Statement statement = connection.prepare(kByKey);
  statement.bind(model.unique_key);
  Result<std::optional<Model>> existing = first_row(statement, read_model);
  if (!existing) {
    return fail(existing.error());
  }
  if (std::optional<Model>& found = *existing) {
    return Store::ModelOutcome{std::move(*found), false};
  }
  if (!model.parent_id.empty()) {
    if (Result<Model> parent = tables::model(connection, model.parent_id); !parent) {
      return fail(Error(parent.error()).with("parent", model.parent_id));
    }
  }
  Model made = model;
  made.id = model.id.empty() ? make_id("mod", now) : model.id;
  made.created_at = now;
  Status inserted = connection.prepare(kInsert)
                        .bind(made.id, some(made.parent_id), some(made.device_id), made.unique_key, made.name,
                              made.document_json, made.provenance_json, made.created_at, seal_of(made))
                        .run();
  if (!inserted) {
    return fail(inserted.error());
  }
  return Store::ModelOutcome{std::move(made), true};
}

Result<Model> model(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kById);
  statement.bind(id);
  return one_row(statement, read_model,
                 {ErrorCode::NotFound, "There is no model \"" + std::string(id) + "\".", {{"model", std::string(id)}}});
}

Result<std::vector<Model>> models(Connection& connection, const ModelFilter& filter, const Page& page) {
  FilteredQuery query(kSelect);
  query.where("device_id = ?", filter.device_id);
  query.where("parent_id = ?", filter.parent_id);
  query.holds("name || ' ' || id", filter.text);
  return query.visible_or_own(page, "device_id", "models.id").read_page(connection, page, read_model);
}

}  // namespace driftlab::server::tables
