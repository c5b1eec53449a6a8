#pragma once
/// A program's page of the manual, in the language man of troff, from the same source as its --help.
#include "schema/shell/command_tree.hpp"

#include <string>
#include <utility>
#include <vector>

namespace driftlab {

/// What a page says beside the commands.
struct ManualFacts {
  int section = 1;
  std::string summary;  ///< one line, without a full stop
  std::string version;
  std::vector<std::pair<std::string, std::string>> exit_codes;  ///< code, meaning
  std::vector<std::pair<std::string, std::string>> files;       ///< path, meaning
  std::vector<std::string> see_also;                            ///< `driftlabd(8)`
};

/// The page. It holds no date, so that equal programs give equal pages.
[[nodiscard]] std::string manual_page(const ProgramCommand& program, const ManualFacts& facts);

}  // namespace driftlab
