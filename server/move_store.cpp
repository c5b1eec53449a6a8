#include "server/move_store.hpp"

#include "server/move_blobs.hpp"
#include "server/move_rows.hpp"
#include "server/open_store.hpp"
#include "server/store/files.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAheadFile = "moved-ahead";

bool is_database(const std::string& place) {
  return place.starts_with("postgresql://") || place.starts_with("postgres://");
}

/// One side of the move.
struct Side {
  OpenedStore store;
  std::unique_ptr<BlobStore> blobs;
};

/// `beside_others`: daemons and workers may go on with it.
Result<Side> open_side(const Settings& settings, const Clock& clock, bool beside_others = false) {
  auto store = open_store(settings, clock);
  if (!store) {
    return fail(store.error());
  }
  if (!beside_others && store->others != nullptr && !store->others->came_first()) {
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

/// What a move is from and to.
struct Plan {
  Settings of_directory;
  Settings of_database;
  bool to_database = true;
  fs::path mark;
  std::string what;  ///< `to postgresql://... database`
};

Result<Plan> plan(const Settings& settings, const std::string& from, const std::string& to) {
  if (is_database(from) == is_database(to)) {
    return fail(ErrorCode::InvalidArgument,
                "A lab is moved from a directory to postgresql://USER@HOST/DATABASE or back; name one of each.",
                {{"parameter", "from"}});
  }
  Plan made{settings, settings, is_database(to), {}, {}};
  made.of_directory.store.clear();
  made.of_directory.blobs.clear();
  made.of_directory.data = made.to_database ? from : to;
  made.of_directory.is_moving = true;
  made.of_database.store = made.to_database ? to : from;
  made.of_database.serves_api = true;
  made.mark = made.of_directory.data / kMovingFile;
  made.what = (made.to_database ? "to " : "from ") + without_password(made.of_database.store) + " " + settings.blobs;
  return made;
}

AheadList ahead_list(const Plan& plan, const Side& target) {
  return {plan.of_directory.data / kAheadFile, plan.what + " " + target.store.identity};
}

/// Copies what of `hashes` is not there; `passes_over_damaged`: what is damaged or gone at its source is not missed.
Status copy_blobs(const std::vector<std::string>& hashes, const BlobFiles& from, BlobStore& to, AheadList& ahead,
                  bool passes_over_damaged, MovedStore& moved) {
  const auto there = to.hashes_older_than(std::chrono::microseconds(0));
  if (!there) {
    return fail(there.error());
  }
  ahead.keep(*there);
  for (const std::string& sha256 : hashes) {
    ++moved.blobs;
    if (ahead.holds(sha256)) {
      continue;
    }
    if (!is_sound(files_of(to), sha256)) {
      if (passes_over_damaged && !is_sound(from, sha256)) {
        --moved.blobs;
        continue;
      }
      if (Status copied = copy_blob(from, to, sha256); !copied) {
        return copied;
      }
      ++moved.new_blobs;
    }
    if (Status noted = ahead.add(sha256); !noted) {
      return noted;
    }
  }
  return {};
}

}  // namespace

Result<MovedStore> move_recordings_ahead(const Settings& settings, const std::string& from, const std::string& to) {
  const auto planned = plan(settings, from, to);
  if (!planned) {
    return fail(planned.error());
  }
  if (is_there(planned->mark)) {
    return fail(ErrorCode::Conflict, "The store is being moved already; end that without --ahead.",
                {{"parameter", "from"}});
  }
  const SystemClock clock;
  const fs::path& data = planned->of_directory.data;
  if (planned->to_database && !is_there(data / kSqliteFile)) {
    return fail(ErrorCode::NotFound, "There is no database in " + data.string() + ".", {{"parameter", "from"}});
  }
  std::optional<Side> source;
  if (!planned->to_database) {
    auto opened = open_side(planned->of_database, clock, true);
    if (!opened) {
      return fail(opened.error());
    }
    source = std::move(*opened);
  }
  auto target = open_side(planned->to_database ? planned->of_database : planned->of_directory, clock);
  if (!target) {
    return fail(target.error());
  }
  const auto empty = has_no_rows(*target->store.database);
  if (!empty || !*empty) {
    return !empty
               ? Result<MovedStore>(fail(empty.error()))
               : fail(ErrorCode::Conflict, "The target holds rows already; name an empty one.", {{"parameter", "to"}});
  }
  const auto hashes = source ? source->store.store->blob_hashes() : hashes_in(data);
  if (!hashes) {
    return fail(hashes.error());
  }
  MovedStore moved;
  AheadList ahead = ahead_list(*planned, *target);
  const BlobFiles files = source ? files_of(*source->blobs) : files_in(data);
  if (Status copied = copy_blobs(*hashes, files, *target->blobs, ahead, true, moved); !copied) {
    return fail(copied.error());
  }
  return moved;
}

Result<MovedStore> move_store(const Settings& settings, const std::string& from, const std::string& to) {
  const auto planned = plan(settings, from, to);
  if (!planned) {
    return fail(planned.error());
  }
  const SystemClock clock;
  auto directory = open_side(planned->of_directory, clock);
  if (!directory) {
    return fail(directory.error());
  }
  auto database = open_side(planned->of_database, clock);
  if (!database) {
    return fail(database.error());
  }
  Side& source = planned->to_database ? *directory : *database;
  Side& target = planned->to_database ? *database : *directory;
  if (Status begun = begin_or_go_on(planned->mark, planned->what, *target.store.database); !begun) {
    return fail(begun.error());
  }
  const auto hashes = source.store.store->blob_hashes();
  if (!hashes) {
    return fail(hashes.error());
  }
  MovedStore moved;
  moved.tables = static_cast<int>(moved_tables().size());
  AheadList ahead = ahead_list(*planned, target);
  if (Status copied = copy_blobs(*hashes, files_of(*source.blobs), *target.blobs, ahead, false, moved); !copied) {
    return fail(copied.error());
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
  if (Status forgotten = ahead.remove(); !forgotten) {
    return fail(forgotten.error());
  }
  if (Status ended = remove_file(planned->mark); !ended) {
    return fail(ended.error());
  }
  return moved;
}

}  // namespace driftlab::server
