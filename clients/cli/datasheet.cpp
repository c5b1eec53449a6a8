#include "clients/cli/cli.hpp"
#include "clients/cli/print_answer.hpp"
#include "schema/json/data_sheet.hpp"
#include "schema/text/data_sheet.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace driftlab::cli {
namespace {

struct DatasheetFlags {
  std::string model;
  bool json = false;
};

Exit run(const DatasheetFlags& flags) {
  if (flags.model.empty()) {
    return write_text("", flags.json ? data_sheets_document(data_sheets()).dump(2) + "\n" : data_sheets_to_text());
  }
  const auto sheet = find_data_sheet(flags.model);
  if (!sheet) {
    return complain(sheet.error());
  }
  return write_text("", flags.json ? to_json(**sheet).dump(2) + "\n" : data_sheet_to_text(**sheet));
}

}  // namespace

void add_datasheet(CLI::App& app, Command& chosen) {
  CLI::App* const command =
      app.add_subcommand("datasheet", "What the manufacturer states of a sensor, with the source");
  const auto flags = std::make_shared<DatasheetFlags>();
  command->add_option("MODEL", flags->model,
                      "MPU-6050, 'phone with LSM6DSO', …; without it the known sensors are listed");
  command->add_flag("--json", flags->json, "Print the document instead of text");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
