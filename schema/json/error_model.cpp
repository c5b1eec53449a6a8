#include "schema/json/error_model.hpp"

#include "core/process/parameter_unit.hpp"
#include "core/process/registry.hpp"

namespace driftlab {
namespace {

/// The dimension of a level's channel by its unit: an angle or a length, else none.
Dimension channel_of(const ParameterUnitValue& unit) {
  return unit.angle == 2 ? Dimension::AngularRate : unit.length == 2 ? Dimension::SpecificForce : Dimension::One;
}

/// The SI value of one parameter. An interval beside it, as a stored estimate has one, is let be.
std::optional<double> parameter_from_json(const Json& document, const ParameterSpec& spec,
                                          std::optional<Dimension>& channel, const std::string& pointer,
                                          Faults& faults) {
  if (document.is_number() && channel) {
    return document.get<double>();
  }
  if (!document.is_object()) {
    faults.add(pointer, ErrorCode::InvalidArgument, "A parameter has a value and a unit.");
    return std::nullopt;
  }
  ObjectReader reader(document, pointer, faults);
  const auto value = reader.real("value");
  const auto symbol = reader.text("unit");
  (void)reader.member("ci95");
  reader.reject_unknown();
  if (!value || !symbol) {
    faults.add(pointer, ErrorCode::InvalidArgument, "A parameter has a value and a unit.");
    return std::nullopt;
  }
  const auto unit = parse_parameter_unit(*symbol);
  const Dimension said = unit ? channel_of(*unit) : Dimension::One;
  const auto factor = parameter_factor(*symbol, channel.value_or(said), spec);
  if (!factor) {
    faults.add(pointer + "/unit", factor.error());
    return std::nullopt;
  }
  if (spec.channel_power == 1 && !channel) {
    channel = said;
  }
  return *value * *factor;
}

std::optional<Process> process_from_json(const Json& document, std::optional<Dimension>& channel,
                                         const std::string& pointer, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  const std::string name = reader.required_text("process");
  const Json* const params = reader.member("params");
  (void)reader.member("reasons");  // of a stored fit
  reader.reject_unknown();
  const ProcessKind* const kind = find_process(name);
  if (kind == nullptr) {
    faults.add(pointer + "/process", ErrorCode::InvalidArgument, "There is no process called '" + name + "'.");
    return std::nullopt;
  }
  if (params == nullptr || !params->is_object()) {
    faults.add(pointer + "/params", ErrorCode::InvalidArgument, "A process has an object of params.");
    return std::nullopt;
  }
  ObjectReader named(*params, pointer + "/params", faults);
  std::vector<double> values;
  for (const ParameterSpec& spec : kind->parameters) {
    const std::string where = named.pointer(spec.name);
    const Json* const given = named.member(spec.name);
    if (given == nullptr) {
      faults.add(where, ErrorCode::InvalidArgument,
                 "The parameter " + std::string(spec.name) + " of " + name + " is missing.");
    } else if (const auto value = parameter_from_json(*given, spec, channel, where, faults)) {
      values.push_back(*value);
    }
  }
  named.reject_unknown();
  if (values.size() < kind->parameters.size()) {
    return std::nullopt;
  }
  auto process = make_process(name, std::move(values));
  if (!process) {
    faults.add(pointer, process.error());
    return std::nullopt;
  }
  return *std::move(process);
}

}  // namespace

Model model_from_json(const Json& processes, std::optional<Dimension>& channel, const std::string& pointer,
                      Faults& faults) {
  Model model;
  if (!processes.is_array()) {
    faults.add(pointer, ErrorCode::InvalidArgument, "The processes are a list.");
    return model;
  }
  for (std::size_t i = 0; i < processes.size(); ++i) {
    std::string where = pointer;
    where.append("/").append(std::to_string(i));
    if (auto process = process_from_json(processes[i], channel, where, faults)) {
      model.push_back(*std::move(process));
    }
  }
  return model;
}

Model model_from_json(const Json& processes, Dimension channel, const std::string& pointer, Faults& faults) {
  if (processes.is_array() && processes.size() > kMaxModelProcesses) {
    faults.add(pointer, ErrorCode::InvalidArgument, "The processes are a list of at most 8.");
    return {};
  }
  std::optional known(channel);
  return model_from_json(processes, known, pointer, faults);
}

namespace {

/// `written(process, k)`: parameter k of a process as the document has it.
template <class Written>
Json processes_json(const Model& model, const Written& written) {
  Json list = Json::array();
  for (const Process& process : model) {
    Json params = Json::object();
    for (std::size_t k = 0; k < process.parameters.size(); ++k) {
      params[std::string(process.kind->parameters[k].name)] = written(process, k);
    }
    list.push_back(Json{{"process", process.kind->name}, {"params", std::move(params)}});
  }
  return list;
}

}  // namespace

Json to_json(const Model& model, Dimension channel) {
  return processes_json(model, [&](const Process& process, std::size_t k) {
    const ParameterSpec& spec = process.kind->parameters[k];
    const ParameterUnit unit = lab_unit(spec.channel_power == 0 ? Dimension::One : channel, spec.second_power_halves);
    // By the very factor that it is read with.
    const auto factor = parameter_factor(unit.symbol, channel, spec);
    return Json{{"value", number_in(process.parameters[k], factor ? *factor : 1.0 / unit.per_si)},
                {"unit", unit.symbol}};
  });
}

Json to_si_json(const Model& model) {
  return processes_json(model, [](const Process& process, std::size_t k) { return process.parameters[k]; });
}

}  // namespace driftlab
