#include "clients/cli/http_client.hpp"
#include "clients/cli/print_answer.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace driftlab::cli {
namespace {

struct TrendsFlags {
  std::string server = "http://127.0.0.1:8477";
  std::string device;
  std::string sensor = "gyroscope";
  std::string axis;
  std::string method = "gmwm";
  std::string model;
  std::string format = "text";
};

Exit run(const TrendsFlags& flags) {
  std::string target = "/v1/trends?device=" + percent_encode(flags.device) + "&sensor=" + percent_encode(flags.sensor) +
                       "&method=" + percent_encode(flags.method);
  for (const auto& [name, value] : {std::pair{"&axis=", flags.axis}, std::pair{"&model=", flags.model}}) {
    if (!value.empty()) {
      target += name + percent_encode(value);
    }
  }
  return print_answer(flags.server, target,
                      flags.format == "json"       ? "application/json"
                      : flags.format == "csv"      ? "text/csv"
                      : flags.format == "markdown" ? "text/markdown"
                                                   : "text/plain");
}

}  // namespace

void add_trends(CLI::App& app, Command& chosen) {
  CLI::App* const command =
      app.add_subcommand("trends", "How each parameter of one sensor axis moves with rate and angular acceleration");
  const auto flags = std::make_shared<TrendsFlags>();
  command->add_option("--server", flags->server, "Address of the daemon")->capture_default_str();
  command->add_option("--device", flags->device, "Name or id of the device")->required();
  command->add_option("--sensor", flags->sensor, "gyroscope or accelerometer")->capture_default_str();
  command->add_option("--axis", flags->axis, "x, y or z");
  command->add_option("--method", flags->method, "gmwm or av (Allan variance)")->capture_default_str();
  command->add_option("--model", flags->model, "Model of the table; default: the best over all conditions");
  command->add_option("--format", flags->format, "text, csv, markdown or json")
      ->check(CLI::IsMember({"text", "csv", "markdown", "json"}))
      ->capture_default_str();
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
