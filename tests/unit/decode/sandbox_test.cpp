// What a process may still ask of the kernel once it takes a file apart. Each case asks in a child of its own.
#include "clients/decode/sandbox.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <linux/openat2.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <string>
#include <vector>

namespace driftlab::decode {
namespace {

constexpr std::size_t kMemory = std::size_t{512} << 20;
constexpr int kNotEntered = 255;

/// How a child ended that did `what` behind the door: `what`'s answer, or minus the signal that ended it.
int inside(const std::function<int()>& what) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::_exit(enter_sandbox(kMemory) ? what() : kNotEntered);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

/// The refusal of a system call, 0 where it was taken.
template <class... Words>
int refusal(long call, Words... words) {
  return ::syscall(call, words...) >= 0 ? 0 : errno;
}

/// What the kernel says of this process: 0 where it can filter no calls.
bool kernel_filters_calls() {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.starts_with("Seccomp:")) {
      return true;
    }
  }
  return false;
}

struct Call {
  const char* name;
  std::function<int()> ask;
};

/// A file to be opened, changed or taken away, and one that is not there.
std::vector<Call> forbidden(const std::string& file, const std::string& other) {
  const char* const there = file.c_str();
  const char* const absent = other.c_str();
  const pid_t parent = ::getpid();
  std::vector<Call> calls{
      {"openat", [=] { return refusal(SYS_openat, AT_FDCWD, there, O_RDONLY); }},
      {"openat2",
       [=] {
         open_how how{};
         how.flags = O_RDONLY;
         return refusal(SYS_openat2, AT_FDCWD, there, &how, sizeof how);
       }},
      {"make a file", [=] { return refusal(SYS_openat, AT_FDCWD, absent, O_WRONLY | O_CREAT, 0600); }},
      {"truncate", [=] { return refusal(SYS_truncate, there, 0L); }},
      {"unlinkat", [=] { return refusal(SYS_unlinkat, AT_FDCWD, there, 0); }},
      {"renameat2", [=] { return refusal(SYS_renameat2, AT_FDCWD, there, AT_FDCWD, absent, 0); }},
      {"linkat", [=] { return refusal(SYS_linkat, AT_FDCWD, there, AT_FDCWD, absent, 0); }},
      {"symlinkat", [=] { return refusal(SYS_symlinkat, there, AT_FDCWD, absent); }},
      {"mkdirat", [=] { return refusal(SYS_mkdirat, AT_FDCWD, absent, 0700); }},
      {"fchmodat", [=] { return refusal(SYS_fchmodat, AT_FDCWD, there, 0777); }},
      {"fchownat", [=] { return refusal(SYS_fchownat, AT_FDCWD, there, ::getuid(), ::getgid(), 0); }},
      {"utimensat", [=] { return refusal(SYS_utimensat, AT_FDCWD, there, nullptr, 0); }},
      {"setxattr", [=] { return refusal(SYS_setxattr, there, "user.driftlab", "1", 1UL, 0); }},
      {"chdir", [=] { return refusal(SYS_chdir, "/"); }},
      {"readlinkat",
       [=] {
         std::array<char, 64> into{};
         return refusal(SYS_readlinkat, AT_FDCWD, "/proc/self/exe", into.data(), into.size());
       }},
      {"memfd_create", [] { return refusal(SYS_memfd_create, "x", 0U); }},
      {"socket", [] { return refusal(SYS_socket, AF_INET, SOCK_STREAM, 0); }},
      {"socket of the machine", [] { return refusal(SYS_socket, AF_UNIX, SOCK_STREAM, 0); }},
      {"socketpair",
       [] {
         std::array<int, 2> ends{};
         return refusal(SYS_socketpair, AF_UNIX, SOCK_STREAM, 0, ends.data());
       }},
      {"io_uring_setup", [] { return refusal(SYS_io_uring_setup, 4U, nullptr); }},
      {"fork",
       [] {
         const pid_t child = ::fork();
         if (child == 0) {
           ::_exit(0);
         }
         return child > 0 ? 0 : errno;
       }},
      {"clone3", [] { return refusal(SYS_clone3, nullptr, 0UL); }},
      {"execve",
       [] {
         std::array<const char*, 2> words{"true", nullptr};
         return refusal(SYS_execve, "/bin/true", words.data(), nullptr);
       }},
      {"kill", [=] { return refusal(SYS_kill, parent, 0); }},
      {"rt_sigqueueinfo",
       [=] {
         siginfo_t info{};
         info.si_code = SI_QUEUE;
         return refusal(SYS_rt_sigqueueinfo, parent, SIGURG, &info);
       }},
      {"pidfd_open", [=] { return refusal(SYS_pidfd_open, parent, 0U); }},
      {"ptrace", [=] { return refusal(SYS_ptrace, PTRACE_SEIZE, parent, nullptr, nullptr); }},
      {"process_vm_readv",
       [=] {
         std::array<char, 8> into{};
         iovec local{into.data(), into.size()};
         iovec remote{into.data(), into.size()};
         return refusal(SYS_process_vm_readv, parent, &local, 1UL, &remote, 1UL, 0UL);
       }},
      {"limits of another process",
       [=] {
         rlimit now{};
         return refusal(SYS_prlimit64, parent, RLIMIT_NOFILE, nullptr, &now);
       }},
      {"its own limits",
       [] {
         const rlimit more{600, 600};
         return refusal(SYS_prlimit64, 0, RLIMIT_CPU, &more, nullptr);
       }},
      {"prctl", [] { return refusal(SYS_prctl, 0, 0, 0, 0, 0); }},
      {"unshare", [] { return refusal(SYS_unshare, 0); }},
      {"no call of this kernel", [] { return refusal(1'000'000L); }},
  };
#ifdef SYS_open
  const std::vector<Call> older{
      {"open", [=] { return refusal(SYS_open, there, O_RDONLY); }},
      {"creat", [=] { return refusal(SYS_creat, absent, 0600); }},
      {"rename", [=] { return refusal(SYS_rename, there, absent); }},
      {"renameat", [=] { return refusal(SYS_renameat, AT_FDCWD, there, AT_FDCWD, absent); }},
      {"unlink", [=] { return refusal(SYS_unlink, there); }},
      {"chmod", [=] { return refusal(SYS_chmod, there, 0777); }},
      {"utimes", [=] { return refusal(SYS_utimes, there, nullptr); }},
      {"openat of the x32 machine", [=] { return refusal(SYS_openat | 0x40000000L, AT_FDCWD, there, O_RDONLY); }},
  };
  calls.insert(calls.end(), older.begin(), older.end());
#endif
  return calls;
}

