#include "server/store/sqlite/backup.hpp"

#include "server/store/blobs.hpp"
#include "server/store/checksums.hpp"
#include "server/store/crash_point.hpp"
#include "server/store/digest.hpp"
#include "server/store/files.hpp"
#include "server/store/sql/seals.hpp"
#include "server/store/sqlite/connection.hpp"
#include "server/store/sqlite/migrations.hpp"

#include <charconv>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDatabase = "driftlab.db";
constexpr const char* kManifest = "manifest.json";
constexpr const char* kKeepsAmounts = "SELECT name FROM sqlite_master WHERE name = 'stored_amounts'";
/// A keeper whose amount (migration 0028) is not that of its rows.
constexpr const char* kWrongAmount =
    "WITH kept AS (SELECT id, device_id, bytes FROM recordings JOIN blobs ON sha256 = blob_sha256), "
    "there (kept_by, number, bytes) AS (SELECT 'devices', count(*), 0 FROM devices "
    "UNION ALL SELECT 'blobs', count(*), total(bytes) FROM blobs "
    "UNION ALL SELECT 'recordings', count(*), total(bytes) FROM kept "
    "UNION ALL SELECT 'device/' || device_id, count(*), sum(bytes) FROM kept GROUP BY device_id "
    "UNION ALL SELECT 'token/' || token_id, count(*), sum(bytes) FROM owners JOIN kept ON id = object_id "
    "GROUP BY token_id) "
    "SELECT kept_by FROM (SELECT * FROM there UNION ALL SELECT kept_by, -number, -bytes FROM stored_amounts) "
    "GROUP BY kept_by HAVING sum(number) <> 0 OR sum(bytes) <> 0 LIMIT 1";

Result<std::unique_ptr<SqliteConnection>> open_to_read(const fs::path& directory) {
  std::error_code none;
  if (!fs::exists(directory / kDatabase, none)) {
    return fail(ErrorCode::NotFound, "There is no driftlab database in " + directory.string() + ".",
                {{"parameter", "data"}});
  }
  return SqliteConnection::open(directory / kDatabase, Access::ReadOnly);
}

Result<std::vector<std::string>> blobs_of(SqliteConnection& connection) {
  std::vector<std::string> hashes;
  Statement statement = connection.prepare("SELECT sha256 FROM blobs ORDER BY sha256");
  while (true) {
    const auto row = statement.step();
    if (!row) {
      return fail(row.error());
    }
    if (!*row) {
      return hashes;
    }
    hashes.push_back(statement.text(0));
  }
}

Status check_database(SqliteConnection& connection, std::vector<std::string>& faults) {
  const auto integrity = connection.query_text("PRAGMA integrity_check(1)");
  if (!integrity) {
    return fail(integrity.error());
  }
  if (integrity->value_or("") != "ok") {
    faults.push_back("The database is damaged: " + integrity->value_or("no answer") + ".");
  }
  const auto found = connection.query_text("SELECT \"table\" FROM pragma_foreign_key_check LIMIT 1");
  if (!found) {
    return fail(found.error());
  }
  if (const std::optional<std::string>& orphan = *found) {
    faults.push_back("A row of the table " + *orphan + " refers to one that is not there.");
  }
  const auto keeps = connection.query_text(kKeepsAmounts);
  const auto wrong = keeps && *keeps ? connection.query_text(kWrongAmount) : keeps;
  if (!wrong) {
    return fail(wrong.error());
  }
  if (const std::optional<std::string>& keeper = *wrong; *keeps && keeper) {
    faults.push_back("The amount that is kept of " + *keeper + " is not that of what is stored.");
  }
  return {};
}

/// Whether the table has that seal: in a database of an earlier release not every one has.
Result<bool> has_seals(SqliteConnection& connection, const SealedTable& table) {
  Statement statement = connection.prepare("SELECT 1 FROM pragma_table_info(?) WHERE name = ?");
  return statement.bind(table.name, table.seal).step();
}

/// Compares every row with its seal.
Status check_rows(SqliteConnection& connection, const std::stop_token& stop, StoreReport& report) {
  constexpr int kRowsAtOnce = 100;
  for (const SealedTable& table : sealed_tables()) {
    const Result<bool> sealed = has_seals(connection, table);
    if (!sealed) {
      return fail(sealed.error());
    }
    if (!*sealed) {
      continue;
    }
    std::vector<std::string> after;
    do {
      if (stop.stop_requested()) {
        return fail(ErrorCode::Cancelled, "Reading back what is stored was stopped.");
      }
      const auto some = read_back(connection, table, after, kRowsAtOnce);
      if (!some) {
        return fail(some.error());
      }
      for (const std::string& row : some->damaged) {
        report.faults.push_back("The row " + row + " of the database is damaged.");
      }
      after = some->last;
    } while (!after.empty());
  }
  return {};
}

