#include "clients/decode/sandbox.hpp"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <vector>

namespace driftlab::decode {
namespace {

constexpr rlim_t kSeconds = 120;

bool limit(__rlimit_resource_t what, rlim_t most) {
  const rlimit wanted{most, most};
  return ::setrlimit(what, &wanted) == 0;
}

/// What a library needs to compute with what it has been given; all else is refused with EPERM, and so is what a later
/// kernel adds. newfstatat is how the C library asks for the size of an open file.
constexpr std::array kAllowed{
    SYS_read,
    SYS_pread64,
    SYS_write,
    SYS_writev,
    SYS_lseek,
    SYS_close,
    SYS_fstat,
    SYS_newfstatat,
    SYS_mmap,
    SYS_munmap,
    SYS_mremap,
    SYS_mprotect,
    SYS_madvise,
    SYS_brk,
    SYS_futex,
    SYS_exit,
    SYS_exit_group,
    SYS_rt_sigreturn,
    SYS_rt_sigaction,
    SYS_rt_sigprocmask,
    SYS_sigaltstack,
    SYS_clock_gettime,
    SYS_clock_nanosleep,
    SYS_restart_syscall,
    SYS_gettimeofday,
    SYS_getrandom,
    SYS_getpid,
    SYS_gettid,
    SYS_getrusage,
    SYS_sched_yield,
    SYS_sched_getaffinity,
};

#if defined(__x86_64__)
constexpr unsigned kMachine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr unsigned kMachine = AUDIT_ARCH_AARCH64;
#endif

void refuse_other_calls() {
  std::vector<sock_filter> filter;
  const auto add = [&](sock_filter instruction) { filter.push_back(instruction); };
  add(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)));
  add(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kMachine, 1, 0));
  add(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS));
  add(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)));
  for (const auto call : kAllowed) {
    add(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, 1));
    add(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  }
  add(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM));
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  (void)::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

#ifdef DRIFTLAB_SANITIZED
/// Memory that is used instead of addresses; no look for leaks, which needs calls that the filter refuses.
constexpr const char* kSanitizerOptions = "detect_leaks=0:hard_rss_limit_mb=1024:allocator_may_return_null=1";
#endif

}  // namespace

bool enter_sandbox(std::size_t memory_bytes) {
#ifdef DRIFTLAB_SANITIZED
  const bool enough = memory_bytes > 0;  // a sanitizer reserves terabytes of addresses: kSanitizerOptions limits memory
#else
  const bool enough = limit(RLIMIT_AS, memory_bytes);
#endif
  const bool limited = enough && limit(RLIMIT_CPU, kSeconds) && limit(RLIMIT_FSIZE, 0) && limit(RLIMIT_CORE, 0);
  if (!limited || ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
    return false;
  }
  refuse_other_calls();
  return true;
}

}  // namespace driftlab::decode

#ifdef DRIFTLAB_SANITIZED
// What the run-time of a sanitizer asks for; the process is started without an environment.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {
const char* __asan_default_options();
const char* __tsan_default_options();
const char* __asan_default_options() { return driftlab::decode::kSanitizerOptions; }
const char* __tsan_default_options() { return driftlab::decode::kSanitizerOptions; }
}
// NOLINTEND(bugprone-reserved-identifier)
#endif
