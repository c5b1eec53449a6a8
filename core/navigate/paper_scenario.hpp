#pragma once
/// Section 4 of Radi, Nassar and El-Sheimy (2017) as a scenario, with fixed values for what the paper leaves unstated.
///
/// The drive lasts eight minutes at ground level and has four right turns of 90 deg (alternately 9 deg/s for 10 s and
/// 18 deg/s for 5 s), with an outage of 10 s from the onset of each. There are six filters:
///   M_stat(AV)       white noise, N of Table 1; constant bias
///   M_dyn(AV)        white noise, N of Tables 1 and 2 by |z reading| through Table 5; constant bias
///   M_dyn(GMWM)      white noise and two Gauss-Markov processes of Table 4 by |z reading|; constant bias
///   M_stat(GMWM)     the same of experiment 0 alone
///   M_stat(AV)+RW    N of Table 1 and a random-walk bias, q = sigma2 sqrt(2 beta2) of experiment 0
///   M_stat(Neq)+RW   N_eq = sqrt(N^2 + 2 sigma1^2/beta1) of experiment 0 and the same random walk
/// The last three are controls that the paper lacks. The true errors are those of Table 4 on every axis; on the z axis
/// they follow the true rate through Table 5; each run has a constant bias. Every filter has the true accelerometer
/// model. Filters without Gauss-Markov states add the slow process to the standard deviation of their initial bias.
///
/// Variants: `paper-position-only` (no GNSS velocity), `paper-nhc` (velocity constraints at 10 Hz, 0.2 m/s),
/// `paper-s-curves` (S-curves of 36 deg/s, 5 s each way, every 20 s between the turns; Gauss-Markov noise on z alone).
#include "core/navigate/outage_scenario.hpp"

#include <string_view>
#include <vector>

namespace driftlab {

/// Names that `paper_scenario` knows.
[[nodiscard]] const std::vector<std::string>& scenario_names();

/// Error: NotFound, listing the names.
[[nodiscard]] Result<OutageScenario> paper_scenario(std::string_view name);

/// The gyroscope of one of the six filters on all axes, by the filter's name: z by Table 5, x and y at experiment 0.
/// Error: NotFound.
[[nodiscard]] Result<std::array<AxisModel, 3>> paper_gyroscope(std::string_view filter, double bias_sd_rad_s,
                                                               bool gauss_markov_on_all_axes);

/// The truth's gyroscope: Table 4 by Table 5.
[[nodiscard]] std::array<AxisModel, 3> paper_true_gyroscope(double bias_sd_rad_s, bool gauss_markov_on_all_axes);

}  // namespace driftlab
