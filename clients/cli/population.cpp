#include "schema/json/population.hpp"

#include "clients/cli/http_client.hpp"
#include "clients/cli/json_file.hpp"
#include "clients/cli/plot_file.hpp"
#include "clients/cli/print_answer.hpp"
#include "core/analysis/compare_devices.hpp"
#include "core/campaign/population_verdict.hpp"
#include "schema/json/campaign_summary.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/text/population.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace driftlab::cli {
namespace {

struct PopulationFlags {
  std::vector<std::string> files;
  std::string server = "http://127.0.0.1:8477";
  std::string model;
  std::string sensor;
  std::string format = "text";
};

/// The device of a document that `characterise --json` wrote; it has the file's name.
Result<DeviceSensors> device_of(const std::string& file) {
  const auto document = read_json_file(file, "what `driftlab characterise --json` wrote, one for each device");
  if (!document) {
    return fail(document.error());
  }
  if (!is_characterisation(*document)) {
    return fail(ErrorCode::InvalidArgument,
                file + " is no result of `driftlab characterise --json`; make one for each device.");
  }
  auto sensors = sensors_of(*document);
  if (!sensors) {
    return fail(sensors.error());
  }
  return DeviceSensors{std::filesystem::path(file).stem().string(), std::move(*sensors)};
}

/// The wavelet variances of what a device recorded, which no other device shares; none of columns that do not move.
std::vector<std::vector<double>> variances_of(const DeviceSensors& device) {
  std::vector<std::vector<double>> variances;
  for (const SensorSources& sensor : device.sensors) {
    for (const TableSource& source : sensor.sources) {
      const std::vector<double>& one = source.channel.haar.variance;
      if (std::any_of(one.begin(), one.end(), [](double value) { return value > 0.0; })) {
        variances.push_back(one);
      }
    }
  }
  return variances;
}

/// Whether the last device is one of those before, which would count twice.
Status check_copy(const std::vector<std::string>& files, const std::vector<DeviceSensors>& devices) {
  const std::size_t last = devices.size() - 1;
  const auto variances = variances_of(devices[last]);
  for (std::size_t i = 0; i < last; ++i) {
    if (variances.empty() || variances_of(devices[i]) != variances) {
      continue;
    }
    const std::string fault = files[i] == files[last]
                                  ? "The file " + files[i] + " is named twice"
                                  : "The files " + files[i] + " and " + files[last] + " hold the same samples";
    return fail(ErrorCode::InvalidArgument, fault + "; each device counts once.");
  }
  return {};
}

Exit run_here(const PopulationFlags& flags) {
  std::vector<DeviceSensors> devices;
  for (const std::string& file : flags.files) {
    auto device = device_of(file);
    if (!device) {
      return complain(device.error());
    }
    devices.push_back(std::move(*device));
    if (auto checked = check_copy(flags.files, devices); !checked) {
      return complain(checked.error());
    }
  }
  const auto wanted = quantity_of_sensor(flags.sensor);
  const PopulationReport report = compare_devices(flags.model.empty() ? "these devices" : flags.model, devices,
                                                  wanted ? std::optional(*wanted) : std::nullopt);
  return write_text("", flags.format == "json"       ? to_json(report, verdict_of(report)).dump(2) + "\n"
                        : flags.format == "csv"      ? populations_to_csv(report)
                        : flags.format == "markdown" ? populations_to_markdown(report)
                                                     : populations_to_text(report));
}

Exit run(const PopulationFlags& flags) {
  if (!flags.files.empty()) {
    return run_here(flags);
  }
  if (flags.model.empty()) {
    return complain({ErrorCode::InvalidArgument,
                     "Name the model of stored devices (--model MPU-6050), or the result of `characterise --json` of "
                     "each device.",
                     {}});
  }
  std::string target = "/v1/populations?model=" + percent_encode(flags.model);
  if (!flags.sensor.empty()) {
    target += "&sensor=" + percent_encode(flags.sensor);
  }
  return print_answer(flags.server, target,
                      flags.format == "json"       ? "application/json"
                      : flags.format == "csv"      ? "text/csv"
                      : flags.format == "markdown" ? "text/markdown"
                                                   : "text/plain");
}

}  // namespace

void add_population(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand(
      "population", "All devices of a model: mean, spread between them, and which of them is not of the line");
  const auto flags = std::make_shared<PopulationFlags>();
  command->add_option("FILE", flags->files, "Results of characterise --json, one a device, named after it");
  command->add_option("--server", flags->server, "Address of the daemon")->capture_default_str();
  command->add_option("--model", flags->model, "Model or IMU of the stored devices, e.g. MPU-6050");
  command->add_option("--sensor", flags->sensor, "Only the gyroscope or the accelerometer")
      ->check(CLI::IsMember({"gyroscope", "accelerometer"}));
  command->add_option("--format", flags->format, "text, csv, markdown or json")
      ->check(CLI::IsMember({"text", "csv", "markdown", "json"}))
      ->capture_default_str();
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
