#include "server/places/place.hpp"
#include "server/store/postgres/advisory_locks.hpp"
#include "server/store/s3/keys.hpp"
#include "server/store/s3/object_files.hpp"
#include "server/store/sql/database.hpp"

namespace driftlab::server {
namespace {

/// All daemons and workers share it; it is held until the transaction ends.
s3::NamesLock lock_of(Database& database) {
  return [&database](const std::string& blob, const std::function<Status()>& inside) -> Status {
    return database
        .write(WriteKind::Fenced,
               [&](Connection& connection) -> Result<int> {
                 {
                   Statement taken = connection.prepare(advisory_locks::kTakeBlob);
                   taken.bind(blob);
                   if (const auto row = taken.step(); !row) {
                     return fail(row.error());
                   }
                 }
                 const Status done = inside();
                 return done ? Result<int>(0) : fail(done.error());
               })
        .map([](int) {});
  };
}

Status bind_bucket(s3::ObjectFiles& files, const s3::Place& place, OpenedStore& store) {
  PlaceMark mark{"the bucket " + place.bucket + (place.prefix.empty() ? "" : " under " + place.prefix),
                 "nobody who says so", [&files] { return files.mark(); }, [&files] { return files.is_empty(); },
                 [&files](const std::string& word) { return files.write_mark(word); }};
  return bind_place(mark, store);
}

Result<std::unique_ptr<BlobStore>> open(const Settings& settings, OpenedStore& store) {
  const auto place = s3::read_place(settings.blobs);
  if (!place) {
    return fail(place.error());
  }
  auto key = s3::find_key(settings.blobs_credentials);
  if (!key) {
    return fail(key.error());
  }
  auto files = std::make_unique<s3::ObjectFiles>(*place, std::move(*key), lock_of(*store.database));
  if (Status bound = bind_bucket(*files, *place, store); !bound) {
    return fail(bound.error());
  }
  return open_copied(settings, std::move(files));
}

}  // namespace

BlobPlace in_object_storage() {
  return {"s3://BUCKET/PREFIX?endpoint=https://HOST&region=NAME",
          [](const std::string& value) { return value.starts_with("s3:"); },
          [](const std::string& value) {
            const auto read = s3::read_place(value);
            return read ? std::string() : read.error().message;
          },
          [](const Settings& /*settings*/) { return std::optional<std::filesystem::path>(); }, open};
}

}  // namespace driftlab::server
