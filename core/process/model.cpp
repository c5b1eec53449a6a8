#include "core/process/model.hpp"

#include "core/process/registry.hpp"
#include "core/signal/number.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

std::string known_symbols() {
  std::string text;
  for (const ProcessKind& kind : process_registry()) {
    text += (text.empty() ? "" : ", ") + std::string(kind.symbol);
  }
  return text;
}

tl::unexpected<Error> bad_model(std::string_view name, const std::string& why) {
  return fail(ErrorCode::InvalidArgument, "The model '" + std::string(name) + "' " + why + ".",
              {{"parameter", "models"}, {"value", std::string(name)}});
}

}  // namespace

std::size_t ModelStructure::parameter_count() const {
  std::size_t count = 0;
  for (const ProcessKind* kind : kinds) {
    count += kind->parameters.size();
  }
  return count;
}

std::size_t ModelStructure::shape_count() const { return parameter_count() - kinds.size(); }

Result<ModelStructure> parse_model(std::string_view name) {
  ModelStructure structure;
  std::string_view rest = name;
  for (;;) {
    const std::size_t plus = rest.find('+');
    std::string_view term = rest.substr(0, plus);
    std::size_t count = 1;
    if (!term.empty() && term.front() >= '1' && term.front() <= '9') {
      count = static_cast<std::size_t>(term.front() - '0');
      term.remove_prefix(1);
    }
    const ProcessKind* kind = find_process(term);
    if (kind == nullptr || kind->symbol != term) {
      return bad_model(name,
                       "has the term '" + std::string(term) + "', which is no process; known are " + known_symbols());
    }
    structure.kinds.insert(structure.kinds.end(), count, kind);
    if (!kind->repeats && std::count(structure.kinds.begin(), structure.kinds.end(), kind) > 1) {
      return bad_model(name,
                       "holds " + std::string(kind->symbol) + " more than once, which one process already covers");
    }
    if (structure.kinds.size() > kMaxModelProcesses || structure.shape_count() > kMaxModelShapes) {
      return bad_model(name, "is too large: at most " + std::to_string(kMaxModelProcesses) + " processes, and " +
                                 std::to_string(kMaxModelShapes) +
                                 " parameters that are correlation times, frequencies and other shapes");
    }
    if (plus == std::string_view::npos) {
      break;
    }
    rest.remove_prefix(plus + 1);
  }
  std::sort(structure.kinds.begin(), structure.kinds.end(),
            [](const ProcessKind* a, const ProcessKind* b) { return registry_index(a) < registry_index(b); });
  return structure;
}

std::string model_name(const ModelStructure& structure) {
  std::string name;
  for (std::size_t i = 0; i < structure.kinds.size();) {
    std::size_t next = i;
    while (next < structure.kinds.size() && structure.kinds[next] == structure.kinds[i]) {
      ++next;
    }
    name += name.empty() ? "" : "+";
    if (next - i > 1) {
      name += std::to_string(next - i);
    }
    name += structure.kinds[i]->symbol;
    i = next;
  }
  return name;
}

bool is_nested(const ModelStructure& inner, const ModelStructure& outer) {
  return std::includes(
      outer.kinds.begin(), outer.kinds.end(), inner.kinds.begin(), inner.kinds.end(),
      [](const ProcessKind* a, const ProcessKind* b) { return registry_index(a) < registry_index(b); });
}

double haar_variance(const Model& model, double half, double dt_s) {
  double sum = 0.0;
  for (const Process& process : model) {
    sum += process.haar_variance(half, dt_s);
  }
  return sum;
}

std::vector<double> simulate(const Model& model, Random& random, double dt_s, std::size_t samples) {
  std::vector<double> path(samples, 0.0);
  for (const Process& process : model) {
    process.add_path(random, dt_s, path);
  }
  return path;
}

Result<Process> make_process(std::string_view name, std::vector<double> parameters) {
  const ProcessKind* kind = find_process(name);
  if (kind == nullptr) {
    return fail(ErrorCode::InvalidArgument, "There is no process called '" + std::string(name) + "'.",
                {{"parameter", "process"}, {"value", std::string(name)}});
  }
  if (parameters.size() != kind->parameters.size()) {
    return fail(ErrorCode::InvalidArgument,
                "The process " + std::string(kind->name) + " takes " + std::to_string(kind->parameters.size()) +
                    " parameters, not " + std::to_string(parameters.size()) + ".",
                {{"parameter", "params"}});
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterSpec& spec = kind->parameters[i];
    if (!std::isfinite(parameters[i]) || parameters[i] < spec.lower || parameters[i] > spec.upper) {
      return fail(ErrorCode::InvalidArgument,
                  "The parameter " + std::string(spec.name) + " of " + std::string(kind->name) + " cannot be " +
                      to_text(parameters[i]) + ".",
                  {{"parameter", std::string(spec.name)}, {"value", to_text(parameters[i])}});
    }
  }
  return Process{kind, std::move(parameters)};
}

}  // namespace driftlab
