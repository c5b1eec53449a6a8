#include "server/store/backups.hpp"

#include "server/store/files.hpp"
#include "server/store/guarded_round.hpp"
#include "server/store/told_error.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <iterator>
#include <system_error>
#include <utility>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

/// Of this process, that are told of.
constexpr std::size_t kOwn = 32;
/// After one that failed the timer waits so long, or its own time if that is less.
constexpr std::int64_t kPauseMicros = 3'600'000'000;
/// Copies of a store in which something is damaged, that stay beside those that are kept.
constexpr std::size_t kKeepDamaged = 3;

/// Behind the name of one that is being made (server/store/sqlite/backup.cpp), and of one that is being removed.
constexpr const char* kUnderConstruction = ".part";
constexpr const char* kLeaving = ".gone";

/// `20261125T081500Z`.
std::string name_at(UtcMicros time) {
  std::string name = rfc3339(time).substr(0, 19) + "Z";
  std::erase_if(name, [](char letter) { return letter == '-' || letter == ':'; });
  return name;
}

/// The moment that a name says; nothing: it is no backup's.
std::optional<UtcMicros> time_of(const std::string& name) {
  std::tm parts{};
  if (::strptime(name.c_str(), "%Y%m%dT%H%M%SZ", &parts) == nullptr) {
    return std::nullopt;
  }
  const UtcMicros time = static_cast<UtcMicros>(::timegm(&parts)) * 1'000'000;
  return name_at(time) == name ? std::optional(time) : std::nullopt;
}

/// Of the disk that a directory is on; nothing: it is not there.
std::optional<std::uint64_t> device_of(const fs::path& directory) {
  struct ::stat found{};
  return ::stat(directory.c_str(), &found) == 0 ? std::optional<std::uint64_t>(found.st_dev) : std::nullopt;
}

/// Whether there was a folder of it at its end.
bool is_made(const Backup& backup) {
  return backup.state == BackupState::Complete || backup.state == BackupState::Damaged;
}

}  // namespace

std::string_view name_of(BackupState state) {
  switch (state) {
    case BackupState::Running:
      return "running";
    case BackupState::Complete:
      return "complete";
    case BackupState::Damaged:
      return "damaged";
    case BackupState::Failed:
      break;
  }
  return "failed";
}

bool is_backup_name(std::string_view text) { return time_of(std::string(text)).has_value(); }

Backups::Backups(const Clock& clock, BackupOptions options)
    : clock_(clock), options_(std::move(options)), began_(clock.now()) {}

void Backups::start() {
  if (!options_.directory.empty()) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
}

void Backups::stop() {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    stopped_ = true;
  }
  thread_.request_stop();
  if (thread_.joinable()) {
    thread_.join();
  }
}

/// Those of the directory, oldest first. A directory that is not there has none.
Result<std::vector<Backup>> Backups::complete() const {
  std::vector<Backup> found;
  std::error_code error;
  fs::directory_iterator entry(options_.directory, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (const std::optional<UtcMicros> time = time_of(name)) {
      StoreReport told = options_.describe ? options_.describe(entry->path()) : StoreReport{};
      const BackupState state = told.faults.empty() ? BackupState::Complete : BackupState::Damaged;
      found.push_back({name, state, *time, std::nullopt, told.blobs, told.bytes, std::move(told.faults)});
    }
  }
  const bool absent = error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory;
  if (error && !absent && !options_.directory.empty()) {
    return fail(file_error(error.value(), "list", options_.directory));
  }
  std::sort(found.begin(), found.end(), [](const Backup& a, const Backup& b) { return a.name < b.name; });
  if (!found.empty()) {
    Seen seen{found.back().begun_at, std::nullopt, device_of(options_.directory).value_or(0)};
    for (const Backup& each : found) {
      seen.newest_sound = each.state == BackupState::Complete ? each.begun_at : seen.newest_sound;
    }
    const std::lock_guard<std::mutex> guard(mutex_);
    seen_ = seen;
  }
  return found;
}

Result<Backup> Backups::begin() {
  if (options_.directory.empty()) {
    return fail(ErrorCode::Conflict, "This daemon has no directory for backups; start it with --backups DIRECTORY.",
                {{"parameter", "backups"}});
  }
  const std::lock_guard<std::mutex> guard(mutex_);
  if (stopped_) {
    return fail(ErrorCode::Cancelled, "The daemon is stopping.");
  }
  if (!own_.empty() && own_.back().state == BackupState::Running) {
    return own_.back();
  }
  UtcMicros begun = clock_.now();
  if (!own_.empty() && name_at(begun) <= own_.back().name) {
    begun = time_of(own_.back().name).value_or(begun) + 1'000'000;  // a name is of one second
  }
  own_.push_back({name_at(begun), BackupState::Running, begun, std::nullopt, 0, 0, {}});
  if (own_.size() > kOwn) {
    own_.erase(own_.begin());
  }
  wanted_ = true;
  asked_.notify_all();
  return own_.back();
}

Result<std::vector<Backup>> Backups::list() const {
  std::vector<Backup> own;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    own = own_;
  }
  auto all = complete();  // after them: a folder that is not there any more was removed since
  if (!all) {
    return all;
  }
  for (const Backup& backup : own) {
    if (std::erase_if(*all, [&](const Backup& found) { return found.name == backup.name; }) > 0 || !is_made(backup)) {
      all->push_back(backup);
    }
  }
  std::sort(all->begin(), all->end(), [](const Backup& a, const Backup& b) { return a.name > b.name; });
  return all;
}

