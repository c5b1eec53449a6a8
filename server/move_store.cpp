#include "server/move_store.hpp"

#include "server/move_rows.hpp"
#include "server/open_store.hpp"
#include "server/store/checksums.hpp"
#include "server/store/files.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <span>
#include <system_error>
#include <vector>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPieceBytes = 1U << 20U;

bool is_database(const std::string& place) {
  return place.starts_with("postgresql://") || place.starts_with("postgres://");
}

/// One side of the move.
struct Side {
  OpenedStore store;
  std::unique_ptr<BlobStore> blobs;
};

Result<Side> open_side(const Settings& settings, const Clock& clock) {
  auto store = open_store(settings, clock);
  if (!store) {
    return fail(store.error());
  }
  if (store->others != nullptr && !store->others->came_first()) {
    return fail(ErrorCode::Conflict, "Daemons or workers work with the database; stop them before it is moved.",
                {{"parameter", "store"}});
  }
  auto blobs = open_blobs(settings, *store);
  if (!blobs) {
    return fail(blobs.error());
  }
  return Side{std::move(*store), std::move(*blobs)};
}

/// The mark of a move that is under way, `WHERE\n`.
Status begin_or_go_on(const fs::path& mark, const std::string& what, Database& target) {
  std::ifstream stream(mark);
  std::string line;
  if (stream && std::getline(stream, line)) {
    return line == what ? Status{}
                        : fail(ErrorCode::Conflict,
                               "The store in " + mark.parent_path().string() +
                                   " is being moved by another command: " + line + "; end that first.",
                               {{"path", mark.string()}});
  }
  const auto empty = has_no_rows(target);
  if (!empty) {
    return fail(empty.error());
  }
  if (!*empty) {
    return fail(ErrorCode::Conflict, "The target holds rows already; name an empty one.", {{"parameter", "to"}});
  }
  return write_secret_file(mark, what + "\n");
}

bool is_sound(const BlobStore& blobs, const std::string& sha256) {
  const auto bytes = check_bytes(blobs.bytes_path(sha256), sha256);
  const auto columns = check_columns(blobs.columns_path(sha256));
  return bytes && columns && *bytes == FileState::Sound && *columns == FileState::Sound;
}

Status append_file(IncomingBlob& target, const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> piece(kPieceBytes);
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto got = static_cast<std::size_t>(stream.gcount());
    if (Status appended = target.append(std::as_bytes(std::span(piece.data(), got))); !appended) {
      return appended;
    }
  }
  return target.seal();
}

Status duplicate(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
  return error ? Status(fail(file_error(error.value(), "copy", from))) : Status{};
}

Status copy_blob(const BlobStore& from, BlobStore& to, const std::string& sha256) {
  if (!is_sound(from, sha256)) {
    return fail(ErrorCode::Io,
                "The recording " + sha256 + " is damaged where it is; heal it (driftlabd check) before it is moved.",
                {{"blob", sha256}});
  }
  auto incoming = to.begin();
  if (!incoming) {
    return fail(incoming.error());
  }
  if (Status appended = append_file(**incoming, from.bytes_path(sha256)); !appended) {
    return appended;
  }
  const fs::path columns = from.columns_path(sha256);
  if (Status copied = duplicate(columns, (*incoming)->columns_path()); !copied) {
    return copied;
  }
  std::error_code none;
  if (fs::exists(pyramid_path(columns), none)) {
    if (Status copied = duplicate(pyramid_path(columns), pyramid_path((*incoming)->columns_path())); !copied) {
      return copied;
    }
  }
  if (Status kept = (*incoming)->keep(); !kept) {
    return kept;
  }
  return is_sound(to, sha256)
             ? Status{}
             : fail(ErrorCode::Io, "The recording " + sha256 + " was not copied as it is.", {{"blob", sha256}});
}

}  // namespace

Result<MovedStore> move_store(const Settings& settings, const std::string& from, const std::string& to) {
  if (is_database(from) == is_database(to)) {
    return fail(ErrorCode::InvalidArgument,
                "A lab is moved from a directory to postgresql://USER@HOST/DATABASE or back; name one of each.",
                {{"parameter", "from"}});
  }
  Settings of_directory = settings;
  of_directory.store.clear();
  of_directory.blobs.clear();
  of_directory.data = is_database(from) ? to : from;
  Settings of_database = settings;
  of_database.store = is_database(from) ? from : to;
  of_database.serves_api = true;
  const fs::path mark = of_directory.data / kMovingFile;
  const std::string what =
      (is_database(from) ? "from " : "to ") + without_password(of_database.store) + " " + settings.blobs;
  const SystemClock clock;
  of_directory.is_moving = true;
  auto directory = open_side(of_directory, clock);
  if (!directory) {
    return fail(directory.error());
  }
  auto database = open_side(of_database, clock);
  if (!database) {
    return fail(database.error());
  }
  Side& source = is_database(from) ? *database : *directory;
  Side& target = is_database(from) ? *directory : *database;
  if (Status begun = begin_or_go_on(mark, what, *target.store.database); !begun) {
    return fail(begun.error());
  }
  const auto hashes = source.store.store->blob_hashes();
  if (!hashes) {
    return fail(hashes.error());
  }
  MovedStore moved;
  moved.tables = static_cast<int>(moved_tables().size());
  for (const std::string& sha256 : *hashes) {
    ++moved.blobs;
    if (is_sound(*target.blobs, sha256)) {
      continue;
    }
    if (Status copied = copy_blob(*source.blobs, *target.blobs, sha256); !copied) {
      return fail(copied.error());
    }
    ++moved.new_blobs;
  }
  const auto rows = copy_rows(*source.store.database, *target.store.database);
  if (!rows) {
    return fail(rows.error());
  }
  moved.rows = rows->rows;
  moved.new_rows = rows->new_rows;
  if (Status same = compare_rows(*source.store.database, *target.store.database); !same) {
    return fail(same.error());
  }
  if (Status ended = remove_file(mark); !ended) {
    return fail(ended.error());
  }
  return moved;
}

}  // namespace driftlab::server
