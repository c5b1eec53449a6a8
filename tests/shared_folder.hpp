#pragma once
/// Recordings that are not part of the repository: where they lie, or that they do not.
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string_view>

namespace driftlab {

/// The folder that DRIFTLAB_SHARED names, else the one called `shared` beside the repository (ctest sets
/// DRIFTLAB_SOURCE). Nothing where it does not hold `part`, said loudly: a skipped test is not a passed one.
inline std::optional<std::filesystem::path> shared_folder(std::string_view part = "data") {
  // NOLINTBEGIN(concurrency-mt-unsafe): tests read the environment before they start threads
  const char* const stated = std::getenv("DRIFTLAB_SHARED");
  const char* const source = std::getenv("DRIFTLAB_SOURCE");
  // NOLINTEND(concurrency-mt-unsafe)
  std::filesystem::path path = stated != nullptr && *stated != '\0'
                                   ? std::filesystem::path(stated)
                                   : std::filesystem::path(source != nullptr ? source : ".") / ".." / "shared";
  if (std::filesystem::exists(path / part)) {
    return path;
  }
  std::cerr << "SKIPPED, NOT PASSED: no " << part << " in " << path << "; set DRIFTLAB_SHARED to the shared folder\n";
  return std::nullopt;
}

}  // namespace driftlab
