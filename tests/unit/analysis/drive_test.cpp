/// What is asked of a drive, what is refused, and what its answer says first.
#include "core/analysis/drive.hpp"

#include "tests/unit/navigate/drive_fixture.hpp"

namespace driftlab {
namespace {

using drive::simulated_drive;

TEST(DriveUseCase, EveryQuestionIsReadByItsName) {
  for (const DriveQuestion question :
       {DriveQuestion::Run, DriveQuestion::Simulate, DriveQuestion::Explain, DriveQuestion::Compare}) {
    EXPECT_EQ(parse_drive_question(name_of(question)), question);
  }
  EXPECT_FALSE(parse_drive_question("race"));
}

TEST(DriveUseCase, EstimatesWhatTheDocumentLeavesOpenAndNothingElse) {
  drive::Document document;
  document.gnss.lever_arm_sd_m = 0.3;
  document.imu.mounting_sd_rad = 0.01;
  DriveRequest request;
  const auto sds = [&] {
    std::vector<double> list;
    for (const drive::EstimatedConstant& constant : options_of(request, document).constants) {
      list.push_back(constant.sd);
    }
    return list;
  };
  EXPECT_TRUE(sds().empty()) << "nobody asked";
  request.estimate = true;
  EXPECT_EQ(sds(), (std::vector<double>{0.3, 0.3, 0.3})) << "the mounting is unobservable without the constraint";
  request.velocity_constraint = true;
  EXPECT_EQ(sds(), (std::vector<double>{0.3, 0.3, 0.3, 0.01, 0.01, 1.5})) << "no document says where the axle is";
  request.odometer = true;
  EXPECT_EQ(sds(), (std::vector<double>{0.3, 0.3, 0.3, 0.01, 0.01, 1.5, 0.05}));
  document.gnss.lever_arm_sd_m = 0.0;
  EXPECT_EQ(sds().size(), 4U) << "an arm that is known is no state";
}

TEST(DriveUseCase, RefusesWhatTheVehicleOrTheDriveDoesNotHave) {
  drive::Drive flight;
  flight.document.vehicle = drive::Vehicle::Air;
  drive::FilterOptions options;
  options.constraint.emplace();
  const Status constrained = check_options(flight, options);
  ASSERT_FALSE(constrained);
  EXPECT_EQ(constrained.error().fields.front().value, "vehicle");
  options = {};
  options.odometer = true;
  const Status without = check_options(flight, options);
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().fields.front().value, "odometer");
  EXPECT_TRUE(check_options(flight, {}));
}

TEST(DriveUseCase, ACheckSumsItsRestsAndTellsTheShareOfRepeatedRows) {
  DriveCheck checked;
  EXPECT_EQ(checked.resting_s(), 0.0);
  EXPECT_EQ(checked.repeated_percent(), 0.0) << "of no rows";
  checked.rests = {{.from_s = 2.0, .to_s = 5.0}, {.from_s = 10.0, .to_s = 14.5}};
  checked.drive.facts.sampling.rows = 400;
  checked.drive.facts.sampling.repeated = 7;
  EXPECT_EQ(checked.resting_s(), 7.5);
  EXPECT_EQ(checked.repeated_percent(), 1.75);
}

TEST(DriveUseCase, TheFirstSentenceHoldsWhatWasMeasuredAgainstWhatWasPromised) {
  // A gyroscope five times as noisy as the document says: the errors of the outages exceed the filter's promise.
  const auto honest = run_drive(simulated_drive(31), {});
  const auto optimistic = run_drive(simulated_drive(31, {.noise_factor = 5.0}), {});
  ASSERT_TRUE(honest && optimistic);
  const auto ratio = [](const DriveReport& report) {
    const drive::DurationSummary& first = report.evaluation.durations.front();
    return first.rms_m.value / first.promised_rms_m;
  };
  EXPECT_LT(ratio(*honest), 1.5);
  EXPECT_GT(ratio(*optimistic), 1.5 * ratio(*honest));
  const std::string sentence = sentence_of(*optimistic);
  EXPECT_NE(sentence.find("times as much as the model promises."), std::string::npos) << sentence;
  EXPECT_EQ(sentence.find("After 10 s without fixes"), 0) << sentence;
}

TEST(DriveUseCase, AComparisonAsksForTwoModelsThatItKnows) {
  DriveRequest request;
  request.question = DriveQuestion::Compare;
  request.models = {{"a model nobody knows", std::nullopt}, {known_drive_models().front(), std::nullopt}};
  const auto unknown = compare_drive_models(simulated_drive(32, {}, 2), request);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::InvalidArgument);
  EXPECT_NE(unknown.error().message.find("nobody knows"), std::string::npos) << unknown.error().message;
  request.models = {{known_drive_models().front(), std::nullopt}};
  EXPECT_FALSE(compare_drive_models(simulated_drive(32, {}, 2), request)) << "one model is no comparison";
}

}  // namespace
}  // namespace driftlab
