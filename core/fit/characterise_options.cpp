/// Which options of a characterisation make sense (core/fit/characterise.hpp).
#include "core/fit/bootstrap.hpp"
#include "core/fit/characterise.hpp"
#include "core/fit/model_search.hpp"
#include "core/variance/dynamic_allan.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kMostModels = 64;

}  // namespace

Status check_options(const CharacteriseOptions& options) {
  if (options.bootstrap != 0 && (options.bootstrap < kFewestReplicates || options.bootstrap > kMostReplicates)) {
    return fail(replicates_error(options.bootstrap));
  }
  if (options.dynamic != 0 && (options.dynamic < kFewestWindows || options.dynamic > kMostWindows)) {
    return fail(ErrorCode::InvalidArgument,
                "A dynamic Allan variance takes " + std::to_string(kFewestWindows) + " to " +
                    std::to_string(kMostWindows) + " windows; 0 is none.",
                {{"parameter", "dynamic"}, {"limit", std::to_string(kMostWindows)}});
  }
  if (options.also.taus != 0 && (options.also.taus < kFewestTaus || options.also.taus > kMostTaus)) {
    return fail(ErrorCode::InvalidArgument,
                "A finer Allan curve takes " + std::to_string(kFewestTaus) + " to " + std::to_string(kMostTaus) +
                    " averaging times; 0 is none.",
                {{"parameter", "taus"}, {"limit", std::to_string(kMostTaus)}});
  }
  if (options.models.empty() || options.models.size() > kMostModels) {
    return fail(ErrorCode::InvalidArgument, "Between 1 and " + std::to_string(kMostModels) + " models can be compared.",
                {{"parameter", "models"}, {"limit", std::to_string(kMostModels)}});
  }
  if (!(options.from_tau_s >= 0.0) || !std::isfinite(options.from_tau_s)) {
    return fail(ErrorCode::InvalidArgument, "The tau from which models are fitted must be 0 s or more.",
                {{"parameter", "from_tau_s"}});
  }
  for (const std::string& name : options.models) {
    if (Result<ModelStructure> structure = parse_model(name); !structure) {
      return fail(std::move(structure.error()));
    }
  }
  return {};
}

}  // namespace driftlab
