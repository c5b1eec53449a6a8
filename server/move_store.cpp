#include "server/move_store.hpp"

#include "server/move_blobs.hpp"
#include "server/moved_tables.hpp"
#include "server/open_store.hpp"
#include "server/store/files.hpp"
#include "server/store/sqlite/sqlite_reading.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAheadFile = "moved-ahead";
constexpr std::string_view kSayFilledFrom = "UPDATE store_identity SET filled_from = ?1";

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
  if (beside_others && store->others != nullptr) {
    // Where nobody is there just now, daemons may come all the same.
    if (Status admitted = store->others->admit_others(); !admitted) {
      return fail(admitted.error());
    }
  }
  auto blobs = open_blobs(settings, *store);
  if (!blobs) {
    return fail(blobs.error());
  }
  return Side{std::move(*store), std::move(*blobs)};
}

/// A target is empty, or was filled by this move.
Status check_target(Database& target, const AheadList& ahead) {
  if (ahead.is_begun()) {
    return {};
  }
  const auto empty = has_no_rows(target);
  if (!empty) {
    return fail(empty.error());
  }
  return *empty ? Status{}
                : fail(ErrorCode::Conflict, "The target holds rows already; name an empty one.", {{"parameter", "to"}});
}

/// Says in a database what it is being filled from, or that this has ended. A directory has files for it.
Status say_filled_from(const OpenedStore& target, const std::string& source) {
  if (target.identity.empty()) {
    return {};
  }
  return target.database
      ->write(WriteKind::Fenced,
              [&](Connection& connection) -> Result<int> {
                Statement statement = connection.prepare(kSayFilledFrom);
                statement.bind(source);
                return statement.run().map([] { return 0; });
              })
      .map([](int) {});
}

/// The mark of a move that is under way, `WHERE\n`.
Status begin_or_go_on(const fs::path& mark, const std::string& what, Database& target, const AheadList& ahead) {
  std::ifstream stream(mark);
  std::string line;
  if (stream && std::getline(stream, line)) {
    return line == what ? Status{}
                        : fail(ErrorCode::Conflict,
                               "The store in " + mark.parent_path().string() +
                                   " is being moved by another command: " + line + "; end that first.",
                               {{"path", mark.string()}});
  }
  if (Status checked = check_target(target, ahead); !checked) {
    return checked;
  }
  return write_secret_file(mark, what + "\n");
}

/// The mark goes last: as long as it is there the same command finds what is left to do.
Status end_move(const OpenedStore& target, AheadList& ahead, const fs::path& mark) {
  if (Status said = say_filled_from(target, ""); !said) {
    return said;
  }
  if (Status forgotten = ahead.remove(); !forgotten) {
    return forgotten;
  }
  return remove_file(mark);
}

/// Whether a database is not being filled any more though the files of the move that `was_begun` are still there: it
/// was cut off in its last steps, and daemons may have the database since.
Result<bool> had_ended(const OpenedStore& target, bool was_begun) {
  if (!was_begun || target.identity.empty() || !target.filled_from.empty()) {
    return false;
  }
  return has_no_rows(*target.database).map([](bool empty) { return !empty; });
}

/// What a move is from and to.
struct Plan {
  Settings of_directory;
  Settings of_database;
  bool to_database = true;
  fs::path mark;
  std::string what;  ///< `to postgresql://... database`
  std::string from;  ///< without a password
};

Result<Plan> plan(const Settings& settings, const std::string& from, const std::string& to) {
  if (is_database(from) == is_database(to)) {
    return fail(ErrorCode::InvalidArgument,
                "A lab is moved from a directory to postgresql://USER@HOST/DATABASE or back; name one of each.",
                {{"parameter", "from"}});
  }
  Plan made{settings, settings, is_database(to), {}, {}, is_database(from) ? without_password(from) : from};
  made.of_directory.store.clear();
  made.of_directory.blobs.clear();
  made.of_directory.data = made.to_database ? from : to;
  made.of_directory.is_moving = true;
  made.of_database.store = made.to_database ? to : from;
  made.of_database.serves_api = true;
  made.of_database.is_moving = made.to_database;  // what is a part of a lab is no source
  made.mark = made.of_directory.data / kMovingFile;
  if (made.to_database && is_filled_ahead(made.of_directory.data)) {
    return fail(ErrorCode::Conflict,
                "The store in " + from + " is being filled itself; let that move end, or remove the directory.",
                {{"parameter", "from"}});
  }
  made.what = (made.to_database ? "to " : "from ") + without_password(made.of_database.store) + " " + settings.blobs;
  return made;
}

/// `identity`: of the database, so that another one of the same address is not taken for it.
AheadList ahead_list(const Plan& plan, const std::string& identity) {
  return {plan.of_directory.data / kAheadFile, plan.what + " " + identity};
}

