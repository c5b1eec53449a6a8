#include "clients/cli/study_request.hpp"

#include "schema/json/simulation_model.hpp"

#include <fstream>

namespace driftlab::cli {

Result<InvestigationRequest> investigation_request(const Inputs& inputs) {
  InvestigationRequest request;
  request.study = inputs.study.is_string() ? inputs.study.get<std::string>() : inputs.device;
  request.device = inputs.device;
  if (!inputs.baseline.is_null()) {
    Faults faults;
    request.baseline = baseline_from_json(inputs.baseline, "/baseline", faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
  }
  return request;
}

bool write_file(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  return static_cast<bool>(out);
}

}  // namespace driftlab::cli
