#pragma once
/// The object storage of the tests: Swift with its S3 interface and the faulty way to it (tests/api/object_storage.py).
#include "server/store/blobs.hpp"
#include "server/store/s3/object_files.hpp"
#include "tests/unit/store/blob_suite.hpp"

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

namespace driftlab::server::s3 {

class ObjectStorage {
 public:
  /// Whether Debian's package of Swift is there. Says so where they are not.
  [[nodiscard]] static bool is_installed();
  /// That of this process, started when it is first asked for. It aborts where it cannot be started.
  [[nodiscard]] static ObjectStorage& of_this_process();

  ObjectStorage(const ObjectStorage&) = delete;
  ObjectStorage& operator=(const ObjectStorage&) = delete;
  ~ObjectStorage();

  /// A line of `obey` in object_storage.py; its answer.
  std::string tell(const std::string& line);
  /// A bucket, by the way on which faults happen or past it. Made where it is absent.
  [[nodiscard]] Place place(const std::string& bucket, bool faulty = true);
  [[nodiscard]] Credentials key() const { return {key_id_, secret_, ""}; }
  [[nodiscard]] Credentials key_without_rights() const { return {stranger_, secret_, ""}; }

 private:
  ObjectStorage();

  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
  pid_t process_ = -1;
  int port_ = 0;
  int faulty_port_ = 0;
  std::string key_id_;
  std::string secret_;
  std::string stranger_;
};

/// The bucket of a test's folder.
[[nodiscard]] std::string bucket_for(const std::filesystem::path& folder);

/// Gives up sooner than a daemon does: tests of what never answers wait for it.
[[nodiscard]] ClientOptions hasty();

/// A lock between the processes of a test's folder.
[[nodiscard]] NamesLock names_lock_in(const std::filesystem::path& folder);

}  // namespace driftlab::server::s3

namespace driftlab::server {

/// With parts of 1 MiB; the local copies of process number `process` may take 10 000 bytes.
[[nodiscard]] std::unique_ptr<BlobStore> open_object_blobs_under_test(const std::filesystem::path& folder, int process);
[[nodiscard]] Trouble object_storage_in_trouble(const std::filesystem::path& folder, BlobFault fault,
                                                const std::string& sha256);

}  // namespace driftlab::server
