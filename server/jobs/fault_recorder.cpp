#include "server/jobs/fault_recorder.hpp"

#include "core/signal/text.hpp"
#include "server/store/clock.hpp"
#include "server/store/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>

namespace driftlab::server {
namespace {

thread_local constinit FaultLine at_work{{}, 0};
std::atomic<int> descriptor{-1};

void record_and_die(int signal) {
  const int file = descriptor.load();
  if (file >= 0 && at_work.size > 0) {
    // Nothing can be done about a failing write here: the process is dying.
    [[maybe_unused]] const auto written = ::write(file, at_work.text.data(), at_work.size);
    (void)::fdatasync(file);
  }
  (void)std::signal(signal, SIG_DFL);
  (void)std::raise(signal);
}

std::optional<Lease> parse_line(std::string_view line) {
  const std::vector<std::string_view> words = split(line, ' ');
  Lease lease;
  if (words.size() != 2 || !is_id(words[0], "job")) {
    return std::nullopt;
  }
  lease.job_id = words[0];
  const auto [stop, error] = std::from_chars(words[1].data(), words[1].data() + words[1].size(), lease.attempt);
  return error == std::errc{} && stop == words[1].data() + words[1].size() ? std::optional(lease) : std::nullopt;
}

}  // namespace

Status install_fault_recorder(const std::filesystem::path& file) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (opened < 0) {
    return fail(file_error(errno, "open", file));
  }
  if (const int before = descriptor.exchange(opened); before >= 0) {
    (void)::close(before);
  }
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    (void)std::signal(signal, record_and_die);
  }
  return {};
}

Result<std::vector<Lease>> take_recorded_faults(const std::filesystem::path& file) {
  std::vector<Lease> faults;
  if (!std::filesystem::exists(file)) {
    return faults;
  }
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) {
    return fail(file_error(EIO, "read", file));
  }
  for (const std::string_view line : split(text, '\n')) {
    if (auto lease = parse_line(line)) {
      faults.push_back(std::move(*lease));
    }
  }
  if (::truncate(file.c_str(), 0) != 0) {
    return fail(file_error(errno, "empty", file));
  }
  return faults;
}

FaultScope::FaultScope(const Lease& lease) : before_(at_work) {
  const std::string text = lease.job_id + " " + std::to_string(lease.attempt) + "\n";
  at_work.size = std::min(text.size(), at_work.text.size());
  std::copy_n(text.begin(), at_work.size, at_work.text.begin());
}

FaultScope::~FaultScope() { at_work = before_; }

}  // namespace driftlab::server
