#include "core/read/decode_process.hpp"

#include "core/read/posix_file.hpp"
#include "core/read/variable_stream.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace driftlab {
namespace {

constexpr std::uint64_t kLargest = std::uint64_t{2} << 30;
constexpr int kInput = 3;          ///< the descriptor of the input in the child
constexpr int kLookEveryMs = 100;  ///< for a request to stop

Error system_error_of(int number, const std::string& action) {
  return {ErrorCode::Io, action + ": " + std::error_code(number, std::generic_category()).message() + ".", {}};
}

/// The input in memory that has a descriptor.
Result<posix::FileDescriptor> hold(ByteSource& source, const std::string& what, const RunControl& control) {
  posix::FileDescriptor held(::memfd_create("recording", MFD_CLOEXEC));
  if (held.get() < 0) {
    return fail(system_error_of(errno, "The " + what + " cannot be held in memory"));
  }
  std::uint64_t size = 0;
  for (;;) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto view = source.view();
    if (!view) {
      return fail(view.error());
    }
    if (view->empty()) {
      return held;
    }
    size += view->size();
    if (size > kLargest) {
      return fail(ErrorCode::LimitExceeded, "A " + what + " may have up to 2 GiB.",
                  {{"limit", std::to_string(kLargest)}});
    }
    if (auto written = posix::write_all(held.get(), std::as_bytes(std::span(*view)), "recording"); !written) {
      return fail(written.error());
    }
    source.consume(view->size());
  }
}

/// A child process that is ended and waited for.
class Child {
 public:
  Child() = default;
  explicit Child(pid_t pid) : pid_(pid) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

 private:
  pid_t pid_ = -1;
};

Result<pid_t> start(const std::string& format, std::size_t budget, int input, int output) {
  std::error_code failed;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
  const std::string program = (self.parent_path() / "driftlab-decode").string();
  if (failed || ::access(program.c_str(), X_OK) != 0) {
    return fail(ErrorCode::Io, "The program driftlab-decode, which reads this format, is not beside " +
                                   self.filename().string() + ".");
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, input, kInput);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addclosefrom_np(&actions, kInput + 1);
  std::string name = "driftlab-decode";
  std::string kind = format;
  std::string most = std::to_string(budget);
  const std::array<char*, 4> words{name.data(), kind.data(), most.data(), nullptr};
  const std::array<char*, 1> environment{nullptr};
  pid_t pid = -1;
  const int error = ::posix_spawn(&pid, program.c_str(), &actions, nullptr, words.data(), environment.data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    return fail(system_error_of(error, "The program driftlab-decode cannot be started"));
  }
  return pid;
}

/// The next bytes of the child; polls the request to stop.
Result<std::size_t> read_from(int fd, std::span<char> into, const RunControl& control) {
  for (;;) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    pollfd waiting{fd, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, kLookEveryMs);
    if (ready == 0 || (ready < 0 && errno == EINTR)) {
      continue;
    }
    const ssize_t got = ready < 0 ? -1 : ::read(fd, into.data(), into.size());
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got < 0) {
      return fail(system_error_of(errno, "What driftlab-decode says cannot be read"));
    }
    return static_cast<std::size_t>(got);
  }
}

}  // namespace

Status decode_apart(const std::string& format, const std::string& what, ByteSource& source, const DecodeLimits& limits,
                    ColumnSink& sink, const RunControl& control) {
  auto input = hold(source, what, control);
  if (!input) {
    return fail(input.error());
  }
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return fail(system_error_of(errno, "The program driftlab-decode cannot be listened to"));
  }
  const posix::FileDescriptor listening(ends[0]);
  auto speaking = std::make_unique<posix::FileDescriptor>(ends[1]);
  const auto pid = start(format, limits.max_tables_bytes, input->get(), speaking->get());
  speaking.reset();
  if (!pid) {
    return fail(pid.error());
  }
  const Child child(*pid);
  auto stream = read_variables([&](std::span<char> into) { return read_from(listening.get(), into, control); },
                               limits.max_tables_bytes, limits.max_name_bytes);
  if (!stream) {
    return fail(stream.error());
  }
  if (!stream->whole) {
    return fail(ErrorCode::ShapeMismatch, "The " + what +
                                              " cannot be read: it is damaged, or takes more memory or time than one "
                                              "decoding may.");
  }
  const std::string first = stream->notes.empty() ? "" : stream->notes.front();
  for (std::string& note : stream->notes) {
    sink.note(std::move(note));
  }
  auto status = deliver_variables(std::move(stream->variables), limits, sink);
  if (!status && status.error().code == ErrorCode::NoSamples && !first.empty()) {  // why there is none
    Error error = status.error();
    error.message = "The " + what + " holds no array that is read: " + first;
    return fail(std::move(error));
  }
  return status;
}

}  // namespace driftlab
