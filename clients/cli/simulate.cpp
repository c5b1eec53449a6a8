#include "core/analysis/simulate.hpp"

#include "clients/cli/cli.hpp"
#include "clients/cli/json_file.hpp"
#include "clients/cli/scenario_input.hpp"
#include "clients/cli/table_file.hpp"
#include "core/signal/number.hpp"
#include "schema/json/simulation_model.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace driftlab::cli {
namespace {

struct SimulateFlags {
  std::string preset = "iphone5s-z";
  std::string condition = "static";
  std::string model;
  std::string channel;
  double rate_hz = 100.0;
  double duration_s = 900.0;
  std::uint64_t seed = 1;
  std::string out;
  std::string scenario;
  std::uint64_t run = 0;
  std::string gnss;
  std::string truth;
};

std::string provenance(const SimulateFlags& flags) {
  std::string text = "Simulated by driftlab " DRIFTLAB_VERSION ", ";
  if (!flags.scenario.empty()) {
    text.append("scenario ").append(flags.scenario).append(", run ").append(std::to_string(flags.run));
    return text.append(", seed ").append(std::to_string(flags.seed));
  }
  text.append("preset ")
      .append(flags.preset)
      .append(", condition ")
      .append(flags.condition)
      .append(", seed ")
      .append(std::to_string(flags.seed));
  text.append(", sample rate ").append(to_text(flags.rate_hz)).append(" Hz");  // read back as the rate
  return text.append("; see core/process/published_models.hpp");
}

/// A model file: a model, an investigation's report (its extended model), a fit, or a list of processes.
Result<investigate::Baseline> read_model(const std::string& path) {
  auto document = read_json_file(path, "a model, an investigation's report or a fit");
  if (!document) {
    return fail(document.error());
  }
  if (document->is_array()) {
    document = Json{{"processes", *document}};
  } else if (document->is_object() && document->contains("extended_model")) {
    document = Json((*document)["extended_model"]);
  }
  Faults faults;
  investigate::Baseline model = simulation_model_from_json(*document, "", faults);
  if (!faults.none()) {
    return fail(in_file(path, faults.error()));
  }
  return model;
}

Result<AxisSimulation> axis_of(const SimulateFlags& flags) {
  auto condition = parse_condition(flags.condition);
  if (!condition) {
    return fail(condition.error());
  }
  return AxisSimulation{*condition, flags.rate_hz, flags.duration_s, flags.seed};
}

/// An .npy file has no names: what reads it must be told them, and this says how.
void say_columns(const SimulateFlags& flags, const SampleTable& table) {
  if (!is_array_name(flags.out)) {
    return;
  }
  std::string columns;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    columns.append(c == 0 ? "" : ", ").append(std::to_string(c)).append(" is ").append(table.columns[c]);
  }
  std::fprintf(stderr,
               "driftlab: %s holds numbers alone: to read it, give --rate-hz %s and its columns by --columns (%s).\n",
               flags.out.c_str(), to_text(flags.rate_hz).c_str(), columns.c_str());
}

/// One axis at one condition.
Exit write_preset(const SimulateFlags& flags) {
  const auto wanted = axis_of(flags);
  const auto table = wanted ? simulate_preset(flags.preset, *wanted) : fail(wanted.error());
  const Status written = table ? write_table(flags.out, provenance(flags), *table) : fail(table.error());
  if (!written) {
    return complain(written.error());
  }
  say_columns(flags, *table);
  return Exit::Success;
}

/// One channel of a simulation model. What cannot be brought about is named on standard error and in the file.
Exit write_model(const SimulateFlags& flags) {
  const auto model = read_model(flags.model);
  if (!model) {
    return complain(model.error());
  }
  const auto wanted = axis_of(flags);
  const auto made = wanted ? simulate_model(*model, flags.channel, *wanted) : fail(wanted.error());
  if (!made) {
    return complain(made.error());
  }
  std::string comment = "Simulated by driftlab " DRIFTLAB_VERSION ", model " + flags.model + ", condition " +
                        flags.condition + ", seed " + std::to_string(flags.seed) + ", " + to_text(flags.rate_hz) +
                        " Hz";
  for (const std::string& left : made->left_out) {
    comment.append("; left out: ").append(left);
    std::fprintf(stderr, "driftlab: left out: %s\n", left.c_str());
  }
  if (const Status written = write_table(flags.out, comment, made->table); !written) {
    return complain(written.error());
  }
  say_columns(flags, made->table);
  return Exit::Success;
}

/// All axes along a drive, with fixes and truth.
Exit write_drive(const SimulateFlags& flags) {
  auto scenario = read_scenario(flags.scenario);
  if (!scenario) {
    return complain(scenario.error());
  }
  const auto drive =
      simulate_drive({std::move(*scenario), flags.seed, flags.run, !flags.gnss.empty(), !flags.truth.empty()});
  if (!drive) {
    return complain(drive.error());
  }
  const std::string about = provenance(flags);
  Status written =
      write_table(flags.out, about + "; each row is the mean over the interval that ends at t", drive->imu);
  const auto& fixes = drive->fixes;
  const auto& truth = drive->truth;
  if (written && fixes) {
    written =
        write_table(flags.gnss, about + "; fixes; t is when one arrives, validity the moment it describes", *fixes);
  }
  if (written && truth) {
    written = write_table(flags.truth, about + "; truth", *truth);
  }
  return written ? Exit::Success : complain(written.error());
}

Exit run(const SimulateFlags& flags) {
  if (!flags.scenario.empty()) {
    return write_drive(flags);
  }
  return flags.model.empty() ? write_preset(flags) : write_model(flags);
}

}  // namespace

void add_simulate(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand(
      "simulate", "Write a recording simulated from an error model, of one axis or of a whole drive");
  const auto flags = std::make_shared<SimulateFlags>();
  command->add_option("--preset", flags->preset, "Published model: iphone5s-z (Radi et al. 2017, Table 4)")
      ->capture_default_str();
  command->add_option("--model", flags->model,
                      "JSON file in place of a preset: a model with its effects, an investigation's report, a fit");
  command->add_option("--channel", flags->channel, "Column of the model (its first)");
  command->add_option("--condition", flags->condition, "Dynamic condition of the source's table")
      ->capture_default_str();
  command->add_option("--rate-hz", flags->rate_hz, "Sampling rate")->check(CLI::Range(0.1, 1e5))->capture_default_str();
  command->add_option("--duration-s", flags->duration_s, "Length")->check(CLI::Range(1.0, 1e6))->capture_default_str();
  command->add_option("--seed", flags->seed, "Same seed, same recording")->capture_default_str();
  command->add_option("--out", flags->out, "File to write: .npy, or else CSV; .gz packs it")->required();
  command->add_option("--scenario", flags->scenario,
                      "Inertial unit along the drive of a scenario (see outages) in place of one axis");
  command->add_option("--run", flags->run, "Which Monte Carlo run of the scenario")->capture_default_str();
  command->add_option("--gnss", flags->gnss, "File for the scenario's fixes");
  command->add_option("--truth", flags->truth, "File for the scenario's true trajectory");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
