#include "clients/cli/http_client.hpp"
#include "clients/cli/plot_file.hpp"
#include "clients/cli/print_answer.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace driftlab::cli {
namespace {

struct TableFlags {
  std::string server = "http://127.0.0.1:8477";
  std::string device;
  std::string sensor = "gyroscope";
  std::string axis;
  std::string method = "gmwm";
  std::string model;
  std::string reference;
  std::string format = "text";
  std::string plot;
};

std::string media_type(const std::string& format) {
  if (format == "csv") {
    return "text/csv";
  }
  if (format == "markdown") {
    return "text/markdown";
  }
  if (format == "latex") {
    return "text/x-latex";
  }
  return format == "json" ? "application/json" : "text/plain";
}

Exit run(const TableFlags& flags) {
  std::string target = "/v1/parameter-tables?device=" + percent_encode(flags.device) +
                       "&sensor=" + percent_encode(flags.sensor) + "&method=" + percent_encode(flags.method);
  if (!flags.axis.empty()) {
    target += "&axis=" + percent_encode(flags.axis);
  }
  if (!flags.model.empty()) {
    target += "&model=" + percent_encode(flags.model);
  }
  if (!flags.reference.empty()) {
    target += "&reference=" + percent_encode(flags.reference);
  }
  if (!flags.plot.empty()) {
    const auto document = fetch_document(flags.server, target);
    if (!document) {
      return complain(document.error().error, document.error().exit);
    }
    if (auto drawn = write_plots(*document, flags.plot); !drawn) {
      return complain(drawn.error());
    }
  }
  return print_answer(flags.server, target, media_type(flags.format));
}

}  // namespace

void add_table(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand("table", "Parameter table of one sensor axis over all its conditions");
  const auto flags = std::make_shared<TableFlags>();
  command->add_option("--server", flags->server, "Address of the daemon")->capture_default_str();
  command->add_option("--device", flags->device, "Name or id of the device")->required();
  command->add_option("--sensor", flags->sensor, "gyroscope or accelerometer")->capture_default_str();
  command->add_option("--axis", flags->axis, "x, y or z; all: a table for each axis that has results");
  command->add_option("--method", flags->method, "gmwm or av (Allan variance)")->capture_default_str();
  command->add_option("--model", flags->model, "Model of the table; default: the best over all conditions");
  command->add_option("--reference", flags->reference,
                      "Condition of the row that changes are against, for example static; default: the first row");
  command->add_option("--format", flags->format, "text, csv, markdown, latex or json")
      ->check(CLI::IsMember({"text", "csv", "markdown", "latex", "json"}))
      ->capture_default_str();
  add_plot_flag(*command, flags->plot);
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
