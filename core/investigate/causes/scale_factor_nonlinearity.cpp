/// scale_factor_nonlinearity: S2 w abs(w), or S3 w^3; the two are tried as shapes 2 and 3.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

#include <cmath>

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& group, double order,
           std::vector<std::vector<double>>& columns) {
  return follow_rate(recording, group, columns,
                     [order](double w) { return order > 2.5 ? w * w * w : w * std::fabs(w); });
}

std::vector<double> shapes(const ChannelGroup& /*group*/) { return {2.0, 3.0}; }

/// The two explain nearly the same; the cubic has to earn its place.
double shape_penalty(double order) { return order > 2.5 ? 3.0 : 0.0; }

double shown_power(const Stage& /*stage*/, Random& /*random*/) { return 2.0; }

}  // namespace

Cause scale_factor_nonlinearity() {
  return {.name = "scale_factor_nonlinearity",
          .title = "a scale factor that changes with the magnitude of the rate",
          .equation = "y = S₂ ω |ω| or y = S₃ ω³, ω the rate about the axis",
          .family = MeanEffect{.build = build,
                               .shapes = shapes,
                               .shape_of_parameter = {2.0, 3.0},
                               .penalty = 1.0,
                               .shape_penalty = shape_penalty,
                               .part_of_rate = true},
          .rivals = {"scale_factor_error", "scale_factor_asymmetry", "turn_on_bias"},
          .needs = "several rates, or a profile",
          .separates = "more rates between rest and the largest",
          .parameters = {{"S2", units::per_rate}, {"S3", units::per_rate_squared}},
          .lacks = lacks_rotation,
          .showing = {.scenario = Scenario::Profile, .shape = shown_power}};
}

}  // namespace driftlab::investigate
