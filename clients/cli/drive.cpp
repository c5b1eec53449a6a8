#include "schema/json/drive.hpp"

#include "clients/cli/cli.hpp"
#include "clients/cli/drive_files.hpp"
#include "clients/cli/drive_remote.hpp"
#include "clients/cli/plot_file.hpp"
#include "clients/cli/progress.hpp"
#include "clients/cli/table_file.hpp"
#include "schema/json/drive_draft.hpp"
#include "schema/json/drive_request.hpp"
#include "schema/text/drive.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <thread>

namespace driftlab::cli {
namespace {

struct DriveFlags {
  std::string document;
  std::string model;
  std::vector<std::string> models;  ///< of a comparison
  DriveRequest request;
  int threads = 0;
  bool json = false;
  std::string out;
  std::string plot;
  DriveServer server;
};

struct DraftFlags {
  std::string unit;
  std::string receiver;
  std::string vehicle = "road";
  double rate_hz = 0.0;
};

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

/// What the document's beginning says, with what it takes for granted on the standard error.
Exit draft_files(const DraftFlags& flags) {
  RunControl control;
  control.stop = interrupt_token();
  DraftRequest request;
  request.vehicle = drive::parse_vehicle(flags.vehicle).value_or(drive::Vehicle::Road);
  auto unit = read_draft_file(flags.unit, control);
  if (!unit) {
    return complain_of_work(unit.error());
  }
  request.unit = *std::move(unit);
  if (flags.rate_hz > 0.0) {
    request.unit.spec.rate_hz = flags.rate_hz;
  }
  if (!flags.receiver.empty()) {
    auto receiver = read_draft_file(flags.receiver, control);
    if (!receiver) {
      return complain_of_work(receiver.error());
    }
    request.receiver = *std::move(receiver);
  }
  const auto draft = draft_drive(request);
  if (!draft) {
    return complain(draft.error());
  }
  print(to_json(*draft).dump(2) + "\n");
  for (const std::string& note : draft->notes) {
    std::fprintf(stderr, "%s\n", note.c_str());
  }
  return Exit::Success;
}

Exit check_files(const DriveFlags& flags) {
  RunControl control;
  control.stop = interrupt_token();
  auto document = read_drive_document(flags.document, flags.model);
  if (!document) {
    return complain_of_work(document.error());
  }
  auto drive = open_drive_files(flags.document, *document, {}, control);
  if (!drive) {
    return complain_of_work(drive.error());
  }
  const DriveCheck checked = check_drive(std::move(*drive));
  print(flags.json ? to_json(checked).dump(2) + "\n" : drive_check_to_text(checked));
  return Exit::Success;
}

/// The figures of an answer, where they are wanted.
Exit draw(const DriveFlags& flags, const Json& document) {
  if (flags.plot.empty()) {
    return Exit::Success;
  }
  const Status drawn = write_plots(document, flags.plot);
  return drawn ? Exit::Success : complain(drawn.error());
}

/// The same question as a job of a daemon.
Exit ask_there(const DriveFlags& flags) {
  const auto document = ask_drive_there(flags.server, flags.document, flags.model, flags.request);
  if (!document) {
    return complain(document.error().error, document.error().exit);
  }
  print(document->dump(2) + "\n");
  return draw(flags, *document);
}

Exit ask(const DriveFlags& flags) {
  if (!flags.server.address.empty()) {
    return ask_there(flags);
  }
  auto document = read_drive_document(flags.document, flags.model);
  if (!document) {
    return complain_of_work(document.error());
  }
  Executor executor(flags.threads > 0 ? static_cast<unsigned>(flags.threads) : std::thread::hardware_concurrency());
  RunControl control;
  control.stop = interrupt_token();
  control.threads.executor = &executor;
  const auto tables = open_drive_tables(flags.document, *document, control);
  if (!tables) {
    return complain_of_work(tables.error());
  }
  Result<DriveAnswer> answer;
  {
    ProgressBar bar;
    control.progress = [&](std::string_view stage, double fraction) { bar.show(stage, fraction); };
    answer = answer_drive(flags.request, *document, *tables, control);
  }
  if (!answer) {
    return complain_of_work(answer.error());
  }
  print(flags.json ? to_json(*answer).dump(2) + "\n" : drive_answer_to_text(*answer));
  return flags.plot.empty() ? Exit::Success : draw(flags, to_json(*answer));
}

Exit compare(DriveFlags& flags) {
  auto models = read_drive_models(flags.models);
  if (!models) {
    return complain_of_work(models.error());
  }
  flags.request.models = std::move(*models);
  return ask(flags);
}

/// The path by all fixes, written as a table.
Exit smooth_files(const DriveFlags& flags) {
  RunControl control;
  control.stop = interrupt_token();
  const auto document = read_drive_document(flags.document, flags.model);
  if (!document) {
    return complain_of_work(document.error());
  }
  const auto drive = open_drive_files(flags.document, *document, {}, control);
  if (!drive) {
    return complain_of_work(drive.error());
  }
  const auto table = smoothed_table(*drive, options_of(flags.request, *document));
  if (!table) {
    return complain_of_work(table.error());
  }
  const Status written = write_table(
      flags.out, "Smoothed by driftlab " DRIFTLAB_VERSION " over all fixes of " + document->id + "; the inertial unit",
      *table);
  return written ? Exit::Success : complain(written.error());
}

void add_draft(CLI::App& drive, Command& chosen) {
  const auto flags = std::make_shared<DraftFlags>();
  CLI::App* const command = drive.add_subcommand("draft", "Draw up drive.json from the names of a log's columns");
  command->add_option("LOG", flags->unit, "The unit's readings; a flight log or a bag holds the fixes as well")
      ->required();
  command->add_option("--gnss", flags->receiver, "The receiver's fixes, where they are in a file of their own");
  command->add_option("--vehicle", flags->vehicle, "road, rail, rover, air, foot or boat")
      ->check(CLI::IsMember({"road", "rail", "rover", "air", "foot", "boat"}))
      ->capture_default_str();
  command->add_option("--rate-hz", flags->rate_hz, "Sampling rate of readings without times")
      ->check(CLI::PositiveNumber);
  command->callback([flags, &chosen] { chosen = [flags] { return draft_files(*flags); }; });
}

void add_files(CLI::App& command, DriveFlags& flags) {
  command.add_option("DRIVE", flags.document, "drive.json; its files lie beside it")->required();
  command.add_flag("--json", flags.json, "Print the result document instead of tables");
}

void add_model(CLI::App& command, DriveFlags& flags) {
  command.add_option("--model", flags.model, "What the filter believes, in place of the document's model");
}

void add_work(CLI::App& command, DriveFlags& flags) {
  command.add_flag("--nhc", flags.request.velocity_constraint,
                   "The vehicle moves along its nose: velocity constraints");
  command.add_option("--seed", flags.request.seed, "Same seed, same result, for any number of threads")
      ->capture_default_str();
  command.add_option("--threads", flags.threads, "Threads; 0: one per processor")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  add_plot_flag(command, flags.plot);
  command.add_option("--server", flags.server.address,
                     "Address of a daemon that does the work; prints the result document");
  command.add_option("--device", flags.server.device,
                     "Device under which the daemon keeps the files; left out: the document's id");
}

void add_filter(CLI::App& command, DriveFlags& flags) {
  add_work(command, flags);
  command.add_flag("--zupt", flags.request.zero_velocity, "Zero velocity and no turn while the unit is at rest");
  command.add_flag("--odometer", flags.request.odometer, "Use the odometer");
  command.add_flag(
      "--estimate", flags.request.estimate,
      "Estimate the lever arm, and with --nhc the mounting, by the document's standard deviations; with --nhc "
      "also where the axle lies, with --odometer its scale");
}

void add_readings(CLI::App& command, DriveFlags& flags) {
  command
      .add_option("--gate", flags.request.gate,
                  "Reject fixes whose normalised squared innovation is above this; 0: none")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_flag("--as-stamped", flags.request.as_stamped, "Believe the unit's stamps and keep repeated rows");
}

void add_runs(CLI::App& command, DriveFlags& flags) {
  command.add_option("--runs", flags.request.runs, "Simulated drives")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
}

}  // namespace

void add_drive(CLI::App& app, Command& chosen) {
  CLI::App* const drive =
      app.add_subcommand("drive", "Measured GNSS outages of a recorded drive, and what simulations of them get wrong");
  drive->require_subcommand(1);
  add_draft(*drive, chosen);
  const auto flags = std::make_shared<DriveFlags>();
  CLI::App* const check = drive->add_subcommand("check", "What the files of a drive show, without a filter");
  add_files(*check, *flags);
  check->callback([flags, &chosen] { chosen = [flags] { return check_files(*flags); }; });
  CLI::App* const run = drive->add_subcommand("run", "Take fixes away and measure what the filter does without them");
  add_files(*run, *flags);
  add_model(*run, *flags);
  add_filter(*run, *flags);
  add_readings(*run, *flags);
  run->callback([flags, &chosen] {
    flags->request.question = DriveQuestion::Run;
    chosen = [flags] { return ask(*flags); };
  });
  CLI::App* const simulate = drive->add_subcommand(
      "simulate", "The same outages simulated along the same trajectory, beside the measured ones");
  add_files(*simulate, *flags);
  add_model(*simulate, *flags);
  add_filter(*simulate, *flags);
  add_runs(*simulate, *flags);
  simulate->callback([flags, &chosen] {
    flags->request.question = DriveQuestion::Simulate;
    chosen = [flags] { return ask(*flags); };
  });
  CLI::App* const smooth = drive->add_subcommand("smooth", "The drive's path by all its fixes, as a table");
  smooth->add_option("DRIVE", flags->document, "drive.json; its files lie beside it")->required();
  smooth->add_option("--model", flags->model, "What the filter believes, in place of the document's model");
  smooth->add_flag("--nhc", flags->request.velocity_constraint,
                   "The vehicle moves along its nose: velocity constraints");
  smooth->add_option("--out", flags->out, "Where to write the table (.csv or .npy)")->required();
  smooth->callback([flags, &chosen] { chosen = [flags] { return smooth_files(*flags); }; });
  CLI::App* const explain = drive->add_subcommand(
      "explain", "By how much a simulation of the drive is too optimistic, why, and what mending it gains");
  add_files(*explain, *flags);
  add_model(*explain, *flags);
  add_work(*explain, *flags);
  add_runs(*explain, *flags);
  explain->callback([flags, &chosen] {
    flags->request.question = DriveQuestion::Explain;
    chosen = [flags] { return ask(*flags); };
  });
  CLI::App* const comparison =
      drive->add_subcommand("compare", "Several error models as filters through the same outages, paired");
  add_files(*comparison, *flags);
  comparison
      ->add_option("--model", flags->models,
                   "A model: document, document-white, a filter of the paper such as M_dyn(GMWM), or a JSON file; give "
                   "it once for each, the first is what the others are compared with")
      ->required();
  comparison->add_flag("--fit-noise", flags->request.fit_noise,
                       "Scale each model's white noise to the innovations first");
  add_filter(*comparison, *flags);
  add_readings(*comparison, *flags);
  comparison->callback([flags, &chosen] {
    flags->request.question = DriveQuestion::Compare;
    chosen = [flags] { return compare(*flags); };
  });
}

}  // namespace driftlab::cli
