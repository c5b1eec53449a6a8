#include "server/places/place.hpp"

#include "server/store/copied_blobs.hpp"

#include <algorithm>
#include <filesystem>

namespace driftlab::server {

const std::vector<BlobPlace>& all_blob_places() {
  static const std::vector<BlobPlace> all{
      own_directory(),
      in_database(),
      shared_folder(),
      in_object_storage(),
  };
  return all;
}

const BlobPlace* find_blob_place(const std::string& value) {
  const auto& all = all_blob_places();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const BlobPlace& place) { return place.is_meant(value); });
  return found == all.end() ? nullptr : &*found;
}

std::string meanings_of_blob_places() {
  const auto& all = all_blob_places();
  std::string meanings;
  for (std::size_t i = 0; i < all.size(); ++i) {
    meanings.append(i == 0 ? "" : i + 1 < all.size() ? ", " : ", or ").append(all[i].meaning);
  }
  return meanings;
}

Result<std::unique_ptr<BlobStore>> open_copied(const Settings& settings, std::unique_ptr<RemoteFiles> remote) {
  const std::filesystem::path copies = settings.data / "copies";
  auto local = open_blob_directory(copies);
  if (!local) {
    return local;
  }
  return std::make_unique<CopiedBlobs>(std::move(remote), std::move(*local), copies,
                                       static_cast<std::uintmax_t>(settings.cache_megabytes) * 1'000'000);
}

Status bind_place(const PlaceMark& mark, OpenedStore& store) {
  const std::vector<ErrorField> fields = {{"parameter", "blobs"}};
  const auto word = mark.read();
  if (!word) {
    return fail(word.error());
  }
  if (!word->empty()) {
    return *word == store.identity
               ? Status{}
               : fail(ErrorCode::Conflict,
                      "T" + mark.place.substr(1) + " keeps the recordings of another database than --store.", fields);
  }
  const auto empty = mark.is_empty();
  if (!empty) {
    return fail(empty.error());
  }
  if (!*empty) {
    return fail(ErrorCode::Conflict,
                "T" + mark.place.substr(1) + " keeps the recordings of " + mark.stranger +
                    "; name an empty one for the PostgreSQL database.",
                fields);
  }
  const auto hashes = store.store->blob_hashes();
  if (!hashes) {
    return fail(hashes.error());
  }
  if (!hashes->empty()) {
    return fail(ErrorCode::Conflict,
                "The recordings of the database are not in " + mark.place + "; name the place that keeps them.",
                fields);
  }
  return mark.write(store.identity);
}

}  // namespace driftlab::server
