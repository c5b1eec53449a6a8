#include "server/store/part_store.hpp"
#include "tests/unit/store/store_suite.hpp"

namespace driftlab::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* kProgram = "1.0";

class JobPartsStore : public StoreSuite {
 protected:
  /// A running job in `count` parts.
  Job divided(std::int64_t count, const std::string& key = "key") {
    EXPECT_TRUE(store().enqueue({"toy", key, R"({"algorithm_version":3,"kind":"toy"})"}));
    Job job = claim_one(store());
    const auto parts = store().parts().divide({job.id, job.attempt}, count, kProgram);
    EXPECT_TRUE(parts && parts->held);
    return job;
  }
  std::optional<PartClaim> claim(const Job& job, bool own = true) {
    const auto claimed = store().parts().claim_part(job.id, own, kLease);
    EXPECT_TRUE(claimed);
    return claimed.value_or(std::nullopt);
  }
  bool finish(const PartClaim& part, const std::string& text) {
    const auto written = store().parts().finish_part(part, text);
    return written && written->held;
  }
  std::vector<std::string> finished(const Job& job, std::int64_t first = 0, int limit = 100) {
    return store().parts().finished_parts(job.id, first, limit).value();
  }
  /// The id of the job; empty if there is none.
  std::string to_help(const std::vector<KnownKind>& known = {}, const std::string& program = kProgram) {
    const auto job = store().parts().job_to_help(known, program);
    EXPECT_TRUE(job);
    return job && *job ? (*job)->id : "";
  }
};
DRIFTLAB_OVER_ALL_STORES(JobPartsStore);

TEST_P(JobPartsStore, PartsAreTakenFirstToLastAndReadInOrder) {
  const Job job = divided(3);
  const auto first = claim(job);
  const auto second = claim(job, false);
  const auto third = claim(job);
  ASSERT_TRUE(first && second && third);
  EXPECT_EQ(first->number, 0);
  EXPECT_EQ(second->number, 1);
  EXPECT_EQ(third->number, 2);
  EXPECT_FALSE(claim(job));
  EXPECT_TRUE(finish(*third, "c"));
  EXPECT_THAT(finished(job), IsEmpty()) << "the first is not there yet";
  EXPECT_EQ(store().parts().count_finished_parts(job.id).value(), 1);
  EXPECT_TRUE(finish(*first, "a"));
  EXPECT_THAT(finished(job), ElementsAre("a"));
  EXPECT_TRUE(finish(*second, ""));
  EXPECT_THAT(finished(job), ElementsAre("a", "", "c"));
  EXPECT_THAT(finished(job, 1, 1), ElementsAre(""));
}

TEST_P(JobPartsStore, APartThatWasPutBackIsAnybodys) {
  const Job job = divided(1);
  const auto before = claim(job, false);
  ASSERT_TRUE(store().parts().put_back_part(*before)->held);
  EXPECT_FALSE(finish(*before, "late"));
  const auto again = claim(job, false);
  ASSERT_TRUE(again);
  EXPECT_TRUE(finish(*again, "a"));
  EXPECT_FALSE(finish(*again, "twice"));
  EXPECT_THAT(finished(job), ElementsAre("a"));
}

TEST_P(JobPartsStore, APartWhoseHelperDiedGoesToTheJobsOwnWorkerAlone) {
  const Job job = divided(1);
  const auto lost = claim(job, false);
  EXPECT_FALSE(claim(job, true)) << "its lease holds";
  clock_.advance(kLease / 2);
  ASSERT_TRUE(store().parts().renew_part(*lost, kLease)->held);
  clock_.advance(kLease - 1);
  EXPECT_FALSE(claim(job, true)) << "it was renewed";
  clock_.advance(1);
  EXPECT_FALSE(claim(job, false));
  const auto own = claim(job, true);
  ASSERT_TRUE(own);
  EXPECT_FALSE(store().parts().renew_part(*lost, kLease)->held);
  EXPECT_FALSE(finish(*lost, "late"));
  EXPECT_TRUE(finish(*own, "a"));
}

