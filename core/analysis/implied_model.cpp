#include "core/analysis/implied_model.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/family.hpp"
#include "core/investigate/search/given_model.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace driftlab {
namespace {

using investigate::Baseline;
using investigate::Cause;
using investigate::ChannelGroup;
using investigate::GivenEffect;

bool holds(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// Puts the effect into the processes; false where it is none.
bool add_effect(const GivenEffect& effect, Model& processes) {
  const Cause* const cause = investigate::find_cause(effect.cause);
  if (cause == nullptr || effect.values.empty() || !effect.recordings.empty()) {
    return false;
  }
  if (const auto* const slow = cause->as<investigate::SlowNoise>()) {
    processes.push_back({slow->kind, effect.values});
    return true;
  }
  if (const auto* const level = cause->as<investigate::NoiseLevel>(); level != nullptr && level->replaces_white) {
    std::erase_if(processes, [](const Process& one) { return one.kind->white_square != nullptr; });
    processes.push_back({find_process("white_noise"), {effect.values.front()}});
    return true;
  }
  if (cause->as<investigate::DifferencedNoise>() != nullptr) {
    processes.push_back({find_process("quantization_noise"), {effect.values.front()}});
    return true;
  }
  return false;
}

}  // namespace

Result<ImpliedModel> implied_by(const Baseline& model, const StoredChannel& channel) {
  const std::string& column = channel.told.channel;
  ChannelGroup group;
  group.column = column;
  group.role.quantity = parse_quantity(channel.told.quantity).value_or(Quantity::Unspecified);
  const auto own = model.quantity_by_channel.find(column);
  if (!investigate::applies(model, group) ||
      (own != model.quantity_by_channel.end() && own->second != group.role.quantity)) {
    return fail(ErrorCode::NotFound, "The model says nothing of the channel '" + column + "'.",
                {{"parameter", "channel"}, {"value", column}});
  }
  const auto unit = parse_unit(channel.told.unit);
  if (!unit || channel.allan.tau_s.empty()) {
    return fail(ErrorCode::NotFound, "The result holds no Allan deviation of the channel '" + column + "'.",
                {{"parameter", "channel"}, {"value", column}});
  }
  ImpliedModel implied;
  implied.processes = investigate::processes_of(model, group);
  if (const auto drift = model.drift.find(column); drift != model.drift.end() && drift->second != 0.0) {
    implied.processes.push_back({find_process("linear_drift"), {drift->second}});
  }
  for (const GivenEffect& effect : model.effects) {
    const bool here = effect.channels.empty() || holds(effect.channels, column);
    if (here && !add_effect(effect, implied.processes) && !holds(implied.left_out, effect.cause)) {
      implied.left_out.push_back(effect.cause);
    }
  }
  const bool nameless = std::any_of(model.unnamed.begin(), model.unnamed.end(),
                                    [&](const auto& effect) { return effect.column == column; });
  if (nameless) {
    implied.left_out.emplace_back("unnamed");
  }
  implied.beside = implied_beside(implied.processes, *unit, channel.told.dt_s, channel.allan);
  return implied;
}

}  // namespace driftlab
