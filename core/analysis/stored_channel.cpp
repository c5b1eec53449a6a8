#include "core/analysis/stored_channel.hpp"

#include "core/campaign/absent_process.hpp"
#include "core/process/parameter_unit.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

/// The SI value of a parameter as it is told; nothing where it was left open or its unit is not known.
std::optional<double> si_value(const ReportedProcess& process, const ParameterSpec& spec, Dimension dimension) {
  for (const auto& [name, told] : process.parameters) {
    if (name == spec.name && told.value) {
      const auto factor = parameter_factor(told.unit, dimension, spec);
      return factor ? std::optional(*told.value * *factor) : std::nullopt;
    }
  }
  return std::nullopt;
}

std::optional<Process> process_of(const ReportedProcess& told, Dimension dimension) {
  const ProcessKind* const kind = find_process(told.process);
  if (kind == nullptr) {
    return std::nullopt;
  }
  std::vector<double> values;
  for (const ParameterSpec& spec : kind->parameters) {
    const auto value = si_value(told, spec, dimension);
    if (!value) {
      return std::nullopt;
    }
    values.push_back(*value);
  }
  auto process = make_process(told.process, std::move(values));
  return process ? std::optional(*std::move(process)) : std::nullopt;
}

}  // namespace

Verdict verdict_of(const StoredChannel& channel) {
  return verdict_of(channel.told,
                    evidence_of(channel.contamination.value_or(Contamination{}), channel.told.haar.scale.size()));
}

std::optional<GravestChannel> gravest_channel(std::span<const StoredChannel> channels) {
  std::vector<Verdict> verdicts;
  for (const StoredChannel& channel : channels) {
    verdicts.push_back(verdict_of(channel));
  }
  const auto gravest = gravest_of(verdicts);
  return gravest ? std::optional(GravestChannel{channels[*gravest].told.channel, std::move(verdicts[*gravest])})
                 : std::nullopt;
}

std::vector<ReportedProcess> present_processes(const ReportedFit& fit) {
  std::vector<ReportedProcess> present;
  std::remove_copy_if(fit.processes.begin(), fit.processes.end(), std::back_inserter(present), none_found);
  return present;
}

std::optional<Model> model_of(const ReportedFit& fit, Dimension dimension) {
  Model model;
  for (const ReportedProcess& told : present_processes(fit)) {
    auto process = process_of(told, dimension);
    if (!process) {
      return std::nullopt;
    }
    model.push_back(*std::move(process));
  }
  return model.empty() ? std::nullopt : std::optional(std::move(model));
}

std::optional<ImpliedBeside> implied_by(const ReportedFit& fit, const StoredChannel& channel) {
  const auto unit = parse_unit(channel.told.unit);
  if (!unit || channel.allan.tau_s.empty()) {
    return std::nullopt;
  }
  const auto model = model_of(fit, unit->dimension);
  return model ? std::optional(implied_beside(*model, *unit, channel.told.dt_s, channel.allan)) : std::nullopt;
}

}  // namespace driftlab