TEST(Sandbox, RefusesWhatReachesBeyondTheProcess) {
  if (!kernel_filters_calls()) {
    GTEST_SKIP() << "SKIPPED: this kernel has no seccomp";
  }
  std::string folder = (std::filesystem::temp_directory_path() / "driftlab-sandbox-XXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  const std::string file = folder + "/there";
  const std::string absent = folder + "/absent";
  std::ofstream(file) << "kept";
  for (const Call& call : forbidden(file, absent)) {
    EXPECT_EQ(inside(call.ask), EPERM) << call.name;
  }
  std::string content;
  std::getline(std::ifstream(file), content);
  EXPECT_EQ(content, "kept");
  EXPECT_FALSE(std::filesystem::exists(absent));
  std::filesystem::remove_all(folder);
}

TEST(Sandbox, LeavesMemoryClocksAndWhatIsOpen) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  EXPECT_EQ(inside([&] {
              const std::vector<char> much(std::size_t{64} << 20, 'x');
              timespec now{};
              struct stat open_file{};
              const bool works = ::write(ends[1], &much.back(), 1) == 1 &&
                                 ::clock_gettime(CLOCK_MONOTONIC, &now) == 0 && ::fstat(ends[0], &open_file) == 0;
              return works ? 0 : 1;
            }),
            0);
  char said = '?';
  EXPECT_EQ(::read(ends[0], &said, 1), 1);
  EXPECT_EQ(said, 'x');
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(Sandbox, EndsAtItsLimitsOfMemoryAndOfFiles) {
  EXPECT_EQ(inside([] {
              try {
                const std::vector<char> more(2 * kMemory, 'x');
                return static_cast<int>(more.back());
              } catch (const std::bad_alloc&) {
                return 0;
              }
            }),
            0);
  std::string name = (std::filesystem::temp_directory_path() / "driftlab-sandbox-XXXXXX").string();
  const int file = ::mkstemp(name.data());  // open before, as a descriptor that was forgotten would be
  ASSERT_GE(file, 0);
  EXPECT_EQ(inside([&] { return ::write(file, "x", 1) == 1 ? 1 : 0; }), -SIGXFSZ);
  EXPECT_EQ(std::filesystem::file_size(name), 0U);
  ::close(file);
  std::filesystem::remove(name);
}

}  // namespace
}  // namespace driftlab::decode
