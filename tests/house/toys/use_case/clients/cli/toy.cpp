#include "core/analysis/toy.hpp"

#include "clients/cli/cli.hpp"
#include "clients/cli/input.hpp"
#include "clients/cli/local_files.hpp"
#include "schema/json/toy.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace driftlab::cli {
namespace {

struct Flags {
  std::vector<std::string> files;
  FileFlags file;
};

Exit run(const Flags& flags) {
  auto inputs = read_inputs(flags.files, flags.file);
  if (!inputs) {
    return complain(inputs.error());
  }
  auto recordings = LocalFiles::of(*inputs);
  if (!recordings) {
    return complain(recordings.error());
  }
  const auto report = toy(**recordings, {interrupt_token(), {}});
  if (!report) {
    return complain_of_work(report.error());
  }
  const std::string text = to_json(*report).dump(2) + "\n";
  std::fwrite(text.data(), 1, text.size(), stdout);
  return Exit::Success;
}

}  // namespace

void add_toy(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand("toy", "The mean reading of every channel");
  const auto flags = std::make_shared<Flags>();
  command->add_option("FILE", flags->files, "Recordings, or one study.json")->required();
  command->add_option("--rate-hz", flags->file.rate_hz, "Sampling rate; needed without a time column");
  command->add_option("--columns", flags->file.columns, "NAME=QUANTITY:AXIS:UNIT,…");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