/// A source whose daemons go on.
class SourceAtWork {
 public:
  /// A directory, by its files.
  SourceAtWork(fs::path directory, std::unique_ptr<Database> reading)
      : directory_(std::move(directory)), reading_(std::move(reading)) {}
  explicit SourceAtWork(Side side) : side_(std::move(side)) {}

  [[nodiscard]] Database& database() const { return side_ ? *side_->store.database : *reading_; }
  [[nodiscard]] std::string identity() const { return side_ ? side_->store.identity : ""; }
  [[nodiscard]] BlobFiles files() const { return side_ ? files_of(*side_->blobs) : files_in(directory_); }
  [[nodiscard]] Result<std::vector<std::string>> hashes() const {
    return side_ ? side_->store.store->blob_hashes() : hashes_in(directory_);
  }

 private:
  fs::path directory_;
  std::unique_ptr<Database> reading_;
  std::optional<Side> side_;
};

Result<SourceAtWork> open_at_work(const Plan& plan, const Clock& clock) {
  if (!plan.to_database) {
    return open_side(plan.of_database, clock, true).map([](Side side) { return SourceAtWork(std::move(side)); });
  }
  const fs::path& data = plan.of_directory.data;
  if (!is_there(data / kSqliteFile)) {
    return fail(ErrorCode::NotFound, "There is no database in " + data.string() + ".", {{"parameter", "from"}});
  }
  return open_sqlite_reading(data / kSqliteFile).map([&](std::unique_ptr<Database> reading) {
    return SourceAtWork(data, std::move(reading));
  });
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

Result<MovedStore> move_ahead(const Settings& settings, const std::string& from, const std::string& to) {
  const auto planned = plan(settings, from, to);
  if (!planned) {
    return fail(planned.error());
  }
  if (is_there(planned->mark)) {
    return fail(ErrorCode::Conflict, "The store is being moved already; end that without --ahead.",
                {{"parameter", "from"}});
  }
  const SystemClock clock;
  const auto source = open_at_work(*planned, clock);
  if (!source) {
    return fail(source.error());
  }
  auto target = open_side(planned->to_database ? planned->of_database : planned->of_directory, clock);
  if (!target) {
    return fail(target.error());
  }
  AheadList ahead = ahead_list(*planned, planned->to_database ? target->store.identity : source->identity());
  Status ready = check_target(*target->store.database, ahead);
  if (ready) {
    ready = ahead.begin();
  }
  if (ready) {
    ready = say_filled_from(target->store, planned->from);
  }
  if (!ready) {
    return fail(ready.error());
  }
  const auto hashes = source->hashes();
  if (!hashes) {
    return fail(hashes.error());
  }
  MovedStore moved;
  if (Status copied = copy_blobs(*hashes, source->files(), *target->blobs, ahead, true, moved); !copied) {
    return fail(copied.error());
  }
  const auto tables = moved_tables(source->database(), *target->store.database);
  if (!tables) {
    moved.rows_left = tables.error().message;
    return tables.error().code == ErrorCode::Conflict ? Result<MovedStore>(moved) : fail(tables.error());
  }
  const auto rows = copy_rows(source->database(), *target->store.database, *tables);
  if (!rows) {
    return fail(rows.error());
  }
  moved.rows = *rows;
  return moved;
}

bool is_filled_ahead(const fs::path& data) {
  std::ifstream stream(data / kAheadFile);
  std::string line;
  return stream && std::getline(stream, line) && line.starts_with("from ");
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
  AheadList ahead = ahead_list(*planned, database->store.identity);
  const auto over = had_ended(target.store, ahead.is_begun() || is_there(planned->mark));
  if (!over || *over) {
    return !over ? fail(over.error())
                 : fail(ErrorCode::Conflict,
                        "The database has rows and is not being filled any more: the move had ended, and daemons may "
                        "work with it. Remove `moving` and `moved-ahead` from " +
                            planned->of_directory.data.string() +
                            "; or make the database anew, where an earlier release began the move.",
                        {{"parameter", "to"}});
  }
  if (Status begun = begin_or_go_on(planned->mark, planned->what, *target.store.database, ahead); !begun) {
    return fail(begun.error());
  }
  if (Status said = say_filled_from(target.store, planned->from); !said) {
    return fail(said.error());
  }
  const auto hashes = source.store.store->blob_hashes();
  if (!hashes) {
    return fail(hashes.error());
  }
  MovedStore moved;
  if (Status copied = copy_blobs(*hashes, files_of(*source.blobs), *target.blobs, ahead, false, moved); !copied) {
    return fail(copied.error());
  }
  const auto tables = moved_tables(*source.store.database, *target.store.database);
  if (!tables) {
    return fail(tables.error());
  }
  const auto rows = copy_rows(*source.store.database, *target.store.database, *tables);
  if (!rows) {
    return fail(rows.error());
  }
  moved.rows = *rows;
  if (Status ended = end_move(target.store, ahead, planned->mark); !ended) {
    return fail(ended.error());
  }
  return moved;
}

}  // namespace driftlab::server
