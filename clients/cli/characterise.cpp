#include "clients/cli/analysis.hpp"
#include "clients/cli/left_out_lines.hpp"
#include "clients/cli/plot_file.hpp"
#include "schema/json/told_characterisation.hpp"
#include "schema/text/characterisation.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace driftlab::cli {
namespace {

struct CharacteriseFlags {
  std::vector<std::string> files;
  FileFlags file;
  std::string server;
  std::vector<std::string> models;
  std::uint64_t seed = 1;
  bool stepwise = false;
  std::size_t bootstrap = 0;
  std::size_t dynamic = 0;
  FurtherRequest also;
  double from_tau_s = 0.0;
  bool json = false;
  std::string plot;
};

/// What was found, as its document, where it is printed, drawn or came from a daemon, and as what its text is made of.
struct Found {
  Json document;
  TabledCampaign campaign;
  std::vector<ToldRecording> told;
};

tl::expected<Found, Failure> here(const Inputs& inputs, const CharacteriseOptions& options,
                                  const CharacteriseFlags& flags) {
  const auto campaign = characterise_here(inputs, options);
  if (!campaign) {
    return tl::unexpected(campaign.error());
  }
  Found found;
  if (flags.json || !flags.plot.empty()) {
    found.document = as_document(*campaign, inputs);
  }
  if (!flags.json) {
    found.campaign = tabled(*campaign);
    found.told = told_of(campaign->recordings);
  }
  return found;
}

tl::expected<Found, Failure> there(const Inputs& inputs, const CharacteriseOptions& options,
                                   const CharacteriseFlags& flags) {
  auto document = characterise_there(inputs, options, flags.server);
  if (!document) {
    return tl::unexpected(document.error());
  }
  if (flags.json) {
    return Found{std::move(*document), {}, {}};
  }
  *document = named_as_here(std::move(*document), inputs);
  auto campaign = tabled_from_json(*document);
  if (!campaign) {
    return tl::unexpected(Failure{campaign.error(), Exit::BadInput});
  }
  auto told = told_from_json(*document);
  if (!told) {
    return tl::unexpected(Failure{told.error(), Exit::BadInput});
  }
  return Found{std::move(*document), std::move(*campaign), std::move(*told)};
}

Exit run(const CharacteriseFlags& flags) {
  CharacteriseOptions options;
  options.seed = flags.seed;
  options.search = flags.stepwise ? ModelSearch::Stepwise : ModelSearch::Listed;
  options.bootstrap = flags.bootstrap;
  options.dynamic = flags.dynamic;
  options.also = flags.also;
  options.from_tau_s = flags.from_tau_s;
  if (!flags.models.empty()) {
    options.models = flags.models;
  }
  if (auto checked = check_options(options); !checked) {
    return complain(checked.error());
  }
  auto inputs = read_inputs(flags.files, flags.file);
  if (!inputs) {
    return complain(inputs.error());
  }
  auto found = flags.server.empty() ? here(*inputs, options, flags) : there(*inputs, options, flags);
  if (!found) {
    return complain(found.error().error, found.error().exit);
  }
  const auto& [document, campaign, told] = *found;
  if (!flags.plot.empty()) {
    if (auto drawn = write_plots(document, flags.plot); !drawn) {
      return complain(drawn.error());
    }
  }
  const std::string text = flags.json ? document.dump(2) + "\n"
                                      : verdicts_to_text(told) + "\n" +
                                            tables_of(campaign, inputs->device, inputs->hardware, TableNames::AsTyped) +
                                            further_to_text(told);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return Exit::Success;
}

}  // namespace

void add_characterise(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand(
      "characterise",
      "Variances, Allan coefficients and ranked error models of recordings (CSV, .npy; also .gz .xz .zst) or "
      "of a study.json");
  const auto flags = std::make_shared<CharacteriseFlags>();
  command->add_option("FILE", flags->files, "Recordings that share the flags below, or one study.json")->required();
  command->add_option("--rate-hz", flags->file.rate_hz, "Sampling rate; needed without a time column");
  command->add_option(
      "--columns", flags->file.columns,
      "NAME=QUANTITY:AXIS:UNIT,… e.g. gz=angular_rate:z:deg/s; columns without names are 0, 1, …; counts have "
      "their scale and offset with the unit: gx=angular_rate:x:deg/s/131,temp=temperature::degC/340+36.53");
  command->add_option("--stream", flags->file.stream,
                      "Of the units of a log or table the one that is meant, as its columns begin, e.g. imu2");
  command->add_option("--condition", flags->file.condition, "static, constant_rate:z:9:deg/s, …")
      ->capture_default_str();
  command->add_option("--device", flags->file.device,
                      "Device the recordings belong to; default: the first file's name");
  add_left_out_lines(*command, flags->file);
  command->add_option("--calibration", flags->file.calibration,
                      "Correct the readings by what `driftlab calibrate --json` wrote to this file");
  command
      ->add_option("--models", flags->models,
                   "Candidate models, e.g. WN,WN+GM; default: the nine of Radi et al. (2017)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--stepwise", flags->stepwise,
                    "Go on from the best of the models, process by process over all that are known");
  command
      ->add_option("--bootstrap", flags->bootstrap,
                   "Series (40 to 2000) simulated to calibrate the best model's intervals; 0: none")
      ->capture_default_str();
  command->add_flag("--dynamic{32}", flags->dynamic,
                    "Add the Allan deviation of 32 windows that move along time (--dynamic=N of N) to --json");
  command->add_option("--taus", flags->also.taus, "Allan deviation at so many tau, evenly spaced in the logarithm")
      ->default_val(0);
  command->add_flag("--total", flags->also.total, "Total deviation for tau up to half of the recording");
  command->add_flag("--theo1", flags->also.theo1, "Theo1 for tau up to three quarters of the recording");
  command->add_flag("--psd", flags->also.psd, "Power spectral density with its lines");
  command
      ->add_option("--from-tau", flags->from_tau_s,
                   "Fit models to the scales of tau from here on [s], where a filter rules the first ones")
      ->capture_default_str();
  command->add_option("--seed", flags->seed, "Seed of random draws")->capture_default_str();
  command->add_option("--server", flags->server, "Run through the daemon at this address, e.g. http://127.0.0.1:8477");
  add_plot_flag(*command, flags->plot);
  command->add_flag("--json", flags->json, "Print the characterisation document instead of tables");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