/// The fault of a file, as a sentence; empty: it is sound.
std::string fault_of(const std::string& what, const std::string& sha256, FileState state) {
  switch (state) {
    case FileState::Sound:
      return "";
    case FileState::Unknown:
      return "The " + what + " of " + sha256 +
             " cannot be verified, for they have no checksum; a daemon makes them anew from the bytes.";
    case FileState::Damaged:
      return "The " + what + " of " + sha256 + " are damaged.";
    case FileState::Missing:
      return "The " + what + " of " + sha256 + " are missing.";
  }
  return "";
}

/// Reads the files of every blob below `root` back.
Status check_files(const fs::path& root, const std::vector<std::string>& hashes, const std::stop_token& stop,
                   StoreReport& report) {
  const ReadingPace count = [&](std::size_t bytes) {
    report.bytes += static_cast<std::int64_t>(bytes);
    return !stop.stop_requested();
  };
  for (const std::string& sha256 : hashes) {
    if (stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Reading back what is stored was stopped.");
    }
    const auto bytes = check_bytes(bytes_below(root, sha256), sha256, count);
    const auto columns = check_columns(columns_below(root, sha256), count);
    if (!bytes || !columns) {
      return fail(!bytes ? bytes.error() : columns.error());
    }
    for (std::string fault : {fault_of("bytes", sha256, *bytes), fault_of("columns", sha256, *columns)}) {
      if (!fault.empty()) {
        report.faults.push_back(std::move(fault));
      }
    }
    ++report.blobs;
  }
  return {};
}

Status copy_one(const fs::path& from, const fs::path& to) {
  if (Status made = make_directories(to.parent_path()); !made) {
    return made;
  }
  std::error_code error;
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
  if (error) {
    return fail(file_error(error.value(), "copy", from));
  }
  return sync_path(to);
}

/// Copies the files of every blob; one that is not there is told.
Status copy_files(const fs::path& from, const fs::path& to, const std::vector<std::string>& hashes,
                  const std::stop_token& stop, StoreReport& report) {
  for (const std::string& sha256 : hashes) {
    if (stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The backup was stopped.");
    }
    const fs::path columns = columns_below(from, sha256);
    for (const auto& [source, target] :
         {std::pair{bytes_below(from, sha256), bytes_below(to, sha256)}, std::pair{columns, columns_below(to, sha256)},
          std::pair{columns_checksum_path(columns), columns_checksum_path(columns_below(to, sha256))}}) {
      std::error_code none;
      if (!fs::exists(source, none)) {
        continue;  // the check of the copy tells
      }
      if (Status copied = copy_one(source, target); !copied) {
        return copied;
      }
    }
  }
  return check_files(to, hashes, stop, report);
}

Status write_manifest(const fs::path& directory, const StoreReport& report, const std::string& now) {
  const auto database = sha256_of_file(directory / kDatabase);
  if (!database) {
    return fail(database.error());
  }
  std::ofstream stream(directory / kManifest);
  stream << "{\"driftlab\":\"" << DRIFTLAB_VERSION << "\",\"made_at\":\"" << now << "\",\"database_sha256\":\""
         << *database << "\",\"blobs\":" << report.blobs << ",\"bytes\":" << report.bytes
         << ",\"faults\":" << report.faults.size() << "}\n";
  stream.close();
  if (!stream) {
    return fail(ErrorCode::DiskFull, "The manifest of the backup could not be written.");
  }
  return sync_path(directory / kManifest);
}

std::int64_t number_after(std::string_view name, const std::string& manifest) {
  const std::size_t at = manifest.find(name);
  std::int64_t number = 0;
  if (at != std::string::npos) {
    (void)std::from_chars(manifest.data() + at + name.size(), manifest.data() + manifest.size(), number);
  }
  return number;
}

Status require_absent(const fs::path& target, bool may_be_empty) {
  std::error_code none;
  if (!fs::exists(target, none) || (may_be_empty && fs::is_directory(target, none) && fs::is_empty(target, none))) {
    return {};
  }
  return fail(ErrorCode::Conflict, "The directory " + target.string() + " is there already; name another.",
              {{"path", target.string()}});
}

/// The directory as its parent names it: `X/`, `X/.` and `.` have no name that could be lengthened.
fs::path by_name(const fs::path& directory) {
  std::error_code unknown;
  fs::path named = fs::weakly_canonical(directory, unknown);
  if (unknown) {
    named = fs::absolute(directory, unknown).lexically_normal();
  }
  return named.has_filename() ? named : named.parent_path();
}

/// Whether a directory has nothing but what a backup or a data directory under construction has.
bool is_ours(const fs::path& part) {
  std::error_code error;
  const fs::file_status found = fs::symlink_status(part, error);
  bool ours = fs::is_directory(found);
  fs::directory_iterator entry(part, error);
  for (; ours && !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    ours = name.starts_with(kDatabase) || name == kManifest || name == "blobs" || name == "columns";
  }
  return ours && !error;
}

