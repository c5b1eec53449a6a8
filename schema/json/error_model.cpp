#include "schema/json/error_model.hpp"

#include "core/process/parameter_unit.hpp"
#include "core/process/registry.hpp"

namespace driftlab {
namespace {

Process process_from_json(const Json& document, Dimension channel, const std::string& pointer, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  const std::string name = reader.required_text("process");
  const Json* const params = reader.member("params");
  const ProcessKind* const kind = find_process(name);
  if (kind == nullptr || params == nullptr || !params->is_object()) {
    faults.add(pointer, ErrorCode::InvalidArgument, "A process has a known name and an object of params.");
    return {};
  }
  std::vector<double> values;
  for (const ParameterSpec& spec : kind->parameters) {
    const std::string where = pointer + "/params/" + std::string(spec.name);
    const auto found = params->find(std::string(spec.name));
    if (found == params->end()) {
      faults.add(where, ErrorCode::InvalidArgument, "The parameter " + std::string(spec.name) + " is missing.");
      return {};
    }
    if (found->is_number()) {
      values.push_back(found->get<double>());
      continue;
    }
    const bool whole = found->is_object() && found->contains("value") && (*found)["value"].is_number() &&
                       found->contains("unit") && (*found)["unit"].is_string();
    if (!whole) {
      faults.add(where, ErrorCode::InvalidArgument, "A parameter has a value and a unit.");
      return {};
    }
    const auto factor = parameter_factor((*found)["unit"].get<std::string>(), channel, spec);
    if (!factor) {
      faults.add(where + "/unit", factor.error());
      return {};
    }
    values.push_back((*found)["value"].get<double>() * *factor);
  }
  auto process = make_process(name, std::move(values));
  if (!process) {
    faults.add(pointer, process.error());
    return {};
  }
  return std::move(*process);
}

}  // namespace

Model model_from_json(const Json& processes, Dimension channel, const std::string& pointer, Faults& faults) {
  Model model;
  if (!processes.is_array() || processes.size() > kMaxModelProcesses) {
    faults.add(pointer, ErrorCode::InvalidArgument, "The processes are a list of at most 8.");
    return model;
  }
  for (std::size_t i = 0; i < processes.size(); ++i) {
    std::string where = pointer;
    where.append("/").append(std::to_string(i));
    Process process = process_from_json(processes[i], channel, where, faults);
    if (process.kind != nullptr) {
      model.push_back(std::move(process));
    }
  }
  return model;
}

Json to_json(const Model& model, Dimension channel) {
  Json list = Json::array();
  for (const Process& process : model) {
    Json params = Json::object();
    for (std::size_t i = 0; i < process.parameters.size(); ++i) {
      const ParameterSpec& spec = process.kind->parameters[i];
      const ParameterUnit unit = lab_unit(spec.channel_power == 0 ? Dimension::One : channel, spec.second_power_halves);
      params[std::string(spec.name)] =
          Json{{"value", number(process.parameters[i] * unit.per_si)}, {"unit", unit.symbol}};
    }
    list.push_back(Json{{"process", process.kind->name}, {"params", std::move(params)}});
  }
  return list;
}

}  // namespace driftlab
