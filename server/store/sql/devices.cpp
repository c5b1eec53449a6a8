#include "server/store/sql/tables.hpp"

namespace driftlab::server::tables {
namespace {

constexpr std::string_view kSelect =
    "SELECT id, name, model, imu, serial, labels_json, revision, created_at, updated_at, seal FROM devices";
constexpr std::string_view kByIdOrName =
    "SELECT id, name, model, imu, serial, labels_json, revision, created_at, updated_at, seal FROM devices "
    "WHERE id = ?1 OR name = ?1 ORDER BY id = ?1 DESC LIMIT 1";
constexpr std::string_view kByName =
    "SELECT id, name, model, imu, serial, labels_json, revision, created_at, updated_at, seal FROM devices WHERE name "
    "= ?";
constexpr std::string_view kById =
    "SELECT id, name, model, imu, serial, labels_json, revision, created_at, updated_at, seal FROM devices WHERE id = "
    "?";
constexpr std::string_view kInsert =
    "INSERT INTO devices (id, name, model, imu, serial, labels_json, revision, created_at, updated_at, seal) "
    "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";
constexpr std::string_view kUpdate =
    "UPDATE devices SET model = ?2, imu = ?3, serial = ?4, labels_json = ?5, revision = ?6, updated_at = ?7, "
    "seal = ?8 WHERE id = ?1";
constexpr std::string_view kSought = "name || ' ' || model || ' ' || imu || ' ' || serial || ' ' || id";

Result<Device> read_device(const Statement& row) {
  Device device;
  device.id = row.text(0);
  device.name = row.text(1);
  device.model = row.text(2);
  device.imu = row.text(3);
  device.serial = row.text(4);
  device.labels_json = row.text(5);
  device.revision = row.integer(6);
  device.created_at = row.integer(7);
  device.updated_at = row.integer(8);
  return sound_row("devices", row.text(0), std::move(device), row.text(9));
}

Result<Device> one_device(Connection& connection, std::string_view sql, std::string_view value) {
  Statement statement = connection.prepare(sql);
  statement.bind(value);
  return one_row(
      statement, read_device,
      {ErrorCode::NotFound, "There is no device \"" + std::string(value) + "\".", {{"device", std::string(value)}}});
}

}  // namespace

Result<Store::DeviceOutcome> ensure_device(Connection& connection, const Device& device, UtcMicros now) {
  if (device.name.empty()) {
    return fail(ErrorCode::InvalidArgument, "A device needs a name.", {{"parameter", "name"}});
  }
  Result<Device> existing = one_device(connection, kByName, device.name);
  if (existing) {
    return Store::DeviceOutcome{std::move(*existing), false};
  }
  if (existing.error().code != ErrorCode::NotFound) {
    return fail(existing.error());
  }
  Device made = device;
  if (made.id.empty()) {
    made.id = make_id("dev", now);
  }
  made.revision = 1;
  made.created_at = now;
  made.updated_at = now;
  Status inserted = connection.prepare(kInsert)
                        .bind(made.id, made.name, made.model, made.imu, made.serial, made.labels_json, made.revision,
                              made.created_at, made.updated_at, seal_of(made))
                        .run();
  if (!inserted) {
    return fail(inserted.error());
  }
  return Store::DeviceOutcome{std::move(made), true};
}

Result<Device> device(Connection& connection, std::string_view id_or_name) {
  return one_device(connection, kByIdOrName, id_or_name);
}

Result<std::vector<Device>> devices(Connection& connection, const DeviceFilter& filter, const Page& page) {
  FilteredQuery query(kSelect);
  query.holds(kSought, filter.text);
  return query.visible(page, "id").read_page(connection, page, read_device);
}

Result<Device> update_device(Connection& connection, std::string_view id, const DeviceChange& change,
                             std::int64_t expected_revision, UtcMicros now) {
  Result<Device> found = one_device(connection, kById, id);
  if (!found) {
    return found;
  }
  Device changed = std::move(*found);
  if (changed.revision != expected_revision) {
    return fail(ErrorCode::Conflict, "The device was changed by somebody else in the meantime.",
                {{"revision", std::to_string(changed.revision)}});
  }
  changed.model = change.model.value_or(changed.model);
  changed.imu = change.imu.value_or(changed.imu);
  changed.serial = change.serial.value_or(changed.serial);
  changed.labels_json = change.labels_json.value_or(changed.labels_json);
  changed.revision += 1;
  changed.updated_at = now;
  Status updated = connection.prepare(kUpdate)
                       .bind(changed.id, changed.model, changed.imu, changed.serial, changed.labels_json,
                             changed.revision, changed.updated_at, seal_of(changed))
                       .run();
  if (!updated) {
    return fail(updated.error());
  }
  return changed;
}

}  // namespace driftlab::server::tables
