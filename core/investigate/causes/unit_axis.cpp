#include "core/investigate/causes/unit_axis.hpp"

namespace driftlab::investigate {

bool add_process(UnitAxis& axis, std::string_view process, const Evidence& found) {
  std::vector<double> values;
  for (const FoundParameter& parameter : found.parameters) {
    values.push_back(parameter.estimate.value);
  }
  auto made = make_process(process, std::move(values));
  if (!made) {
    return false;
  }
  axis.model.push_back(*std::move(made));
  return true;
}

}  // namespace driftlab::investigate
