#include "tests/hidden/stored_gain.hpp"

#include "core/investigate/investigate.hpp"
#include "schema/json/simulation_model.hpp"
#include "tests/hidden/fresh_likelihood.hpp"

#include <cmath>
#include <stdexcept>

namespace driftlab::hidden {
namespace {

using namespace investigate;

/// The truth as a model: base and effect.
Baseline true_model(const SimulatedStudy& data, const Hidden& effect) {
  Baseline model;
  model.automatic = false;
  model.processes.push_back(*make_process("white_noise", {data.base.n}));
  for (const SlowComponent& component : data.base.slow) {
    model.processes.push_back(component.process);
  }
  GivenEffect given{effect.cause, {}, {}, effect.values};
  const Cause& cause = *find_cause(effect.cause);
  for (const ChannelGroup& group : group_channels(data.study)) {
    if (cause.showing.axis.empty() || cause.showing.axis == group.role.axis) {
      given.channels.push_back(group.column);
    }
  }
  for (const std::size_t r : effect.recordings) {
    given.recordings.push_back(data.study.recordings[r].id);
  }
  model.effects.push_back(std::move(given));
  return model;
}

/// As it is written down and read again.
Baseline read_back(const Json& document) {
  Faults faults;
  Baseline model = simulation_model_from_json(document, "", faults);
  if (!faults.none()) {
    throw std::runtime_error("the stored model cannot be read: " + faults.error().message);
  }
  return model;
}

}  // namespace

StoredGain stored_gain(const std::string& cause, double z, std::uint64_t seed, bool given) {
  Case hidden = make_case(cause, z, seed);
  hidden.world.given = given;
  const SimulatedStudy seen = simulate_study(hidden.world, {hidden.effect});
  const auto report = investigate::investigate(seen.study, {.predict_outages = false});
  if (!report) {
    throw std::runtime_error(report.error().message);
  }
  StoredGain gain;
  for (const Finding& finding : report->findings) {
    gain.named = gain.named || finding.evidence.cause->name == cause;
    gain.claimed += finding.evidence.cause->as<FileFact>() == nullptr ? finding.evidence.heldout_gain : 0.0;
    gain.said.append(gain.said.empty() ? "" : ", ").append(finding.evidence.cause->name);
  }
  hidden.world.replicate = 1;
  const SimulatedStudy fresh = simulate_study(hidden.world, {hidden.effect});
  const double before = log_likelihood(read_back(baseline_json(*report)), fresh, {hidden.effect});
  gain.stored = log_likelihood(read_back(extended_json(*report)), fresh, {hidden.effect}) - before;
  gain.attainable = log_likelihood(true_model(fresh, hidden.effect), fresh, {hidden.effect}) - before;
  return gain;
}

bool holds_its_promise(const StoredGain& gain) {
  const double distance = std::fabs(gain.stored - gain.attainable);
  return distance <= std::max(12.0, 0.2 * gain.attainable);
}

}  // namespace driftlab::hidden
