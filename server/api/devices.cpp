#include "server/api/api.hpp"
#include "server/api/device_name.hpp"
#include "server/api/documents.hpp"
#include "server/api/overviews.hpp"

#include <algorithm>
#include <iterator>

namespace driftlab::server {
namespace {

Response device_response(int status, const Device& device) {
  Response response = json_response(status, to_json(device));
  response.headers.emplace_back("ETag", etag_of(device.id, device.revision));
  return response;
}

/// The text members a device may have, read from a body; `labels` as canonical text.
DeviceChange read_change(ObjectReader& reader, const Budgets& budgets, Faults& faults) {
  DeviceChange change;
  change.model = reader.text("model");
  change.imu = reader.text("imu");
  change.serial = reader.text("serial");
  for (const auto& [member, text] :
       {std::pair{"model", &change.model}, std::pair{"imu", &change.imu}, std::pair{"serial", &change.serial}}) {
    limit_text(text->value_or(""), "name_bytes", budgets.name_bytes, reader.pointer(member), faults);
  }
  if (const Json* const labels = reader.member("labels")) {
    if (labels->size() > static_cast<std::size_t>(budgets.labels)) {
      faults.add(reader.pointer("labels"), ErrorCode::LimitExceeded,
                 "These are too many labels " + naming_budget("labels", budgets.labels) + ".");
      return change;
    }
    bool sound = labels->is_object();
    for (const auto& [name, value] : labels->items()) {
      sound = sound && value.is_string();
      limit_text(name, "label_bytes", budgets.label_bytes, reader.pointer("labels"), faults);
      limit_text(value.is_string() ? value.get<std::string>() : "", "label_bytes", budgets.label_bytes,
                 reader.pointer("labels"), faults);
    }
    if (sound) {
      change.labels_json = canonical_text(*labels);
    } else {
      faults.add(reader.pointer("labels"), ErrorCode::InvalidArgument, "The labels must be an object of texts.");
    }
  }
  return change;
}

Result<Response> create_device(ApiContext& context, const Request& request) {
  auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  ObjectReader reader(*body, "", faults);
  Device device;
  device.name = reader.required_text("name");
  const DeviceChange members = read_change(reader, *request.budgets, faults);
  reader.reject_unknown();
  if (device.name.starts_with("dev_")) {
    faults.add("/name", ErrorCode::InvalidArgument, "A device name does not begin with dev_.");
  } else if (std::string fault = fault_of_device_name(device.name);
             !fault.empty() && (!device.name.empty() || faults.none())) {  // a name that is missing is a fault already
    faults.add("/name", ErrorCode::InvalidArgument, std::move(fault));
  }
  if (!faults.none()) {
    return fail(faults.error());
  }
  device.model = members.model.value_or("");
  device.imu = members.imu.value_or("");
  device.serial = members.serial.value_or("");
  device.labels_json = members.labels_json.value_or("{}");
  auto outcome = context.store.ensure_device(device);
  if (!outcome) {
    return fail(outcome.error());
  }
  const Device& kept = outcome->device;
  const bool same = kept.model == device.model && kept.imu == device.imu && kept.serial == device.serial &&
                    kept.labels_json == device.labels_json;
  if (!outcome->created && !same) {
    return fail(ErrorCode::Conflict,
                "The device '" + device.name + "' exists with other properties; change them with PATCH /v1/devices/" +
                    kept.id + ".",
                {{"device_id", kept.id}});
  }
  if (outcome->created) {
    context.events.add("devices", "device.created", Json{{"device", kept.id}, {"name", kept.name}});
  }
  Response response = device_response(outcome->created ? 201 : 200, kept);
  response.headers.emplace_back("Location", "/v1/devices/" + kept.id);
  return response;
}

Result<Response> list_devices(ApiContext& context, const Request& request) {
  const auto include = request.parameter("include");
  if (include && *include != "summary") {
    return fail(ErrorCode::InvalidArgument, "What can be included with a device is its summary.",
                {{"parameter", "include"}});
  }
  auto sought = text_filter(request);
  if (!sought) {
    return fail(sought.error());
  }
  const DeviceFilter filter{std::move(*sought)};
  DeviceOverviews overviews;
  return list_rows(
      request,
      [&](const Page& page) -> Result<std::vector<Device>> {
        auto devices = context.store.devices(filter, page);
        if (devices && include) {
          std::vector<std::string> ids;
          std::ranges::transform(*devices, std::back_inserter(ids), &Device::id);
          auto found = context.store.overviews(ids);
          if (!found) {
            return fail(found.error());
          }
          overviews = std::move(*found);
        }
        return devices;
      },
      [&](const Device& device) {
        Json document = to_json(device);
        if (include) {  // a device that was removed since the page was read has none
          const auto overview = overviews.find(device.id);
          document["summary"] = overview != overviews.end() ? device_summary(overview->second) : Json(nullptr);
        }
        return document;
      });
}

Result<Response> get_device(ApiContext& context, const Request& request) {
  auto device = context.store.device(request.parameters[0]);
  if (!device) {
    return fail(device.error());
  }
  return device_response(200, *device);
}

Result<Response> patch_device(ApiContext& context, const Request& request) {
  auto device = context.store.device(request.parameters[0]);
  if (!device) {
    return fail(device.error());
  }
  const auto revision = expected_revision(request, device->id, device->revision);
  if (!revision) {
    return revision.error();
  }
  const auto change = read_body(
      request, [&](ObjectReader& reader, Faults& faults) { return read_change(reader, *request.budgets, faults); });
  if (!change) {
    return fail(change.error());
  }
  auto changed = context.store.update_device(device->id, *change, *revision);
  if (!changed) {
    return fail(changed.error());
  }
  context.events.add("devices", "device.changed", Json{{"device", changed->id}, {"name", changed->name}});
  return device_response(200, *changed);
}

Result<Response> delete_device(ApiContext& context, const Request& request) {
  auto device = context.store.device(request.parameters[0]);
  if (!device) {
    return fail(device.error());
  }
  const auto revision = expected_revision(request, device->id, device->revision);
  if (!revision) {
    return revision.error();
  }
  const Status removed = context.store.remove_device(device->id, *revision);
  if (removed) {
    context.events.add("devices", "device.deleted", Json{{"device", device->id}, {"name", device->name}});
  }
  return removed_response(removed);
}

}  // namespace

void add_device_routes(Router& router, ApiContext& context) {
  router.add(from_rows({"GET",
                        "/v1/devices",
                        "listDevices",
                        {"limit", "cursor", "sort", "include", "q"},
                        Handler([&](const Request& request) { return list_devices(context, request); })}));
  router.add({"POST", "/v1/devices", "createDevice", {}, Handler([&](const Request& request) {
                return create_device(context, request);
              })});
  router.add(from_rows({"GET", "/v1/devices/{id}", "getDevice", {}, Handler([&](const Request& request) {
                          return get_device(context, request);
                        })}));
  router.add({"PATCH", "/v1/devices/{id}", "changeDevice", {}, Handler([&](const Request& request) {
                return patch_device(context, request);
              })});
  router.add({"DELETE", "/v1/devices/{id}", "deleteDevice", {}, Handler([&](const Request& request) {
                return delete_device(context, request);
              })});
}

}  // namespace driftlab::server
