/// What a job will take: refused where it could never run, or never end in time.
#include "server/jobs/job_cost.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftlab::server {
namespace {

using testing::HasSubstr;

TEST(JobCost, TimeIsThatOfTheThreadsThatJobsComputeOn) {
  // An outage evaluation took the machine's cores to estimate its time whatever --threads said: on fewer it was
  // admitted, ran, and was ended by its deadline.
  Budgets budgets;
  budgets.job_seconds = 100;
  JobCost cost;
  cost.shared_seconds = 350.0;
  EXPECT_TRUE(admit_cost(cost, budgets, 4));
  const Status refused = admit_cost(cost, budgets, 2);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::LimitExceeded);
  EXPECT_THAT(refused.error().message, HasSubstr("about 175 s"));
  cost.seconds = 20.0;  // of what cannot be shared
  EXPECT_FALSE(admit_cost(cost, budgets, 4));
}

TEST(JobCost, MoreMemoryThanAllJobsHaveIsRefused) {
  Budgets budgets;
  budgets.job_memory_bytes = std::int64_t{64} << 20;
  JobCost cost;
  cost.memory_bytes = budgets.job_memory_bytes;
  EXPECT_TRUE(admit_cost(cost, budgets, 1));
  ++cost.memory_bytes;
  const Status refused = admit_cost(cost, budgets, 1);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("job_memory_bytes"));
}

}  // namespace
}  // namespace driftlab::server
