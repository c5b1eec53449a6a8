#pragma once
/// Error models from publications, for simulating recordings that may be distributed and for checking fits.
///
/// `iphone5s-z` is the z gyroscope of an iPhone 5S on a rate table, from Table 4 of Radi, Nassar and El-Sheimy (2017),
/// "Stochastic Error Modeling of Smartphone Inertial Sensors for Navigation in Varying Dynamic Conditions": model 6,
/// WN+2GM, and under angular acceleration, where the second Gauss-Markov process is absent, model 2. N is in
/// deg/sqrt(h). sigma^2 is read as (deg/sqrt(h))^2 with sigma [deg/s] = sqrt(value)/60, since this reading agrees with
/// the bias instability of the paper's Table 2.
#include "core/process/model.hpp"
#include "core/signal/condition.hpp"

#include <string_view>
#include <vector>

namespace driftlab {

struct PublishedModel {
  std::string_view preset;  ///< `iphone5s-z`
  Condition condition;
  Model model;  ///< SI: rad/s
};

/// Every published model, presets in alphabetical order, conditions as in the source.
[[nodiscard]] const std::vector<PublishedModel>& published_models();

/// Errors: NotFound (no such preset, or not under this condition), naming what there is.
[[nodiscard]] Result<Model> published_model(std::string_view preset, const Condition& condition);

}  // namespace driftlab
