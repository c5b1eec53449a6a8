#include "schema/json/error_model.hpp"

#include "core/process/registry.hpp"
#include "tests/process_examples.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

/// Lab units and back, of a gyroscope's, an accelerometer's and any other channel's.
TEST(ErrorModel, OfEveryRegisteredProcessComesBackFromItsDocument) {
  for (const ProcessKind& kind : process_registry()) {
    const Model model{example_of(kind, 2.0, kDt)};
    for (const Dimension channel : {Dimension::AngularRate, Dimension::SpecificForce, Dimension::One}) {
      Faults faults;
      const Model read = model_from_json(to_json(model, channel), channel, "", faults);
      ASSERT_TRUE(faults.none()) << kind.name;
      ASSERT_EQ(read.size(), 1U) << kind.name;
      ASSERT_EQ(read[0].kind, &kind);
      for (std::size_t k = 0; k < kind.parameters.size(); ++k) {
        EXPECT_NEAR(read[0].parameters[k], model[0].parameters[k], 1e-12 * model[0].parameters[k])
            << kind.name << " " << kind.parameters[k].name;
      }
    }
  }
}

TEST(ErrorModel, RefusesAShapeBeyondItsBoundsByName) {
  Faults faults;
  const Json document = *parse_json(
      R"([{"process": "power_law", "params": {"B": {"value": 1, "unit": "deg/h"}, "alpha": {"value": 2.5, "unit": "1"}}}])");
  (void)model_from_json(document, Dimension::AngularRate, "/processes", faults);
  ASSERT_FALSE(faults.none());
}

}  // namespace
}  // namespace driftlab
