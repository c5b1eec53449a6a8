/// Documents that belong to a device and never change: studies, drives, calibrations. Each kind has a table of its own,
/// all of the same columns, with one row for each unique key.
#include "server/store/sql/tables.hpp"

namespace driftlab::server::tables {
namespace {

constexpr std::string_view kColumns = "id, device_id, unique_key, document_json, created_at, seal";

template <class Row>
Result<Row> read_document(const Statement& row, std::string_view table) {
  return sound_row(table, row.text(0), Row{row.text(0), row.text(1), row.text(2), row.text(3), row.integer(4)},
                   row.text(5));
}

Result<Study> read_study(const Statement& row) { return read_document<Study>(row, "studies"); }
Result<StoredDrive> read_drive(const Statement& row) { return read_document<StoredDrive>(row, "drives"); }
Result<StoredCalibration> read_calibration(const Statement& row) {
  return read_document<StoredCalibration>(row, "calibrations");
}

/// A kind of document: `Row` holds a column in each of its members.
template <class Row>
struct DocumentTable {
  std::string_view name;
  std::string_view prefix;  ///< of its ids
  std::string_view noun;

  [[nodiscard]] std::string select() const { return "SELECT " + std::string(kColumns) + " FROM " + std::string(name); }

  Result<Row> (*read)(const Statement&);

  /// The row of the document's unique key, inserted if absent. `Outcome` is the row and whether it was made.
  template <class Outcome>
  Result<Outcome> add(Connection& connection, const Row& document, UtcMicros now) const {
    Statement statement = connection.prepare(select() + " WHERE unique_key = ?");
    statement.bind(document.unique_key);
    Result<std::vector<Row>> existing = all_rows(statement, read);  // one at most
    if (!existing) {
      return fail(existing.error());
    }
    if (!existing->empty()) {
      return Outcome{std::move(existing->front()), false};
    }
    Row made = document;
    made.id = document.id.empty() ? make_id(prefix, now) : document.id;
    made.created_at = now;
    Status inserted =
        connection
            .prepare("INSERT INTO " + std::string(name) + " (" + std::string(kColumns) + ") VALUES (?, ?, ?, ?, ?, ?)")
            .bind(made.id, made.device_id, made.unique_key, made.document_json, made.created_at, seal_of(made))
            .run();
    if (!inserted) {
      return fail(inserted.error());
    }
    return Outcome{std::move(made), true};
  }

  [[nodiscard]] Result<Row> find(Connection& connection, std::string_view id) const {
    Statement statement = connection.prepare(select() + " WHERE id = ?");
    statement.bind(id);
    const std::string what(noun);
    return one_row(
        statement, read,
        {ErrorCode::NotFound, "There is no " + what + " \"" + std::string(id) + "\".", {{what, std::string(id)}}});
  }

  [[nodiscard]] Result<std::vector<Row>> list(Connection& connection, const std::optional<std::string>& device_id,
                                              const Page& page) const {
    FilteredQuery query(select());
    query.where("device_id = ?", device_id);
    return query.visible(page, "device_id").read_page(connection, page, read);
  }
};

constexpr DocumentTable<Study> kStudies{"studies", "stu", "study", read_study};
constexpr DocumentTable<StoredDrive> kDrives{"drives", "drv", "drive", read_drive};
constexpr DocumentTable<StoredCalibration> kCalibrations{"calibrations", "cal", "calibration", read_calibration};

}  // namespace

Result<Store::StudyOutcome> add_study(Connection& connection, const Study& study, UtcMicros now) {
  return kStudies.add<Store::StudyOutcome>(connection, study, now);
}

Result<Study> study(Connection& connection, std::string_view id) { return kStudies.find(connection, id); }

Result<std::vector<Study>> studies(Connection& connection, const std::optional<std::string>& device_id,
                                   const Page& page) {
  return kStudies.list(connection, device_id, page);
}

Result<Store::DriveOutcome> add_drive(Connection& connection, const StoredDrive& drive, UtcMicros now) {
  return kDrives.add<Store::DriveOutcome>(connection, drive, now);
}

Result<StoredDrive> drive(Connection& connection, std::string_view id) { return kDrives.find(connection, id); }

Result<std::vector<StoredDrive>> drives(Connection& connection, const std::optional<std::string>& device_id,
                                        const Page& page) {
  return kDrives.list(connection, device_id, page);
}

Result<Store::CalibrationOutcome> add_calibration(Connection& connection, const StoredCalibration& calibration,
                                                  UtcMicros now) {
  return kCalibrations.add<Store::CalibrationOutcome>(connection, calibration, now);
}

Result<StoredCalibration> calibration(Connection& connection, std::string_view id) {
  return kCalibrations.find(connection, id);
}

Result<std::vector<StoredCalibration>> calibrations(Connection& connection, const std::optional<std::string>& device_id,
                                                    const Page& page) {
  return kCalibrations.list(connection, device_id, page);
}

}  // namespace driftlab::server::tables
