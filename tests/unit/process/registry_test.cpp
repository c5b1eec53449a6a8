#include "core/process/registry.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace driftlab {
namespace {

/// A file of the source tree; empty where a test runs without one.
std::string source_text(const std::string& path) {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): tests read their environment before they start anything
  const char* const root = std::getenv("DRIFTLAB_SOURCE");
  std::ifstream in(root != nullptr ? std::string(root) + "/" + path : path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Registry, EveryProcessStandsInTheManualWithItsParameters) {
  const std::string page = source_text("schema/docs/processes.md");
  ASSERT_FALSE(page.empty());
  for (const ProcessKind& kind : process_registry()) {
    const std::size_t row = page.find("\n| " + std::string(kind.symbol) + " | `" + std::string(kind.name) + "` | ");
    ASSERT_NE(row, std::string::npos) << kind.name;
    const std::string line = page.substr(row + 1, page.find('\n', row + 1) - row - 1);
    for (const ParameterSpec& spec : kind.parameters) {
      EXPECT_NE(line.find("`" + std::string(spec.name) + "`"), std::string::npos) << kind.name << ": " << spec.name;
    }
  }
}

TEST(Registry, ScenariosTakeEveryProcess) {
  const std::string schema = source_text("schema/outage-scenario.schema.json");
  ASSERT_FALSE(schema.empty());
  for (const ProcessKind& kind : process_registry()) {
    EXPECT_NE(schema.find("\"" + std::string(kind.name) + "\""), std::string::npos) << kind.name;
  }
}

}  // namespace
}  // namespace driftlab
