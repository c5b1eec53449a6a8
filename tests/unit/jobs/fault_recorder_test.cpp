#include "server/jobs/fault_recorder.hpp"

#include "server/store/clock.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

namespace driftlab::server {
namespace {

class FaultRecorder : public testing::Test {
 protected:
  FaultRecorder() : file_(std::filesystem::path(testing::TempDir()) / ("faults-" + std::to_string(getpid()))) {}
  void TearDown() override { std::filesystem::remove(file_); }

  /// A child process that dies by `signal`, at work on `lease` or idle. What it died of.
  int die_in_child(int signal, const Lease* lease) const {
    const pid_t child = fork();
    if (child == 0) {
      if (!install_fault_recorder(file_)) {
        _exit(3);
      }
      if (lease != nullptr) {
        const FaultScope scope(*lease);
        std::raise(signal);
      }
      std::raise(signal);
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

  std::filesystem::path file_;
};

TEST_F(FaultRecorder, ChargesTheAttemptThatWasAtWork) {
  const Lease lease{make_id("job", 1), 7};
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE}) {
    EXPECT_EQ(die_in_child(signal, &lease), signal);
  }
  const auto faults = take_recorded_faults(file_);
  ASSERT_TRUE(faults);
  ASSERT_EQ(faults->size(), 3U);
  EXPECT_EQ(faults->front().job_id, lease.job_id);
  EXPECT_EQ(faults->front().attempt, 7);
  const auto again = take_recorded_faults(file_);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->empty()) << "a fault is charged once";
}

TEST_F(FaultRecorder, ChargesNobodyForAnIdleThreadOrAKill) {
  const Lease lease{make_id("job", 1), 1};
  EXPECT_EQ(die_in_child(SIGSEGV, nullptr), SIGSEGV);
  EXPECT_EQ(die_in_child(SIGKILL, &lease), SIGKILL);
  const auto faults = take_recorded_faults(file_);
  ASSERT_TRUE(faults);
  EXPECT_TRUE(faults->empty());
}

TEST_F(FaultRecorder, SkipsLinesThatADyingProcessLeftIncomplete) {
  std::ofstream(file_) << "job_short 1\n\nnonsense\n" << make_id("job", 1) << " x\n" << make_id("job", 2) << " 4\n";
  const auto faults = take_recorded_faults(file_);
  ASSERT_TRUE(faults);
  ASSERT_EQ(faults->size(), 1U);
  EXPECT_EQ(faults->front().attempt, 4);
}

}  // namespace
}  // namespace driftlab::server
