#include "core/analysis/plan.hpp"

#include "core/process/random.hpp"
#include "tests/unit/analysis/file_source.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace driftlab {
namespace {

/// Half a minute of a gyroscope at rest.
void add_rest(FileSource& files) {
  Random random(11);
  std::string text = "gz\n";
  for (int i = 0; i < 1500; ++i) {
    char line[32];
    std::snprintf(line, sizeof line, "%.6f\n", 0.05 * random.normal());
    text += line;
  }
  RecordingSpec spec;
  spec.id = "rest";
  spec.rate_hz = 50.0;
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  files.add(spec, text);
}

/// A plan of no runs divided by nothing and promised a probability that is no number.
TEST(PlanStudy, NoRunsAreRefusedBeforeAnythingIsRead) {
  FileSource files;
  const auto planned = plan_study({{}, {.runs = 0}}, files);
  ASSERT_FALSE(planned);
  EXPECT_EQ(planned.error().code, ErrorCode::InvalidArgument);
  EXPECT_NE(planned.error().message.find("one simulated study or more"), std::string::npos);
}

TEST(PlanStudy, ARestAloneLeavesOpenWhatOnlyMotionShows) {
  FileSource files;
  add_rest(files);
  const auto planned = plan_study({{}, {.runs = 1}}, files);
  ASSERT_TRUE(planned) << planned.error().message;
  bool motion = false;
  for (const auto& question : planned->plan.open) {
    motion = motion || question.cause == "scale_factor_error";
    EXPECT_FALSE(question.channel.empty());
  }
  EXPECT_TRUE(motion);
  for (const auto& proposal : planned->plan.proposals) {
    EXPECT_GT(proposal.expected(), 0.0);
    for (const auto& decision : proposal.decisions) {
      EXPECT_LT(decision.question, planned->plan.open.size());
    }
  }
}

}  // namespace
}  // namespace driftlab
