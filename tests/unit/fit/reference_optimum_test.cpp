// The optimiser against the best objective anybody found on 19 real channels (values stored as numbers): same wavelet
// variances, same weights, same models.
#include "core/fit/gmwm.hpp"
#include "tests/reference_values.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

namespace driftlab {
namespace {

struct Problem {
  WaveletMoments moments;
  MomentWeights weights;
};

/// Wavelet variances and 1/(interval length)^2 weights as the reference objectives used them, the last scale included.
Problem problem_of(const nlohmann::json& axis, double samples) {
  auto variance = axis["wv_haar_modwt"]["variance"].get<std::vector<double>>();
  auto low = axis["wv_haar_modwt"]["ci_low"].get<std::vector<double>>();
  auto high = axis["wv_haar_modwt"]["ci_high"].get<std::vector<double>>();
  variance.push_back(axis["checks"]["last_scale_wv_numpy"]);
  low.push_back(axis["checks"]["last_scale_ci_numpy"][0]);
  high.push_back(axis["checks"]["last_scale_ci_numpy"][1]);
  Problem problem;
  const auto scales = static_cast<Eigen::Index>(variance.size());
  problem.moments.nu = Eigen::Map<const Eigen::VectorXd>(variance.data(), scales);
  problem.moments.samples = samples;
  problem.moments.dt_s = 0.01;
  Eigen::VectorXd length(scales);
  for (std::size_t j = 0; j < variance.size(); ++j) {
    problem.moments.half.push_back(std::pow(2.0, static_cast<double>(j)));
    length(static_cast<Eigen::Index>(j)) = high[j] - low[j];
  }
  problem.weights = MomentWeights::from_sd(length);
  return problem;
}

TEST(ReferenceOptimum, NoObjectiveAboveTheBestKnownAndNoLargerModelWorse) {
  int fits = 0;
  for (const char* recording : {"adis_16405_imu1", "adis_16405_imu2", "adis_16405_imu3", "cont.imu1"}) {
    const auto file = reference_values(std::string(recording) + ".smac.json");
    for (const auto& [axis_name, axis] : file["axes"].items()) {
      const Problem problem = problem_of(axis, file["n"].get<double>());
      std::map<std::string, double> found;
      for (const auto& [peer_name, name] : reference_models()) {
        if (!axis["gmwm"].contains(peer_name)) {
          continue;
        }
        const nlohmann::json& peer = axis["gmwm"][peer_name];
        if (!peer.contains("best_objective_found_here") || peer["best_objective_found_here"].is_null()) {
          continue;
        }
        const ModelStructure structure = *parse_model(name);
        const GmwmSolution solution = fit_gmwm(problem.moments, structure, problem.weights);
        const double best = peer["best_objective_found_here"].get<double>();
        EXPECT_LE(solution.objective, 1.001 * best) << recording << " " << axis_name << " " << peer_name;
        found[model_name(structure)] = solution.objective;
        ++fits;
      }
      for (const auto& [inner, inner_objective] : found) {
        for (const auto& [outer, outer_objective] : found) {
          if (is_nested(*parse_model(inner), *parse_model(outer))) {
            EXPECT_LE(outer_objective, inner_objective * (1.0 + 1e-9))
                << axis_name << ": " << outer << " over " << inner;
          }
        }
      }
    }
  }
  EXPECT_EQ(fits, 19 * 7);
}

}  // namespace
}  // namespace driftlab
