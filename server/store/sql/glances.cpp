/// What a list of devices shows of each: which result stands for an axis is marked in the transaction that changes the
/// results of the axis, so that a page of the list reads the marked rows alone, whatever else is stored.
#include "server/store/sql/filtered_query.hpp"
#include "server/store/sql/tables.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>

namespace driftlab::server::tables {
namespace {

constexpr int kGlancesAtOnce = 100;

constexpr std::string_view kUnmark =
    "UPDATE channel_results SET shown = 0 WHERE device_id = ? AND quantity = ? AND axis = ? AND shown = 1";
constexpr std::string_view kMark =
    "UPDATE channel_results SET shown = 1 WHERE sequence = (SELECT r.sequence FROM channel_results AS r "
    "WHERE r.device_id = ? AND r.quantity = ? AND r.axis = ? AND r.glance_json NOT IN ('', 'null') AND NOT EXISTS "
    "(SELECT 1 FROM channel_results AS later WHERE later.recording_id = r.recording_id AND later.channel = r.channel "
    "AND later.sequence > r.sequence) ORDER BY CASE WHEN r.condition = 'static' THEN r.glance_level ELSE -1 END DESC, "
    "r.sequence LIMIT 1)";
constexpr std::string_view kUnseen =
    "SELECT id, document_json, device_id, quantity, axis FROM channel_results WHERE glance_json = '' ORDER BY sequence "
    "LIMIT ?";
/// The row is sealed anew with all others that have no seal.
constexpr std::string_view kSee =
    "UPDATE channel_results SET glance_json = ?2, glance_level = ?3, seal = '' WHERE id = ?1";

/// Each reads, of the devices that it ends with, all at once.
constexpr std::string_view kConditions = "SELECT device_id, condition, count(*) FROM recordings WHERE device_id IN (";
constexpr std::string_view kByCondition = ") GROUP BY device_id, condition ORDER BY device_id, condition";
constexpr std::string_view kShown =
    "SELECT device_id, quantity, axis, recording_id, condition, glance_json FROM channel_results WHERE shown = 1 AND "
    "device_id IN (";
constexpr std::string_view kByAxis = ") ORDER BY device_id, quantity, axis";
constexpr std::string_view kNewest =
    "SELECT device_id, id, job_id, recording_id, created_at FROM channel_results WHERE sequence IN (SELECT (SELECT "
    "max(one.sequence) FROM channel_results AS one WHERE one.device_id = devices.id) FROM devices WHERE devices.id IN "
    "(";
constexpr std::string_view kVerdict = "SELECT " DRIFTLAB_VERDICT_COLUMNS
                                      " FROM verdicts WHERE id IN (SELECT (SELECT max(one.id) FROM verdicts AS one "
                                      "WHERE one.device_id = devices.id";
constexpr std::string_view kOfDevices = ") FROM devices WHERE devices.id IN (";
constexpr std::string_view kEndOfNewest = "))";
constexpr std::string_view kThese = "SELECT id FROM devices WHERE id IN (SELECT value FROM json_each(?))";
constexpr std::string_view kAmongVisible = " AND name IN (SELECT value FROM json_each(?))";

/// A result that says nothing at a glance yet.
struct Unseen {
  std::string id;
  std::string document_json;
  SensorAxis axis;
};

Unseen read_unseen(const Statement& row) { return {row.text(0), row.text(1), {row.text(2), row.text(3), row.text(4)}}; }

/// The devices that are asked for, as a query of their ids.
struct Devices {
  std::string select;
  std::vector<std::string> values;
};

Devices devices_of(const std::vector<std::string>& ids, const std::optional<Visibility>& visible) {
  Devices devices{std::string(kThese), {nlohmann::json(ids).dump()}};
  if (visible) {
    devices.select += kAmongVisible;
    devices.values.push_back(visible->devices_json);
  }
  return devices;
}

/// Hands every row of `begin` + the devices + `end` to `read`.
Status each_row(Connection& connection, std::string_view begin, const Devices& devices, std::string_view end,
                const std::function<Status(const Statement&)>& read) {
  Statement statement = connection.prepare(std::string(begin) + devices.select + std::string(end));
  for (const std::string& value : devices.values) {
    statement.bind(value);
  }
  while (true) {
    const Result<bool> row = statement.step();
    if (!row || !*row) {
      return row ? Status{} : fail(row.error());
    }
    if (Status done = read(statement); !done) {
      return done;
    }
  }
}

}  // namespace

Status show_results(Connection& connection, const std::vector<SensorAxis>& axes) {
  for (const SensorAxis& axis : axes) {
    for (const std::string_view sql : {kUnmark, kMark}) {
      if (Status done = connection.prepare(sql).bind(axis.device_id, axis.quantity, axis.axis).run(); !done) {
        return done;
      }
    }
  }
  return {};
}

Result<int> keep_glances(Connection& connection, const GlanceOf& glance_of) {
  Result<std::vector<Unseen>> found = std::vector<Unseen>();
  {
    Statement unseen = connection.prepare(kUnseen);
    unseen.bind(kGlancesAtOnce);
    found = all_rows(unseen, read_unseen);
  }
  if (!found) {
    return fail(found.error());
  }
  std::vector<SensorAxis> axes;
  for (const Unseen& one : *found) {
    const Glance glance = glance_of(one.document_json);
    if (Status kept = connection.prepare(kSee).bind(one.id, glance.json, glance.level).run(); !kept) {
      return fail(kept.error());
    }
    if (std::ranges::find(axes, one.axis) == axes.end()) {
      axes.push_back(one.axis);
    }
  }
  const Status shown = show_results(connection, axes);
  return shown ? Result<int>(static_cast<int>(found->size())) : fail(shown.error());
}

Result<DeviceOverviews> overviews(Connection& connection, const std::vector<std::string>& device_ids,
                                  const std::optional<Visibility>& visible) {
  const Devices devices = devices_of(device_ids, visible);
  DeviceOverviews found;
  Status read = each_row(connection, "", devices, "", [&](const Statement& row) {
    found[row.text(0)];
    return Status{};
  });
  if (read) {
    read = each_row(connection, kConditions, devices, kByCondition, [&](const Statement& row) {
      found[row.text(0)].conditions.push_back({row.text(1), row.integer(2)});
      return Status{};
    });
  }
  if (read) {
    read = each_row(connection, kShown, devices, kByAxis, [&](const Statement& row) {
      found[row.text(0)].axes.push_back({row.text(1), row.text(2), row.text(3), row.text(4), row.text(5)});
      return Status{};
    });
  }
  if (read) {
    read = each_row(connection, kNewest, devices, kEndOfNewest, [&](const Statement& row) {
      ChannelResult newest;
      newest.device_id = row.text(0);
      newest.id = row.text(1);
      newest.job_id = row.text(2);
      newest.recording_id = row.text(3);
      newest.created_at = row.integer(4);
      found[newest.device_id].newest = std::move(newest);
      return Status{};
    });
  }
  if (read) {
    const std::string verdict =
        std::string(kVerdict) + (visible ? " AND " + std::string(kNotOfLine) : "") + std::string(kOfDevices);
    read = each_row(connection, verdict, devices, kEndOfNewest, [&](const Statement& row) {
      return read_verdict(row).map(
          [&](ResultVerdict newest) { found[newest.device_id].verdict = std::move(newest); });
    });
  }
  return read ? Result<DeviceOverviews>(std::move(found)) : fail(read.error());
}

}  // namespace driftlab::server::tables