std::optional<UtcMicros> Backups::newest() const {
  std::optional<UtcMicros> time;
  for (const Backup& each : complete().value_or(std::vector<Backup>{})) {
    time = each.state == BackupState::Complete ? each.begun_at : time;
  }
  return time;
}

std::optional<UtcMicros> Backups::none_since() const {
  if (options_.directory.empty()) {
    return std::nullopt;
  }
  (void)complete();
  const std::lock_guard<std::mutex> guard(mutex_);
  return seen_ ? seen_->newest_sound.value_or(began_) : began_;
}

Status Backups::require_its_disk() const {
  const auto found = complete();
  if (!found) {
    return fail(found.error());
  }
  const std::optional<std::uint64_t> device = device_of(options_.directory);
  const std::lock_guard<std::mutex> guard(mutex_);
  if (!found->empty() || !seen_ || device == seen_->device) {
    return {};
  }
  return fail(ErrorCode::Io,
              "The directory " + options_.directory.string() +
                  " is gone, or on another disk than the backups that were in it. Mount that one; where the backups "
                  "are to go elsewhere, start the daemon again.",
              {{"path", options_.directory.string()}});
}

bool Backups::is_due() const {
  if (options_.every_micros <= 0) {
    return false;
  }
  const UtcMicros now = clock_.now();
  std::vector<Backup> made = complete().value_or(std::vector<Backup>{});  // also by processes before this one
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    const std::int64_t pause = std::min(options_.every_micros, kPauseMicros);
    if (!own_.empty() && own_.back().state == BackupState::Failed && now - own_.back().begun_at < pause) {
      return false;
    }
    if (seen_ && now - seen_->newest < options_.every_micros) {
      return false;  // it may be out of sight
    }
    std::copy_if(own_.begin(), own_.end(), std::back_inserter(made), [](const Backup& own) { return is_made(own); });
  }
  // One of a damaged store counts: what is damaged stays so, and another copy of it at once helps nobody.
  return std::none_of(made.begin(), made.end(),
                      [&](const Backup& each) { return now - each.begun_at < options_.every_micros; });
}

void Backups::run(const std::stop_token& stop) {
  constexpr std::chrono::seconds kLook{5};
  (void)guarded_round("backups", [this] { forget_unfinished(); });
  while (!stop.stop_requested()) {
    (void)guarded_round("backups", [this] {
      if (is_due()) {
        (void)begin();
      }
    });
    bool wanted = false;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      (void)asked_.wait_for(lock, stop, kLook, [this] { return wanted_; });
      wanted = std::exchange(wanted_, false);
    }
    if (wanted) {
      (void)guarded_round("backups", [&] { make(stop); });
    }
  }
}

void Backups::make(const std::stop_token& stop) {
  std::string name;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    name = own_.back().name;
  }
  Result<StoreReport> report = fail(ErrorCode::Internal, "The backup broke off by an exception, which the log has.");
  (void)guarded_round("backups", [&] {
    Status ready = require_its_disk();
    if (ready) {
      ready = make_directories(options_.directory);
    }
    report = ready ? options_.make(options_.directory / name, rfc3339(clock_.now()), stop) : fail(ready.error());
  });
  if (report) {
    // Before it is told, so that who hears of it finds the others gone.
    (void)guarded_round("backups", [&] { forget_old(report->faults.empty()); });
  }
  Backup ended;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    Backup& own = *std::find_if(own_.begin(), own_.end(), [&](const Backup& each) { return each.name == name; });
    own.finished_at = clock_.now();
    own.state = !report ? BackupState::Failed : report->faults.empty() ? BackupState::Complete : BackupState::Damaged;
    if (report) {
      own.faults = report->faults;
    } else {
      own.failure = report.error();
      own.faults = {without_paths({ErrorCode::Io, own.failure->message, own.failure->fields}).message};
    }
    own.blobs = report ? report->blobs : 0;
    own.bytes = report ? report->bytes : 0;
    ended = own;
  }
  if (options_.ended) {
    options_.ended(ended);
  }
}

void Backups::forget_unfinished() {
  std::vector<fs::path> unfinished;
  std::error_code ignored;
  fs::directory_iterator entry(options_.directory, ignored);
  for (; !ignored && entry != fs::directory_iterator(); entry.increment(ignored)) {
    const fs::path& path = entry->path();
    if ((path.extension() == kUnderConstruction || path.extension() == kLeaving) && time_of(path.stem().string())) {
      unfinished.push_back(path);
    }
  }
  for (const fs::path& path : unfinished) {
    fs::remove_all(path, ignored);
  }
}

/// Sound ones never after a damaged one: the older ones may be the only sound ones then. A damaged one never takes the
/// place of a sound one.
void Backups::forget_old(bool sound) {
  if (options_.keep == 0) {
    return;
  }
  std::vector<Backup> complete_ones;
  std::vector<Backup> damaged_ones;
  std::vector<Backup> all = complete().value_or(std::vector<Backup>{});
  for (Backup& each : all) {
    (each.state == BackupState::Complete ? complete_ones : damaged_ones).push_back(std::move(each));
  }
  if (sound) {
    remove_but_newest(complete_ones, options_.keep);
  }
  remove_but_newest(damaged_ones, kKeepDamaged);
}

void Backups::remove_but_newest(const std::vector<Backup>& oldest_first, std::size_t keep) const {
  for (std::size_t i = 0; i + keep < oldest_first.size(); ++i) {
    std::error_code ignored;
    // First a name that is no backup's: what a crash leaves half removed must not look complete.
    const fs::path leaving = options_.directory / (oldest_first[i].name + kLeaving);
    fs::rename(options_.directory / oldest_first[i].name, leaving, ignored);
    fs::remove_all(leaving, ignored);
  }
}

}  // namespace driftlab::server
