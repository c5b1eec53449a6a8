#include "server/jobs/line_verdicts.hpp"

#include "core/campaign/population_verdict.hpp"
#include "server/jobs/stored_population.hpp"

#include <set>

namespace driftlab::server {
namespace {

constexpr std::size_t kFewestDevices = 4;
constexpr std::size_t kMostDevices = 200;

}  // namespace

Status add_line_verdicts(Store& store, JobResults& results) {
  std::set<std::string> devices;
  for (const ChannelResult& made : results.channels) {
    devices.insert(made.device_id);
  }
  for (const std::string& id : devices) {
    const auto device = store.device(id);
    if (!device) {
      return fail(device.error());
    }
    for (const std::string& model : std::set<std::string>{device->model, device->imu}) {
      if (model.empty()) {
        continue;
      }
      const auto report = populations_with(store, model, results.channels, kFewestDevices, kMostDevices);
      if (!report) {
        return fail(report.error());
      }
      const auto& line = *report;  // nothing where the devices are too few or too many
      const auto sentence = line.has_value() ? standing_out(*line, device->name) : std::nullopt;
      results.verdicts.push_back(
          {.device_id = id, .channel = model, .level = "look", .verdict = sentence.value_or("")});
    }
  }
  return {};
}

}  // namespace driftlab::server
