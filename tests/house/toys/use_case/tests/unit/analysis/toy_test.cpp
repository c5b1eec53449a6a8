#include "core/analysis/toy.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

class Nothing final : public RecordingSource {
 public:
  [[nodiscard]] std::size_t count() const override { return 0; }
  [[nodiscard]] Result<SourceRecording> open(std::size_t /*index*/, const RunControl& /*control*/) override {
    return fail(ErrorCode::NotFound, "There is none.");
  }
  [[nodiscard]] Result<Calibration> calibration(std::size_t /*index*/) override { return Calibration{}; }
  [[nodiscard]] Error located(std::size_t /*index*/, Error error) const override { return error; }
};

TEST(Toy, NothingInNothingOut) {
  Nothing recordings;
  const auto report = toy(recordings);
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->means.empty());
}

}  // namespace
}  // namespace driftlab