/// A directory under construction, removed unless it was given its name.
class Construction {
 public:
  explicit Construction(const fs::path& target) : target_(by_name(target)), part_(target_) { part_ += ".part"; }
  Construction(const Construction&) = delete;
  Construction& operator=(const Construction&) = delete;
  ~Construction() {
    std::error_code ignored;
    if (begun_) {
      fs::remove_all(part_, ignored);
    }
  }
  /// In the place of one that was broken off. Conflict: something else has its name.
  [[nodiscard]] Status begin() {
    std::error_code ignored;
    if (is_there(part_) && !is_ours(part_)) {
      return fail(ErrorCode::Conflict,
                  "There is a " + part_.string() + " that no driftlabd left unfinished; move it away, or name another.",
                  {{"path", part_.string()}});
    }
    begun_ = true;
    fs::remove_all(part_, ignored);
    return make_directories(part_);
  }
  [[nodiscard]] const fs::path& part() const { return part_; }
  [[nodiscard]] Status finish() const {
    std::error_code ignored;
    fs::remove(target_, ignored);  // an empty directory
    return rename_durably(part_, target_);
  }

 private:
  fs::path target_;
  fs::path part_;
  bool begun_ = false;
};

/// Checks the database that was copied to `part` and copies every blob that it names from the folder `from`.
Status copy_what_is_named(const fs::path& from, const fs::path& part, const std::stop_token& stop,
                          StoreReport& report) {
  auto copy = SqliteConnection::open(part / kDatabase, Access::ReadOnly);
  if (!copy) {
    return fail(copy.error());
  }
  Status whole = check_database(**copy, report.faults);
  if (whole) {
    whole = check_rows(**copy, stop, report);
  }
  if (!whole) {
    return whole;
  }
  const auto hashes = blobs_of(**copy);
  if (!hashes) {
    return fail(hashes.error());
  }
  return copy_files(from, part, *hashes, stop, report);
}

}  // namespace

Result<StoreReport> check_data(const fs::path& data) {
  auto connection = open_to_read(data);
  if (!connection) {
    return fail(connection.error());
  }
  StoreReport report;
  Status checked = check_database(**connection, report.faults);
  if (checked) {
    checked = check_rows(**connection, {}, report);
  }
  const auto hashes = checked ? blobs_of(**connection) : Result<std::vector<std::string>>(fail(checked.error()));
  if (!hashes) {
    return fail(hashes.error());
  }
  if (checked = check_files(data, *hashes, {}, report); !checked) {
    return fail(checked.error());
  }
  return report;
}

Result<StoreReport> back_up(const fs::path& data, const fs::path& target, const std::string& now,
                            const std::stop_token& stop) {
  if (Status absent = require_absent(target, false); !absent) {
    return fail(absent.error());
  }
  auto connection = open_to_read(data);
  if (!connection) {
    return fail(connection.error());
  }
  Construction construction(target);
  Status done = construction.begin();
  if (done) {
    done = copy_database(**connection, construction.part() / kDatabase);
  }
  if (!done) {
    return fail(done.error());
  }
  crash_point("backup.copied");
  StoreReport report;
  if (done = copy_what_is_named(data, construction.part(), stop, report); !done) {
    return fail(done.error());
  }
  crash_point("backup.files");
  done = write_manifest(construction.part(), report, now);
  if (done) {
    crash_point("backup.complete");
    done = construction.finish();
  }
  if (!done) {
    return fail(done.error());
  }
  crash_point("backup.named");
  return report;
}

StoreReport manifest_of(const fs::path& backup) {
  std::ifstream stream(backup / kManifest);
  const std::string manifest{std::istreambuf_iterator<char>(stream), {}};
  StoreReport told;
  told.blobs = number_after("\"blobs\":", manifest);
  told.bytes = number_after("\"bytes\":", manifest);
  if (const std::int64_t faults = number_after("\"faults\":", manifest); faults > 0) {
    told.faults.push_back("Its store had " + std::to_string(faults) + (faults == 1 ? " fault." : " faults."));
  }
  return told;
}

Result<StoreReport> restore(const fs::path& backup, const fs::path& data) {
  if (Status absent = require_absent(data, true); !absent) {
    return fail(absent.error());
  }
  std::ifstream stream(backup / kManifest);
  const std::string manifest{std::istreambuf_iterator<char>(stream), {}};
  const auto digest = sha256_of_file(backup / kDatabase);
  if (!digest || manifest.empty()) {
    return fail(ErrorCode::NotFound, "There is no complete backup in " + backup.string() + ".",
                {{"parameter", "from"}});
  }
  if (manifest.find("\"database_sha256\":\"" + *digest + "\"") == std::string::npos) {
    return fail(ErrorCode::Io, "The database of the backup is not the one that its manifest names.",
                {{"parameter", "from"}});
  }
  Construction construction(data);
  Status done = construction.begin();
  if (done) {
    done = copy_one(backup / kDatabase, construction.part() / kDatabase);
  }
  if (!done) {
    return fail(done.error());
  }
  StoreReport report;
  if (done = copy_what_is_named(backup, construction.part(), {}, report); !done) {
    return fail(done.error());
  }
  if (done = construction.finish(); !done) {
    return fail(done.error());
  }
  return report;
}

}  // namespace driftlab::server
