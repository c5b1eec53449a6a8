#include "server/store/sqlite/tables.hpp"

namespace driftlab::server::tables {
namespace {

constexpr std::string_view kSelect = "SELECT id, device_id, unique_key, document_json, created_at FROM calibrations";
constexpr std::string_view kById =
    "SELECT id, device_id, unique_key, document_json, created_at FROM calibrations WHERE id = ?";
constexpr std::string_view kByKey =
    "SELECT id, device_id, unique_key, document_json, created_at FROM calibrations WHERE unique_key = ?";
constexpr std::string_view kInsert =
    "INSERT INTO calibrations (id, device_id, unique_key, document_json, created_at) VALUES (?, ?, ?, ?, ?)";

StoredCalibration read_calibration(const Statement& row) {
  return {row.text(0), row.text(1), row.text(2), row.text(3), row.integer(4)};
}

}  // namespace

Result<Store::CalibrationOutcome> add_calibration(Connection& connection, const StoredCalibration& calibration,
                                                  UtcMicros now) {
  Statement statement = connection.prepare(kByKey);
  statement.bind(calibration.unique_key);
  Result<std::vector<StoredCalibration>> existing = all_rows(statement, read_calibration);  // one at most
  if (!existing) {
    return fail(existing.error());
  }
  if (!existing->empty()) {
    return Store::CalibrationOutcome{std::move(existing->front()), false};
  }
  StoredCalibration made = calibration;
  made.id = make_id("cal", now);
  made.created_at = now;
  Status inserted = connection.prepare(kInsert)
                        .bind(made.id, made.device_id, made.unique_key, made.document_json, made.created_at)
                        .run();
  if (!inserted) {
    return fail(inserted.error());
  }
  return Store::CalibrationOutcome{std::move(made), true};
}

Result<StoredCalibration> calibration(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kById);
  statement.bind(id);
  return one_row(statement, read_calibration,
                 {ErrorCode::NotFound,
                  "There is no calibration \"" + std::string(id) + "\".",
                  {{"calibration", std::string(id)}}});
}

Result<std::vector<StoredCalibration>> calibrations(Connection& connection, const std::optional<std::string>& device_id,
                                                    const Page& page) {
  FilteredQuery query(kSelect);
  query.where("device_id = ?", device_id);
  return query.visible(page, "device_id").read_page(connection, page, read_calibration);
}

}  // namespace driftlab::server::tables
