#include "tests/unit/store/s3/object_storage.hpp"

#include "server/store/copied_blobs.hpp"
#include "server/store/digest.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <system_error>

namespace driftlab::server::s3 {
namespace {

[[noreturn]] void give_up(const std::string& why) {
  std::fprintf(stderr, "The object storage of the tests: %s\n", why.c_str());
  std::abort();
}

}  // namespace

bool ObjectStorage::is_installed() {
  std::error_code none;
  const bool there = std::filesystem::exists("/usr/lib/python3/dist-packages/swift/common/middleware/s3api", none);
  if (!there) {
    std::fprintf(stderr, "OBJECT STORAGE NOT TESTED: python3-swift is not installed (./deploy/packages.sh test).\n");
  }
  return there;
}

ObjectStorage& ObjectStorage::of_this_process() {
  static ObjectStorage storage;
  return storage;
}

ObjectStorage::ObjectStorage() {
  const char* const source = std::getenv("DRIFTLAB_SOURCE");  // NOLINT(concurrency-mt-unsafe)
  const std::string script = std::string(source == nullptr ? "." : source) + "/tests/api/object_storage.py";
  std::array<int, 2> input{};
  std::array<int, 2> output{};
  if (::pipe2(input.data(), O_CLOEXEC) != 0 || ::pipe2(output.data(), O_CLOEXEC) != 0) {
    give_up("no pipe");
  }
  process_ = ::fork();
  if (process_ == 0) {
    (void)::dup2(input[0], STDIN_FILENO);
    (void)::dup2(output[1], STDOUT_FILENO);
    (void)::execl("/usr/bin/python3", "python3", "-B", script.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  ::close(input[0]);
  ::close(output[1]);
  to_ = ::fdopen(input[1], "w");
  from_ = ::fdopen(output[0], "r");
  std::istringstream told(tell(""));
  if (!(told >> port_ >> faulty_port_ >> key_id_ >> secret_ >> stranger_)) {
    give_up(script + " does not start");
  }
}

ObjectStorage::~ObjectStorage() {
  (void)std::fclose(to_);
  (void)std::fclose(from_);
  int status = 0;
  (void)::waitpid(process_, &status, 0);
}

std::string ObjectStorage::tell(const std::string& line) {
  if (!line.empty() && (std::fputs((line + "\n").c_str(), to_) < 0 || std::fflush(to_) != 0)) {
    give_up("it is gone");
  }
  std::string answer;
  for (int c = std::fgetc(from_); c != '\n'; c = std::fgetc(from_)) {
    if (c == EOF) {
      give_up("it does not obey " + line);
    }
    answer.push_back(static_cast<char>(c));
  }
  return answer;
}

Place ObjectStorage::place(const std::string& bucket, bool faulty) {
  tell("bucket " + bucket);
  const int port = faulty ? faulty_port_ : port_;
  auto read =
      read_place("s3://" + bucket + "/lab?endpoint=http://127.0.0.1:" + std::to_string(port) + "&region=test-region");
  EXPECT_TRUE(read) << read.error().message;
  return *read;
}

std::string bucket_for(const std::filesystem::path& folder) { return "t" + sha256_hex(folder.string()).substr(0, 20); }

ClientOptions hasty() {
  ClientOptions options;
  options.patience = {std::chrono::milliseconds(1000), std::chrono::milliseconds(1000), std::chrono::milliseconds(1000),
                      1U << 20U};
  options.attempts = 3;
  options.first_pause = std::chrono::milliseconds(50);
  return options;
}

NamesLock names_lock_in(const std::filesystem::path& folder) {
  return [folder](const std::string& blob, const std::function<Status()>& inside) -> Status {
    const std::string path = (folder / ("lock-" + blob)).string();
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    EXPECT_EQ(::flock(file, LOCK_EX), 0);
    Status done = inside();
    ::close(file);
    return done;
  };
}

}  // namespace driftlab::server::s3

namespace driftlab::server {

std::unique_ptr<BlobStore> open_object_blobs_under_test(const std::filesystem::path& folder, int process) {
  auto& storage = s3::ObjectStorage::of_this_process();
  const std::filesystem::path copies = folder / ("process" + std::to_string(process));
  auto local = open_blob_directory(copies);
  EXPECT_TRUE(local) << local.error().message;
  auto files = std::make_unique<s3::ObjectFiles>(
      storage.place(s3::bucket_for(folder)), [key = storage.key()]() -> Result<s3::Credentials> { return key; },
      s3::names_lock_in(folder), s3::hasty(), 1U << 20U);
  return local ? std::make_unique<CopiedBlobs>(std::move(files), std::move(*local), copies, 10'000,
                                               ReadPatience{3, std::chrono::milliseconds(50), std::chrono::seconds(30)})
               : nullptr;
}

Trouble object_storage_in_trouble(const std::filesystem::path& folder, BlobFault fault, const std::string& sha256) {
  auto& storage = s3::ObjectStorage::of_this_process();
  const std::string bucket = s3::bucket_for(folder);
  const std::string bytes = bucket + " lab/blobs/" + sha256.substr(0, 2) + "/" + sha256;
  const std::string columns = bucket + " lab/columns/" + sha256.substr(0, 2) + "/" + sha256 + ".columns";
  const auto on_the_way = [&](const std::string& words) {
    storage.tell("fault " + words);
    return Trouble(new int, [&storage](const int* none) {
      storage.tell("pass");
      delete none;
    });
  };
  switch (fault) {
    case BlobFault::Cut:
      return on_the_way("cut 1000000");
    case BlobFault::Unavailable:
      return on_the_way("unavailable 1000000");
    case BlobFault::Slow:
      return on_the_way("slow 1000000");
    case BlobFault::Full:
      return on_the_way("full 1000000 PUTPOST");
    case BlobFault::Denied:
      return on_the_way("denied 1000000");
    case BlobFault::Damaged:
      storage.tell("damage " + bytes);
      storage.tell("damage " + columns);
      break;
    case BlobFault::Missing:
      storage.tell("lose " + bytes);
      storage.tell("lose " + columns);
      break;
  }
  return std::make_shared<int>(0);
}

}  // namespace driftlab::server