TEST_P(JobPartsStore, WhatWasFoundStaysForTheNextAttempt) {
  const Job job = divided(2);
  EXPECT_TRUE(finish(*claim(job), "a"));
  const auto lost = claim(job);
  ASSERT_TRUE(store().release({job.id, job.attempt}));
  EXPECT_FALSE(store().parts().divide({job.id, job.attempt}, 2, kProgram)->held) << "the lease is lost";
  const Job again = claim_one(store());
  ASSERT_EQ(again.id, job.id);
  ASSERT_TRUE(store().parts().divide({again.id, again.attempt}, 2, kProgram)->held);
  EXPECT_THAT(finished(job), ElementsAre("a"));
  EXPECT_TRUE(finish(*lost, "b")) << "a helper does not mind which attempt it is";
  EXPECT_THAT(finished(job), ElementsAre("a", "b"));
}

TEST_P(JobPartsStore, AnotherProgramOrAnotherNumberOfPartsBeginsAnew) {
  const Job job = divided(2);
  EXPECT_TRUE(finish(*claim(job), "a"));
  const auto former = claim(job);
  ASSERT_TRUE(store().release({job.id, job.attempt}));
  const Job again = claim_one(store());
  const Lease lease{again.id, again.attempt};
  ASSERT_TRUE(store().parts().divide(lease, 2, "2.0")->held);
  EXPECT_THAT(finished(job), IsEmpty());
  EXPECT_EQ(claim(job)->number, 0);
  EXPECT_EQ(claim(job)->number, 1);
  EXPECT_FALSE(finish(*former, "of the program before"));
  ASSERT_TRUE(store().parts().divide(lease, 1, "2.0")->held);
  EXPECT_EQ(claim(job)->number, 0);
  EXPECT_FALSE(claim(job));
}

TEST_P(JobPartsStore, PartsEndWithTheirJob) {
  for (const bool cancelled : {false, true}) {
    const Job job = divided(2, cancelled ? "cancelled" : "succeeded");
    const auto part = claim(job, false);
    const Lease lease{job.id, job.attempt};
    if (cancelled) {
      ASSERT_TRUE(store().request_cancel(job.id));
      EXPECT_TRUE(store().parts().renew_part(*part, kLease)->cancel_requested);
      EXPECT_EQ(to_help(), "");
      ASSERT_TRUE(store().acknowledge_cancel(lease));
    } else {
      ASSERT_TRUE(store().succeed(lease, {R"({"done":true})", {}, {}}));
    }
    EXPECT_FALSE(store().parts().renew_part(*part, kLease)->held);
    EXPECT_FALSE(finish(*part, "late"));
    EXPECT_THAT(finished(job), IsEmpty());
    EXPECT_EQ(to_help(), "");
  }
}

TEST_P(JobPartsStore, HelpersFindWhatTheyCanRun) {
  EXPECT_EQ(to_help(), "");
  const Job job = divided(1);
  EXPECT_EQ(to_help(), job.id);
  EXPECT_EQ(to_help({{"toy", 3}}), job.id);
  EXPECT_EQ(to_help({{"toy", 2}}), "") << "an earlier version";
  EXPECT_EQ(to_help({{"other", 9}}), "");
  EXPECT_EQ(to_help({}, "1.1"), "") << "another program";
  const auto part = claim(job);
  EXPECT_EQ(to_help(), "") << "nothing is left to begin";
  ASSERT_TRUE(store().parts().put_back_part(*part));
  EXPECT_EQ(to_help(), job.id);
  ASSERT_TRUE(store().release({job.id, job.attempt}));
  EXPECT_EQ(to_help(), "") << "nobody runs it";
}

TEST_P(JobPartsStore, AResultOfMegabytesIsKeptAsItIs) {
  const Job job = divided(1);
  std::string text(3'000'001, 'x');
  for (std::size_t i = 0; i < text.size(); i += 7) {
    text[i] = static_cast<char>('A' + static_cast<char>(i % 26));
  }
  EXPECT_TRUE(finish(*claim(job), text));
  EXPECT_THAT(finished(job), ElementsAre(text));
}

}  // namespace
}  // namespace driftlab::server
