#include "clients/cli/analysis.hpp"
#include "clients/cli/json_file.hpp"
#include "clients/cli/left_out_lines.hpp"
#include "clients/cli/plot_file.hpp"
#include "clients/cli/print_answer.hpp"
#include "clients/cli/stored_document.hpp"
#include "schema/json/report_page.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

namespace driftlab::cli {
namespace {

struct PlotFlags {
  std::vector<std::string> files;
  FileFlags file;
  std::string server;
  std::string output = "-";
  std::string channel;
};

struct Documented {
  std::string device;
  std::vector<std::string> hardware;  ///< texts that describe the device
  Json document;
  std::optional<TabledCampaign> campaign = std::nullopt;  ///< of recordings characterised now
};

/// What becomes of a document. Of a device its parameter tables are drawn, and its newest recordings reported too.
enum class Purpose { Draw, Report };

/// What a daemon has stored of a device, or under an id.
tl::expected<Documented, Failure> stored_there(const PlotFlags& flags, Purpose purpose) {
  if (flags.files.size() + (flags.file.device.empty() ? 0 : 1) != 1) {
    return tl::unexpected(Failure{{ErrorCode::InvalidArgument,
                                   "With --server name one thing that the daemon has stored: an id (rec_…, inv_… or "
                                   "job_…), or a device (--device NAME).",
                                   {}},
                                  Exit::BadInput});
  }
  if (const std::string given = recording_flags(flags.file); !given.empty()) {
    return tl::unexpected(
        Failure{{ErrorCode::InvalidArgument,
                 "What a daemon has stored is described there: " + given + " cannot stand beside --server.",
                 {}},
                Exit::BadInput});
  }
  const auto device = purpose == Purpose::Draw ? fetch_tables : fetch_device;
  auto stored =
      flags.files.empty() ? device(flags.server, flags.file.device) : fetch_result(flags.server, flags.files.front());
  if (!stored) {
    return tl::unexpected(stored.error());
  }
  return Documented{stored->device, {stored->device}, std::move(stored->document)};
}

/// A document as it stands, or recordings characterised now, with the name of their device.
tl::expected<Documented, Failure> document_of(const PlotFlags& flags, Purpose purpose) {
  if (!flags.server.empty()) {
    return stored_there(flags, purpose);
  }
  if (flags.files.empty()) {
    return tl::unexpected(Failure{
        {ErrorCode::InvalidArgument,
         "Name " + std::string(kWrittenByJson) + ", a recording or a study.json; or --server and what is stored there.",
         {}},
        Exit::BadInput});
  }
  if (flags.files.size() == 1 && flags.files.front().ends_with(".json")) {
    auto document = read_json_file(flags.files.front(), kWrittenByJson);
    if (!document) {
      return tl::unexpected(Failure{document.error(), Exit::BadInput});
    }
    const Json recordings = document->is_object() ? document->value("recordings", Json(nullptr)) : Json(nullptr);
    const bool study = recordings.is_array() && !recordings.empty() && !recordings.front().contains("channels");
    if (!study) {
      const std::string device = document->is_object() && document->value("device", Json(nullptr)).is_string()
                                     ? document->at("device").get<std::string>()
                                     : flags.file.device;
      return Documented{device, {device}, std::move(*document)};
    }
  }
  const auto document = std::find_if(flags.files.begin(), flags.files.end(),
                                     [](const std::string& file) { return file.ends_with(".json"); });
  if (flags.files.size() > 1 && document != flags.files.end()) {
    return tl::unexpected(Failure{{ErrorCode::InvalidArgument,
                                   "One document is " + std::string(purpose == Purpose::Draw ? "drawn" : "reported") +
                                       " at a time, and it stands alone: " + *document + " is one of " +
                                       std::to_string(flags.files.size()) + " files here.",
                                   {}},
                                  Exit::BadInput});
  }
  auto inputs = read_inputs(flags.files, flags.file);
  if (!inputs) {
    return tl::unexpected(Failure{inputs.error(), Exit::BadInput});
  }
  const auto campaign = characterise_here(*inputs, {});
  if (!campaign) {
    return tl::unexpected(campaign.error());
  }
  return Documented{inputs->device, inputs->hardware, as_document(*campaign, *inputs), tabled(*campaign)};
}

Exit run_plot(const PlotFlags& flags) {
  const auto document = document_of(flags, Purpose::Draw);
  if (!document) {
    return complain(document.error().error, document.error().exit);
  }
  const auto written = write_plots(document->document, flags.output, flags.channel);
  return written ? Exit::Success : complain(written.error());
}

Exit run_report(const PlotFlags& flags) {
  const auto document = document_of(flags, Purpose::Report);
  if (!document) {
    return complain(document.error().error, document.error().exit);
  }
  std::string tables;
  const bool tabled_there = document->document.contains("tables");
  if (!tabled_there && document->document.contains("recordings") && document->document.at("recordings").is_array()) {
    const auto& told = document->campaign;
    const auto campaign = told ? Result<TabledCampaign>(*told) : tabled_from_json(document->document);
    if (!campaign) {
      return complain(campaign.error());
    }
    tables = tables_of(*campaign, document->device, document->hardware, TableNames::InPrint);
  }
  const auto page = report_page(document->document, document->device, tables);
  if (!page) {
    return complain(page.error());
  }
  return write_text(flags.output == "-" ? "" : flags.output, *page);
}

void add_inputs(CLI::App& command, const std::shared_ptr<PlotFlags>& flags) {
  command.add_option(
      "FILE", flags->files,
      "A document that --json wrote, recordings, or one study.json; with --server an id: rec_…, inv_… or job_…");
  command.add_option("--rate-hz", flags->file.rate_hz, "Sampling rate of recordings; needed without a time column");
  command.add_option("--columns", flags->file.columns, "NAME=QUANTITY:AXIS:UNIT,… as for characterise");
  command.add_option("--stream", flags->file.stream,
                     "Of the units of a log or table the one that is meant, as its columns begin, e.g. imu2");
  command.add_option("--condition", flags->file.condition, "static, constant_rate:z:9:deg/s, …")->capture_default_str();
  command.add_option("--device", flags->file.device,
                     "Name of the device; with --server its parameter tables are shown");
  add_left_out_lines(command, flags->file);
  command.add_option("--calibration", flags->file.calibration,
                     "Correct the readings by what `driftlab calibrate --json` wrote to this file");
  command.add_option("--server", flags->server, "Show what the daemon at this address has stored");
}

}  // namespace

void add_plot(CLI::App& app, Command& chosen) {
  CLI::App* const command =
      app.add_subcommand("plot", "Figures of a result or a recording: SVG, PNG, or in the terminal");
  const auto flags = std::make_shared<PlotFlags>();
  add_inputs(*command, flags);
  command->add_option("--output", flags->output, "File (.svg, .png); - draws in the terminal")->capture_default_str();
  command->add_option("--channel", flags->channel,
                      "Only this channel, this axis of a regression run, or this parameter of a table");
  command->callback([flags, &chosen] { chosen = [flags] { return run_plot(*flags); }; });
}

void add_report(CLI::App& app, Command& chosen) {
  CLI::App* const command =
      app.add_subcommand("report", "One HTML page of a device, a recording, an investigation or a regression run");
  const auto flags = std::make_shared<PlotFlags>();
  add_inputs(*command, flags);
  command->add_option("--output", flags->output, "File; - prints it")->capture_default_str();
  command->callback([flags, &chosen] { chosen = [flags] { return run_report(*flags); }; });
}

}  // namespace driftlab::cli
