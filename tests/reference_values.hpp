#pragma once
/// Values that peers computed and that are part of the repository (tests/data/reference/README.md).
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace driftlab {

/// The document tests/data/reference/`name`, found through DRIFTLAB_SOURCE (ctest sets it), else from the repository's
/// root. One that is missing is a fault of the checkout and fails the test: there is nothing to skip.
inline nlohmann::json reference_values(const std::string& name) {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): tests read the environment before they start threads
  const char* const source = std::getenv("DRIFTLAB_SOURCE");
  const std::filesystem::path path =
      std::filesystem::path(source != nullptr ? source : ".") / "tests" / "data" / "reference" / name;
  std::ifstream file(path);
  if (!file) {
    throw std::runtime_error("no reference values in " + path.string() + "; run from the repository, or by ctest");
  }
  return nlohmann::json::parse(file);
}

/// The models that the peer's fits are of: as their values name them, and as driftlab does.
inline const std::vector<std::pair<std::string, std::string>>& reference_models() {
  static const std::vector<std::pair<std::string, std::string>> names{{"WN", "WN"},
                                                                      {"WN+AR1", "WN+GM"},
                                                                      {"WN+RW", "WN+RW"},
                                                                      {"WN+2AR1", "WN+2GM"},
                                                                      {"WN+AR1+RW", "WN+GM+RW"},
                                                                      {"QN+WN+AR1+RW", "QN+WN+GM+RW"},
                                                                      {"WN+AR1+DR", "WN+GM+DR"}};
  return names;
}

}  // namespace driftlab
