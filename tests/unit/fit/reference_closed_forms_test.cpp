// Theoretical wavelet variances against tables made in 60-digit arithmetic (values stored as numbers).
#include "core/process/model.hpp"
#include "tests/reference_values.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

Process process_of(const std::string& name, const nlohmann::json& params) {
  const auto root = [&](const char* key) { return std::sqrt(params.at(key).get<double>()); };
  if (name == "WN") {
    return *make_process("white_noise", {root("sigma2")});
  }
  if (name == "QN") {
    return *make_process("quantization_noise", {root("Q2")});
  }
  if (name == "RW") {
    return *make_process("random_walk", {root("gamma2")});
  }
  if (name == "DR") {
    return *make_process("linear_drift", {params.at("omega").get<double>()});
  }
  // The table is in phi; beta = -ln phi exactly as a double holds phi, and sigma^2 = s2/(1 - phi^2).
  const double phi = params.at("phi").get<double>();
  const double gap = 1.0 - phi;
  return *make_process("gauss_markov", {root("sigma2") / std::sqrt(gap * (1.0 + phi)), -std::log1p(-gap)});
}

TEST(ReferenceClosedForms, TenDigitsAtEveryScaleOfEveryTable) {
  const auto file = reference_values("theoretical_haar_wv.json");
  int compared = 0;
  for (const auto& table : file["tables"]) {
    const std::string name = table["process"];
    const bool known = name == "WN" || name == "QN" || name == "RW" || name == "DR" || name == "AR1";
    if (!known || (name == "AR1" && table["params"]["phi"].get<double>() <= 0.0)) {
      continue;  // moving averages, second order, alternating: no process of the registry
    }
    const Process process = process_of(name, table["params"]);
    for (std::size_t j = 0; j < table["wv_exact"].size(); ++j) {
      const double expected = table["wv_exact"][j];
      EXPECT_NEAR(process.haar_variance(std::pow(2.0, static_cast<double>(j)), 1.0), expected, 1e-10 * expected)
          << name << " " << table["params"].dump() << " scale " << j;
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace driftlab
