#include "schema/text/outages.hpp"

#include "clients/cli/cli.hpp"
#include "clients/cli/plot_file.hpp"
#include "clients/cli/progress.hpp"
#include "clients/cli/remote_job.hpp"
#include "clients/cli/scenario_input.hpp"
#include "schema/json/outage_evaluation.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <thread>

namespace driftlab::cli {
namespace {

struct OutagesFlags {
  std::string scenario = "paper";
  int runs = 400;
  std::uint64_t seed = 1;
  double precision = 0.0;
  int threads = 0;
  bool json = false;
  std::string server;
  std::string plot;
};

Status draw_result(const OutagesFlags& flags, const Json& document) {
  return flags.plot.empty() ? Status{} : write_plots(document, flags.plot);
}

/// The same evaluation as a job of a daemon, which may name its stored fits and tables.
Exit run_there(const OutagesFlags& flags) {
  auto scenario = scenario_document(flags.scenario);
  if (!scenario) {
    return complain(scenario.error());
  }
  auto client = HttpClient::to(flags.server);
  if (!client) {
    return complain(client.error());
  }
  const Json request{
      {"kind", "outage_evaluation"},
      {"inputs", {{"scenario", std::move(*scenario)}}},
      {"parameters", {{"runs", flags.runs}, {"seed", flags.seed}, {"relative_precision", flags.precision}}}};
  tl::expected<Json, Failure> document;
  {
    ProgressBar bar;
    document = run_job(*client, request, bar);
  }
  if (!document) {
    return complain(document.error().error, document.error().exit);
  }
  if (auto drawn = draw_result(flags, *document); !drawn) {
    return complain(drawn.error());
  }
  const std::string text = document->dump(2) + "\n";
  std::fwrite(text.data(), 1, text.size(), stdout);
  return Exit::Success;
}

Exit run(const OutagesFlags& flags) {
  if (!flags.server.empty()) {
    return run_there(flags);
  }
  auto scenario = read_scenario(flags.scenario);
  if (!scenario) {
    return complain(scenario.error());
  }
  OutageOptions options;
  options.runs = flags.runs;
  options.seed = flags.seed;
  options.relative_precision = flags.precision;
  Executor executor(flags.threads > 0 ? static_cast<unsigned>(flags.threads) : std::thread::hardware_concurrency());
  RunControl control;
  control.stop = interrupt_token();
  control.threads.executor = &executor;
  Result<OutageReport> report;
  {
    ProgressBar bar;
    control.progress = [&](std::string_view stage, double fraction) { bar.show(stage, fraction); };
    report = report_outages(*scenario, options, control);
  }
  if (!report) {
    return complain_of_work(report.error());
  }
  if (auto drawn = flags.plot.empty() ? Status{} : draw_result(flags, to_json(*report)); !drawn) {
    return complain(drawn.error());
  }
  const std::string text = flags.json ? to_json(*report).dump(2) + "\n" : outage_text(*report);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return Exit::Success;
}

}  // namespace

void add_outages(CLI::App& app, Command& chosen) {
  CLI::App* const command =
      app.add_subcommand("outages", "Compare what error models are worth in navigation through GNSS outages");
  const auto flags = std::make_shared<OutagesFlags>();
  command
      ->add_option("--scenario", flags->scenario,
                   "paper, paper-position-only, paper-nhc, paper-s-curves, or a scenario.json")
      ->capture_default_str();
  command->add_option("--runs", flags->runs, "Monte Carlo runs, at most")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
  command->add_option("--seed", flags->seed, "Same seed, same result, for any number of threads")
      ->check(CLI::Range(std::uint64_t{0}, static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())))
      ->capture_default_str();
  command
      ->add_option("--precision", flags->precision,
                   "Stop once every mean error is known to this half-width, relative to it; 0: never")
      ->check(CLI::Range(0.0, 0.99))
      ->capture_default_str();
  command->add_option("--threads", flags->threads, "Threads; 0: one per processor")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("--server", flags->server, "Address of a daemon that does the work; prints the result document");
  add_plot_flag(*command, flags->plot);
  command->add_flag("--json", flags->json, "Print the result document instead of tables");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
