#include "server/store/crash_point.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>

namespace driftlab::server {
namespace {

/// Points at the armed member of the list; null in production.
std::atomic<const std::string_view*>& armed_point() {
  static std::atomic<const std::string_view*> armed{nullptr};
  return armed;
}

}  // namespace

const std::vector<std::string_view>& crash_point_names() {
  static const std::vector<std::string_view> names = {
      "upload.streaming",   // some bytes of an upload are on disk
      "upload.sealed",      // all bytes are flushed and hashed
      "upload.decoded",     // the decoded columns lie in incoming/
      "upload.kept_bytes",  // the bytes have their final name, the columns do not
      "upload.kept",        // bytes and columns have their final names, no row names them
      "upload.recorded",    // the row is committed, nobody was told
      "job.claimed",        // a worker holds the lease and has not begun
      "job.working",        // the first progress report is written
      "job.before_finish",  // results are computed, nothing of them is written
      "job.in_finish",      // results are written in a transaction that is not committed
      "job.finished",       // the finish is committed, nobody was told
      "migrate.backed_up",  // the copy from before the migrations has its name, nothing is migrated
      "migrate.in_step",    // a migration is carried out in a transaction that is not committed
      "migrate.stepped",    // it is committed, others may follow
      "backup.copied",      // the database is copied, no recording is
      "backup.files",       // recordings are copied too, the manifest is not written
      "backup.complete",    // everything is there and on disk, without its name
      "backup.named",       // the backup has its name, nobody was told
  };
  return names;
}

bool arm_crash_point(std::string_view name) {
  if (name.empty()) {
    armed_point().store(nullptr);
    return true;
  }
  const auto& known = crash_point_names();
  const auto found = std::find(known.begin(), known.end(), name);
  if (found == known.end()) {
    return false;
  }
  armed_point().store(&*found);
  return true;
}

void crash_point(std::string_view name) {
  const std::string_view* armed = armed_point().load(std::memory_order_relaxed);
  if (armed != nullptr && *armed == name) {
    (void)std::raise(SIGKILL);
  }
}

}  // namespace driftlab::server
