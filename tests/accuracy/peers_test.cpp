// The fits of driftlab and of a peer to the same recordings under the same models, judged by the exact likelihood of
// every sample: neither of the two maximises it.
#include "core/fit/characterise.hpp"
#include "core/process/registry.hpp"
#include "tests/accuracy/section.hpp"
#include "tests/likelihood/kalman_likelihood.hpp"
#include "tests/reference_values.hpp"
#include "tests/unit/fit/shared_data.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace driftlab::accuracy {
namespace {

constexpr double kDt = 0.01;
constexpr double kMostBelow = 10.0;  ///< nats, where the J test accepts

nlohmann::json list_of(const nlohmann::json& one) { return one.is_array() ? one : nlohmann::json::array({one}); }

/// The peer's estimate, which is in samples, in seconds.
Model model_of_peer(const nlohmann::json& fit) {
  const nlohmann::json names = list_of(fit["parameters"]);
  const nlohmann::json values = list_of(fit["estimate"]);
  Model model;
  const auto add = [&](const char* symbol, std::vector<double> parameters) {
    model.push_back(*make_process(find_process(symbol)->name, std::move(parameters)));
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double value = values[i].get<double>();
    const std::string name = names[i].get<std::string>();
    if (name == "WN") {
      add("WN", {std::sqrt(value * kDt)});
    } else if (name == "AR1") {
      const double innovation = values[++i].get<double>();
      add("GM", {std::sqrt(innovation / (1.0 - value * value)), -std::log(value) / kDt});
    } else if (name == "RW") {
      add("RW", {std::sqrt(value / kDt)});
    } else if (name == "QN") {
      add("QN", {std::sqrt(value) * kDt});
    } else {
      add("DR", {std::fabs(value) / kDt});
    }
  }
  return model;
}

/// The distance that the peer minimises: of the wavelet variances, in lengths of their intervals.
double objective_of(const Model& model, const nlohmann::json& axis) {
  const nlohmann::json& curve = axis["wv_haar_modwt"];
  double sum = 0.0;
  for (std::size_t j = 0; j < curve["variance"].size(); ++j) {
    const double length = curve["ci_high"][j].get<double>() - curve["ci_low"][j].get<double>();
    const double off =
        curve["variance"][j].get<double>() - haar_variance(model, std::pow(2.0, static_cast<double>(j)), kDt);
    sum += off * off / (length * length);
  }
  return sum;
}

/// Nothing where a level is neither estimated nor gone: the record does not tell the process from another.
std::optional<Model> model_of_fit(const ModelFit& fit) {
  Model model;
  for (const FittedProcess& process : fit.processes) {
    std::vector<double> values;
    for (const FittedParameter& parameter : process.parameters) {
      if (parameter.estimate) {
        values.push_back(parameter.estimate->value);
      }
    }
    if (values.size() == process.parameters.size()) {
      model.push_back(*make_process(process.kind->name, values));
    } else if (fit.status != "collapsed") {
      return std::nullopt;
    }
  }
  return model;
}

TEST(Peers, TheLikelihoodOfTheSameModelsOnTheSameRecordings) {
  const auto shared = shared_data::folder();
  if (!shared) {
    GTEST_SKIP() << "SKIPPED: no recordings; set DRIFTLAB_SHARED to the directory that holds data/";
  }
  Section section("peers");
  section.print("## Fits of a peer and of driftlab by the likelihood of every sample\n\n");
  section.print(
      "Recorded axes of `../shared/data` (10^6 samples of three ADIS16405, 5 * 10^5 of an MTi-G). The peer: simts "
      "0.2.4, whose estimates lie in "
      "tests/data/reference. Each cell is the log likelihood [nats] of driftlab's fit less that of the peer's under "
      "the same model, by the Kalman "
      "filter (tests/likelihood); neither estimator maximises it. Bold: the J test accepts the model. Elsewhere no "
      "model of the row is true: a "
      "fit that forgives the first scales, which hold most of the likelihood, may lose there what it wins at the long "
      "ones.\n\n");
  section.print("| axis ");
  for (const auto& [theirs, ours] : reference_models()) {
    section.print("| %s ", ours.c_str());
  }
  section.print("|\n|---|---|---|---|---|---|---|---|\n");
  int accepted = 0;
  int ahead = 0;
  int compared = 0;
  for (const char* const recording : {"adis_16405_imu1", "adis_16405_imu2", "adis_16405_imu3", "cont.imu1"}) {
    const auto file = reference_values(std::string(recording) + ".smac.json");
    const std::size_t axes = file["axes"].size();
    const auto columns = shared_data::read_npy_xz(*shared / "data" / (std::string(recording) + ".npy.xz"), axes);
    for (std::size_t a = 0; a < axes; ++a) {
      const std::string& name = shared_data::adis_axes()[a];
      const nlohmann::json& peer = file["axes"][name]["gmwm"];
      CharacteriseOptions options;
      options.models.clear();
      for (const auto& [theirs, ours] : reference_models()) {
        options.models.push_back(ours);
      }
      const auto found = characterise_channel({.values = columns[a], .dt_s = kDt}, options);
      ASSERT_TRUE(found) << found.error().message;
      section.print("| %s %s ", recording, name.c_str());
      for (const auto& [theirs, ours] : reference_models()) {
        const auto fit = std::find_if(found->fits.begin(), found->fits.end(),
                                      [&](const ModelFit& one) { return one.model == ours; });
        if (fit == found->fits.end() || !peer.contains(theirs) || peer[theirs]["estimate"].is_null()) {
          section.print("| ");
          continue;
        }
        const Model of_peer = model_of_peer(peer[theirs]);
        // The conversion is right where the peer's own objective comes out of it.
        EXPECT_NEAR(objective_of(of_peer, file["axes"][name]) / peer[theirs]["objective"].get<double>(), 1.0, 0.03)
            << recording << " " << name << " " << theirs;
        const std::optional<Model> of_fit = model_of_fit(*fit);
        if (!of_fit) {
          section.print("| not identified ");
          continue;
        }
        const auto mine = kalman_likelihood(columns[a], *of_fit, kDt);
        const auto other = kalman_likelihood(columns[a], of_peer, kDt);
        if (!mine || !other) {
          section.print("| %s ", mine ? "the peer's has none" : "ours has none");
          continue;
        }
        const double gain = mine->log_likelihood - other->log_likelihood;
        const bool stands = fit->j_test && stands_at(fit->j_test->p);
        section.print(stands ? "| **%+.1f** " : "| %+.1f ", gain);
        ++compared;
        ahead += gain > -kMostBelow ? 1 : 0;
        accepted += stands ? 1 : 0;
        if (stands) {
          EXPECT_GE(gain, -kMostBelow) << recording << " " << name << " " << ours;
        }
      }
      section.print("|\n");
    }
  }
  section.print("\n%d of %d fits are accepted by the J test; %d of %d are not more than 10 nats below the peer's.\n\n",
                accepted, compared, ahead, compared);
  EXPECT_GE(accepted, 1) << "nothing was held to the peer";
  section.print("Made by `accuracy_peers`.\n");
}

}  // namespace
}  // namespace driftlab::accuracy
