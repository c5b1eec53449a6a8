// `driftlab convert`: any result for programs that read tables or MATLAB files.
#include "clients/cli/json_file.hpp"
#include "clients/cli/plot_file.hpp"
#include "clients/cli/print_answer.hpp"
#include "schema/json/flat_document.hpp"
#include "schema/json/mat_file.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <iostream>
#include <iterator>
#include <memory>

namespace driftlab::cli {
namespace {

struct ConvertFlags {
  std::string file;
  std::string job;
  std::string server = "http://127.0.0.1:8477";
  std::string output;
};

/// The document from a file, from standard input, or of a daemon's job.
tl::expected<Json, Failure> document_of(const ConvertFlags& flags) {
  if (!flags.job.empty()) {
    return fetch_document(flags.server, "/v1/jobs/" + percent_encode(flags.job) + "/result");
  }
  Result<Json> document = flags.file == "-" ? parse_json(std::string(std::istreambuf_iterator<char>(std::cin), {}))
                                            : read_json_file(flags.file, kWrittenByJson);
  if (!document) {
    return tl::unexpected(Failure{document.error(), Exit::BadInput});
  }
  return std::move(*document);
}

Exit run(const ConvertFlags& flags) {
  if (flags.file.empty() == flags.job.empty()) {
    return complain({ErrorCode::InvalidArgument, "Name one document, or a --job of a daemon.", {}});
  }
  const bool mat = flags.output.ends_with(".mat");
  if (!mat && !flags.output.ends_with(".csv") && flags.output != "-") {
    return complain(
        {ErrorCode::InvalidArgument,
         "The --output ends in .csv or .mat, or is - for CSV on standard output, not '" + flags.output + "'.",
         {}});
  }
  const auto document = document_of(flags);
  if (!document) {
    return complain(document.error().error, document.error().exit);
  }
  if (!mat) {
    return write_text(flags.output == "-" ? "" : flags.output, flat_csv(*document));
  }
  const auto bytes = mat_file(*document);
  return bytes ? write_text(flags.output, *bytes) : complain(bytes.error());
}

}  // namespace

void add_convert(CLI::App& app, Command& chosen) {
  CLI::App* const command =
      app.add_subcommand("convert", "Any result as CSV or as a MATLAB file, for R, MATLAB, Octave and spreadsheets");
  const auto flags = std::make_shared<ConvertFlags>();
  command->add_option("FILE", flags->file, "A document that --json wrote; - reads it from standard input");
  command->add_option("--job", flags->job, "The result of this job of a daemon instead");
  command->add_option("--server", flags->server, "Address of the daemon")->capture_default_str();
  command->add_option("--output", flags->output, "File (.csv, .mat); - prints CSV")->required();
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
