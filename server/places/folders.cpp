#include "server/places/place.hpp"
#include "server/store/files.hpp"

#include <filesystem>
#include <fstream>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

/// Rows in SQLite lie in the directory itself and need no mark.
Status bind_directory(const fs::path& data, OpenedStore& store) {
  if (store.identity.empty()) {
    return {};
  }
  const fs::path file = data / kIdentityFile;
  PlaceMark mark{"the directory " + data.string(), "an SQLite store", {}, {}, {}};
  mark.read = [file]() -> Result<std::string> {
    std::ifstream stream(file);
    std::string word;
    stream >> word;
    return word.empty() && is_there(file) ? "unreadable" : word;
  };
  mark.is_empty = [data]() -> Result<bool> { return !is_there(data / kSqliteFile) && !is_there(data / "blobs"); };
  mark.write = [data, file](const std::string& word) -> Status {
    const Status made = make_directories(data);
    return made ? write_secret_file(file, word + "\n") : made;
  };
  return bind_place(mark, store);
}

}  // namespace

BlobPlace own_directory() {
  return {"nothing for --data", [](const std::string& value) { return value.empty(); },
          [](const std::string& /*value*/) { return std::string(); },
          [](const Settings& settings) -> std::optional<fs::path> { return settings.data; },
          [](const Settings& settings, OpenedStore& store) -> Result<std::unique_ptr<BlobStore>> {
            const Status bound = bind_directory(settings.data, store);
            return bound ? open_blob_directory(settings.data) : fail(bound.error());
          }};
}

BlobPlace shared_folder() {
  return {"the absolute path of a folder", [](const std::string& value) { return value.starts_with('/'); },
          [](const std::string& /*value*/) { return std::string(); },
          [](const Settings& settings) -> std::optional<fs::path> { return settings.blobs; },
          [](const Settings& settings, OpenedStore& store) -> Result<std::unique_ptr<BlobStore>> {
            const Status bound = bind_directory(settings.blobs, store);
            return bound ? open_shared_blob_directory(settings.blobs) : fail(bound.error());
          }};
}

}  // namespace driftlab::server
