#include "core/analysis/plan.hpp"

#include "clients/cli/cli.hpp"
#include "clients/cli/input.hpp"
#include "clients/cli/local_files.hpp"
#include "clients/cli/progress.hpp"
#include "clients/cli/study_request.hpp"
#include "schema/json/campaign_plan.hpp"
#include "schema/json/investigation.hpp"
#include "schema/text/campaign_plan.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <thread>

namespace driftlab::cli {
namespace {

struct PlanFlags {
  std::string study;
  std::string out;
  std::size_t runs = 6;
  std::uint64_t seed = 1;
  bool json = false;
};

Exit run(const PlanFlags& flags) {
  auto inputs = read_inputs({flags.study}, {});
  if (!inputs) {
    return complain(inputs.error());
  }
  auto investigation = investigation_request(*inputs);
  if (!investigation) {
    return complain(investigation.error());
  }
  auto recordings = LocalFiles::of(*inputs);
  if (!recordings) {
    return complain(recordings.error());
  }
  ProgressBar bar;
  Executor executor(std::thread::hardware_concurrency());
  const RunControl control{
      interrupt_token(), [&](std::string_view stage, double f) { bar.show(stage, f); }, {&executor}};
  const PlanRequest request{*std::move(investigation), {flags.runs, flags.seed}};
  auto planned = plan_study(request, **recordings, control);
  if (!planned) {
    return complain_of_work(planned.error());
  }
  Json plan = to_json(planned->plan);
  plan["study"] = planned->report.study;
  if (!flags.out.empty()) {
    Json report = to_json(planned->report);
    report["plan"] = plan;
    if (!write_file(flags.out, report.dump(2) + "\n")) {
      return complain({ErrorCode::Io, "The file " + flags.out + " cannot be written.", {}});
    }
  }
  const std::string text = flags.json ? plan.dump(2) + "\n" : plan_to_text(planned->plan);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return Exit::Success;
}

}  // namespace

void add_plan(CLI::App& app, Command& chosen) {
  CLI::App* const command =
      app.add_subcommand("plan", "Propose the recordings that would decide most of what an investigation leaves open");
  const auto flags = std::make_shared<PlanFlags>();
  command->add_option("STUDY", flags->study, "study.json beside its recordings")->required();
  command->add_option("--runs", flags->runs, "Simulated studies for each question and proposal (6)")
      ->check(CLI::Range(1, 1000));
  command->add_option("--seed", flags->seed, "Seed of the simulations (1)");
  command->add_option("--out", flags->out, "Write the report of the investigation with its plan to this file");
  command->add_flag("--json", flags->json, "Print the plan document instead of lines");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
