#pragma once
/// The wire contract inside the binary: `openapi.json` (made from openapi.yaml at build time), the JSON Schemas and the
/// user documentation, each under its path below schema/.
#include <string_view>
#include <vector>

namespace driftlab {

struct ContractFile {
  std::string_view name;  ///< `openapi.json`, `study.schema.json`, `docs/upload.md`
  std::string_view text;
};

[[nodiscard]] const std::vector<ContractFile>& contract_files();

/// The text of a file, or an empty view.
[[nodiscard]] inline std::string_view contract_file(std::string_view name) {
  for (const ContractFile& file : contract_files()) {
    if (file.name == name) {
      return file.text;
    }
  }
  return {};
}

}  // namespace driftlab
