#include "schema/json/drive.hpp"

#include "clients/cli/cli.hpp"
#include "clients/cli/drive_files.hpp"
#include "clients/cli/progress.hpp"
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
  bool nhc = false;
  bool zupt = false;
  bool odometer = false;
  bool as_stamped = false;
  double gate = 0.0;
  std::uint64_t seed = 1;
  int runs = 4;
  int threads = 0;
  bool json = false;
};

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

Result<drive::Drive> opened(const DriveFlags& flags, const RunControl& control) {
  auto document = read_drive_document(flags.document, flags.model);
  if (!document) {
    return fail(document.error());
  }
  return open_drive_files(flags.document, *document, {.repair = !flags.as_stamped}, control);
}

drive::FilterOptions filter_options(const DriveFlags& flags, const drive::Document& document) {
  drive::FilterOptions options = drive::options_of(document);
  if (flags.nhc) {
    options.constraint.emplace();
  }
  options.zero_velocity = flags.zupt;
  options.odometer = flags.odometer;
  options.gate = flags.gate;
  return options;
}

Exit check_files(const DriveFlags& flags) {
  RunControl control;
  control.stop = interrupt_token();
  auto drive = opened(flags, control);
  if (!drive) {
    return complain_of_work(drive.error());
  }
  const DriveCheck checked = check_drive(std::move(*drive));
  print(flags.json ? to_json(checked).dump(2) + "\n" : drive_check_to_text(checked));
  return Exit::Success;
}

/// An executor and a control that uses it.
struct Working {
  explicit Working(int threads)
      : executor(threads > 0 ? static_cast<unsigned>(threads) : std::thread::hardware_concurrency()) {
    control.stop = interrupt_token();
    control.threads.executor = &executor;
  }
  Executor executor;
  RunControl control;
};

Exit run_filter_over(const DriveFlags& flags) {
  const Working working(flags.threads);
  auto drive = opened(flags, working.control);
  if (!drive) {
    return complain_of_work(drive.error());
  }
  const drive::FilterOptions options = filter_options(flags, drive->document);
  const auto report = run_drive(std::move(*drive), options, {.seed = flags.seed}, working.control);
  if (!report) {
    return complain_of_work(report.error());
  }
  print(flags.json ? to_json(*report).dump(2) + "\n" : drive_report_to_text(*report));
  return Exit::Success;
}

Exit simulate_over(const DriveFlags& flags) {
  const Working working(flags.threads);
  auto drive = opened(flags, working.control);
  if (!drive) {
    return complain_of_work(drive.error());
  }
  const drive::FilterOptions options = filter_options(flags, drive->document);
  const auto simulation =
      simulate_drive_outages(std::move(*drive), options, {.runs = flags.runs, .seed = flags.seed}, working.control);
  if (!simulation) {
    return complain_of_work(simulation.error());
  }
  print(flags.json ? to_json(*simulation).dump(2) + "\n" : drive_simulation_to_text(*simulation));
  return Exit::Success;
}

Exit explain_files(const DriveFlags& flags) {
  Working working(flags.threads);
  auto document = read_drive_document(flags.document, flags.model);
  if (!document) {
    return complain_of_work(document.error());
  }
  const auto tables = open_drive_tables(flags.document, *document, working.control);
  if (!tables) {
    return complain_of_work(tables.error());
  }
  Result<DriveExplanationReport> report;
  {
    ProgressBar bar;
    working.control.progress = [&](std::string_view stage, double fraction) { bar.show(stage, fraction); };
    report = report_explanation(*document, *tables,
                                {.seed = flags.seed, .simulated_runs = flags.runs, .constraint = flags.nhc},
                                working.control);
  }
  if (!report) {
    return complain_of_work(report.error());
  }
  print(flags.json ? to_json(*report).dump(2) + "\n" : drive_explanation_to_text(*report));
  return Exit::Success;
}

void add_files(CLI::App& command, DriveFlags& flags) {
  command.add_option("DRIVE", flags.document, "drive.json; its files lie beside it")->required();
  command.add_flag("--json", flags.json, "Print the result document instead of tables");
}

void add_belief(CLI::App& command, DriveFlags& flags) {
  command.add_option("--model", flags.model, "What the filter believes, in place of the document's model");
  command.add_flag("--nhc", flags.nhc, "The vehicle moves along its nose: velocity constraints");
  command.add_option("--seed", flags.seed, "Same seed, same result, for any number of threads")->capture_default_str();
  command.add_option("--threads", flags.threads, "Threads; 0: one per processor")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

void add_filter(CLI::App& command, DriveFlags& flags) {
  add_belief(command, flags);
  command.add_flag("--zupt", flags.zupt, "Zero velocity and no turn while the unit is at rest");
  command.add_flag("--odometer", flags.odometer, "Use the odometer");
}

void add_runs(CLI::App& command, DriveFlags& flags) {
  command.add_option("--runs", flags.runs, "Simulated drives")->check(CLI::Range(1, 1000))->capture_default_str();
}

}  // namespace

void add_drive(CLI::App& app, Command& chosen) {
  CLI::App* const drive =
      app.add_subcommand("drive", "Measured GNSS outages of a recorded drive, and what simulations of them get wrong");
  drive->require_subcommand(1);
  const auto flags = std::make_shared<DriveFlags>();
  CLI::App* const check = drive->add_subcommand("check", "What the files of a drive show, without a filter");
  add_files(*check, *flags);
  check->callback([flags, &chosen] { chosen = [flags] { return check_files(*flags); }; });
  CLI::App* const run = drive->add_subcommand("run", "Take fixes away and measure what the filter does without them");
  add_files(*run, *flags);
  add_filter(*run, *flags);
  run->add_option("--gate", flags->gate, "Reject fixes whose normalised squared innovation is above this; 0: none")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  run->add_flag("--as-stamped", flags->as_stamped, "Believe the unit's stamps and keep repeated rows");
  run->callback([flags, &chosen] { chosen = [flags] { return run_filter_over(*flags); }; });
  CLI::App* const simulate = drive->add_subcommand(
      "simulate", "The same outages simulated along the same trajectory, beside the measured ones");
  add_files(*simulate, *flags);
  add_filter(*simulate, *flags);
  add_runs(*simulate, *flags);
  simulate->callback([flags, &chosen] { chosen = [flags] { return simulate_over(*flags); }; });
  CLI::App* const explain = drive->add_subcommand(
      "explain", "By how much a simulation of the drive is too optimistic, why, and what mending it gains");
  add_files(*explain, *flags);
  add_belief(*explain, *flags);
  add_runs(*explain, *flags);
  explain->callback([flags, &chosen] { chosen = [flags] { return explain_files(*flags); }; });
}

}  // namespace driftlab::cli
