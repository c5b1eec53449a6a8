#include "tests/unit/store/store_suite.hpp"

#include <gmock/gmock.h>

namespace driftlab::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class OverviewStore : public StoreSuite {
 protected:
  /// A finished job with one channel of the recording. `json`: what it says at a glance.
  Job finish(const Recording& recording, const std::string& json, int level, const std::string& axis = "z",
             const std::string& channel = "gz") {
    clock_.advance(kMinute);
    add_job(store(), "key " + std::to_string(++jobs_));
    const Job job = claim_one(store());
    JobResults results = results_for(job, recording, channel);
    results.channels.front().glance = {json, level};
    results.channels.front().axis = axis;
    EXPECT_TRUE(store().succeed(lease_of(job), results)->held);
    return job;
  }
  [[nodiscard]] DeviceOverview of(const std::string& device) { return store().overviews({device}).value().at(device); }
  [[nodiscard]] std::vector<std::string> shown(const std::string& device) {
    std::vector<std::string> glances;
    for (const ShownResult& result : of(device).axes) {
      glances.push_back(result.glance_json);
    }
    return glances;
  }

  Device device_ = add_device(store());
  Recording rest_ = add_recording(store(), device_, "a");
  Recording rest_again_ = add_recording(store(), device_, "b");
  Recording turning_ = add_recording(store(), device_, "c", "constant_rate:z:9:deg/s");
  Recording turning_faster_ = add_recording(store(), device_, "d", "constant_rate:z:90:deg/s");

 private:
  int jobs_ = 0;
};
DRIFTLAB_OVER_ALL_STORES(OverviewStore);

TEST_P(OverviewStore, RestOutranksMotionAndOfTwoAtRestTheOneToBeLookedAtShows) {
  EXPECT_THAT(shown(device_.id), IsEmpty());
  finish(turning_, R"("first in motion")", 0);
  EXPECT_THAT(shown(device_.id), ElementsAre(R"("first in motion")"));
  finish(turning_faster_, R"("second in motion")", 2);
  EXPECT_THAT(shown(device_.id), ElementsAre(R"("first in motion")")) << "whatever it comes to";
  finish(rest_, R"("fine")", 0);
  EXPECT_THAT(shown(device_.id), ElementsAre(R"("fine")"));
  finish(rest_again_, R"("look")", 1);
  EXPECT_THAT(shown(device_.id), ElementsAre(R"("look")"));
  finish(rest_again_, R"("fine now")", 0);
  EXPECT_THAT(shown(device_.id), ElementsAre(R"("fine")")) << "the newer result of a recording replaces the older";
  const ShownResult result = of(device_.id).axes.front();
  EXPECT_EQ(result.quantity, "angular_rate");
  EXPECT_EQ(result.axis, "z");
  EXPECT_EQ(result.recording_id, rest_.id);
  EXPECT_EQ(result.condition, "static");
}

TEST_P(OverviewStore, EachAxisIsShownAndAChannelWithoutFitsIsNot) {
  finish(rest_, R"("z")", 0);
  finish(rest_, R"("x")", 0, "x", "gx");
  finish(rest_again_, R"("unnamed")", 0, "", "g");
  finish(rest_again_, "null", 1, "y", "gy");
  EXPECT_THAT(shown(device_.id), ElementsAre(R"("unnamed")", R"("x")", R"("z")"));
  finish(rest_, R"("was z")", 0, "y");
  EXPECT_THAT(shown(device_.id), ElementsAre(R"("unnamed")", R"("x")", R"("was z")"))
      << "the column has another axis now";
}

TEST_P(OverviewStore, GoesWithTheRecordingItWasMadeOf) {
  finish(turning_, R"("in motion")", 0);
  finish(rest_, R"("at rest")", 0);
  ASSERT_TRUE(store().remove_recording(rest_.id, 1));
  EXPECT_THAT(shown(device_.id), ElementsAre(R"("in motion")"));
}

TEST_P(OverviewStore, CountsConditionsAndKnowsTheNewestResultAndVerdict) {
  EXPECT_FALSE(of(device_.id).newest);
  EXPECT_FALSE(of(device_.id).verdict);
  finish(rest_, R"("one")", 0);
  const Job newest = finish(turning_, R"("two")", 0);
  const DeviceOverview overview = of(device_.id);
  ASSERT_TRUE(overview.newest);
  EXPECT_EQ(overview.newest->job_id, newest.id);
  EXPECT_EQ(overview.newest->recording_id, turning_.id);
  EXPECT_EQ(overview.newest->created_at, clock_.now());
  ASSERT_EQ(overview.conditions.size(), 3U);
  EXPECT_EQ(overview.conditions.front().condition, "constant_rate:z:90:deg/s");
  EXPECT_EQ(overview.conditions.back().condition, "static");
  EXPECT_EQ(overview.conditions.back().recordings, 2);
}

TEST_P(OverviewStore, SeveralDevicesAreReadAtOnceAndOnlyThoseThatAreSeen) {
  const Device other = add_device(store(), "other");
  const Recording recording = add_recording(store(), other, "e");
  finish(rest_, R"("one")", 0);
  finish(recording, R"("another's")", 0);
  const DeviceOverviews both = store().overviews({device_.id, other.id, make_id("dev", 0)}).value();
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both.at(device_.id).axes.front().glance_json, R"("one")");
  EXPECT_EQ(both.at(other.id).axes.front().glance_json, R"("another's")");
  EXPECT_EQ(both.at(other.id).conditions.front().recordings, 1);
  const Visibility limited{R"(["other"])", "token"};
  const DeviceOverviews seen = store().overviews({device_.id, other.id}, limited).value();
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_TRUE(seen.contains(other.id));
  EXPECT_THAT(store().overviews({}).value(), IsEmpty());
}

}  // namespace
}  // namespace driftlab::server
