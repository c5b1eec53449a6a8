#pragma once
/// The folder that `ros2 bag record` makes: `metadata.yaml` beside one file of messages, or several where the bag is
/// split. Internal to core/read.
#include "core/signal/result.hpp"

#include <filesystem>
#include <optional>

namespace driftlab {

/// The file of messages (`.db3`, `.mcap`, each also behind `.zstd` or `.zst`) of a folder; nothing where
/// there is none. Error: UnsupportedFormat (the bag is split: which files there
/// are), Io.
[[nodiscard]] Result<std::optional<std::filesystem::path>> find_bag_file(const std::filesystem::path& folder);

}  // namespace driftlab
