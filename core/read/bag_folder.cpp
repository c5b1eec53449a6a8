#include "core/read/bag_folder.hpp"

#include "core/read/inertial_streams.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace driftlab {
namespace {

bool is_bag_file(std::filesystem::path name) {
  if (name.extension() == ".zstd" || name.extension() == ".zst") {
    name = name.stem();
  }
  return name.extension() == ".db3" || name.extension() == ".mcap";
}

}  // namespace

Result<std::optional<std::filesystem::path>> find_bag_file(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> parts;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error) && is_bag_file(entry.path().filename())) {
      parts.push_back(entry.path());
    }
  }
  if (error) {
    return fail(ErrorCode::Io, "The directory '" + folder.filename().string() + "' cannot be read.");
  }
  if (parts.size() > 1) {
    std::sort(parts.begin(), parts.end());
    NameList names(kMostNames);
    for (const std::filesystem::path& part : parts) {
      names.add(quoted_name(part.filename().string()));
    }
    return fail(ErrorCode::UnsupportedFormat, "The bag is split into " + std::to_string(parts.size()) + " files, " +
                                                  names.text() +
                                                  ": name one of them, or join them first (`ros2 bag convert`).");
  }
  return parts.empty() ? std::optional<std::filesystem::path>() : std::optional(parts.front());
}

}  // namespace driftlab
