#include "tests/unit/store/store_suite.hpp"

#include <mutex>
#include <set>
#include <thread>

namespace driftlab::server {
namespace {

using ConcurrentStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(ConcurrentStore);

constexpr int kThreads = 8;

template <class Work>
void in_threads(Work work) {
  std::vector<std::thread> threads;
  threads.reserve(kThreads);
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&work, i] { work(i); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
}

TEST_P(ConcurrentStore, EqualJobsAskedForAtOnceAreOneJob) {
  for (int round = 0; round < 10; ++round) {
    std::atomic<int> created{0};
    std::mutex mutex;
    std::set<std::string> ids;
    in_threads([&](int) {
      const auto job = store().enqueue({"characterise", "key " + std::to_string(round), "{}"});
      ASSERT_TRUE(job) << job.error().message;
      created += job->created ? 1 : 0;
      const std::lock_guard<std::mutex> guard(mutex);
      ids.insert(job->job.id);
    });
    EXPECT_EQ(created, 1);
    EXPECT_EQ(ids.size(), 1U);
  }
}

TEST_P(ConcurrentStore, EveryJobIsClaimedOnce) {
  constexpr int kJobs = 40;
  for (int i = 0; i < kJobs; ++i) {
    add_job(store(), "key " + std::to_string(i));
  }
  std::mutex mutex;
  std::multiset<std::string> claimed;
  in_threads([&](int) {
    while (true) {
      const auto job = store().claim(kLease);
      ASSERT_TRUE(job) << job.error().message;
      if (!*job) {
        return;
      }
      EXPECT_EQ((*job)->attempt, 1);
      const std::lock_guard<std::mutex> guard(mutex);
      claimed.insert((*job)->id);
    }
  });
  EXPECT_EQ(claimed.size(), std::size_t{kJobs});
  EXPECT_EQ(std::set<std::string>(claimed.begin(), claimed.end()).size(), std::size_t{kJobs});
}

TEST_P(ConcurrentStore, DevicesAndRecordingsAskedForAtOnceAreMadeOnce) {
  std::atomic<int> devices{0};
  std::atomic<int> recordings{0};
  in_threads([&](int) {
    Device wanted;
    wanted.name = "phone-07";
    const auto device = store().ensure_device(wanted);
    ASSERT_TRUE(device) << device.error().message;
    devices += device->created ? 1 : 0;
    Blob blob;
    blob.sha256 = hash_of("bytes");
    Recording recording;
    recording.device_id = device->device.id;
    const auto added = store().add_recording(blob, recording);
    ASSERT_TRUE(added) << added.error().message;
    recordings += added->created ? 1 : 0;
  });
  EXPECT_EQ(devices, 1);
  EXPECT_EQ(recordings, 1);
}

TEST_P(ConcurrentStore, OneOfManyChangesOfARevisionWins) {
  const Device device = add_device(store());
  std::atomic<int> won{0};
  in_threads([&](int i) {
    DeviceChange change;
    change.model = std::to_string(i);
    won += store().update_device(device.id, change, 1).has_value() ? 1 : 0;
  });
  EXPECT_EQ(won, 1);
  EXPECT_EQ(store().device(device.id)->revision, 2);
}

TEST_P(ConcurrentStore, AWriteThatFailsTakesNoNeighbourWithIt) {
  std::atomic<int> made{0};
  std::atomic<int> refused{0};
  in_threads([&](int i) {
    for (int n = 0; n < 25; ++n) {
      const int priority = (n + i) % 2 == 0 ? 5 : 42;
      const auto job = store().enqueue({"characterise", std::to_string(i) + "/" + std::to_string(n), "{}", priority});
      (job ? made : refused) += 1;
    }
  });
  EXPECT_EQ(made, kThreads * 25 / 2);
  EXPECT_EQ(refused, kThreads * 25 / 2);
  EXPECT_EQ(store().jobs({}, {"", 500})->size(), static_cast<std::size_t>(made));
}

TEST_P(ConcurrentStore, WhatWasAcknowledgedIsReadByOthersAtOnce) {
  in_threads([&](int i) {
    for (int n = 0; n < 10; ++n) {
      const Device device = add_device(store(), std::to_string(i) + "/" + std::to_string(n));
      const auto read = store().device(device.id);
      ASSERT_TRUE(read) << read.error().message;
    }
  });
}

TEST_P(ConcurrentStore, TwoWorkersOnOneLeaseFinishOnce) {
  const Recording recording = add_recording(store(), add_device(store()));
  for (int round = 0; round < 5; ++round) {
    add_job(store(), "key " + std::to_string(round));
    const Job job = claim_one(store());
    std::atomic<int> finished{0};
    in_threads([&](int i) {
      const auto status = i % 2 == 0 ? store().succeed(lease_of(job), results_for(job, recording))
                                     : store().fail_attempt(lease_of(job), {"{}"});
      ASSERT_TRUE(status) << status.error().message;
      finished += status->held ? 1 : 0;
    });
    EXPECT_EQ(finished, 1);
    FitFilter filter;
    filter.job_id = job.id;
    EXPECT_EQ(store().fits(filter, {})->size(), store().job(job.id)->state == JobState::Succeeded ? 2U : 0U);
  }
}

}  // namespace
}  // namespace driftlab::server
