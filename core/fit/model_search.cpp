#include "core/fit/model_search.hpp"

#include "core/process/registry.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace driftlab {
namespace {

constexpr int kMostSteps = 12;

std::size_t best_of(const std::vector<Candidate>& candidates, double samples) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    if (candidates[i].criterion(samples) < candidates[best].criterion(samples)) {
      best = i;
    }
  }
  return best;
}

/// `from` with one process more, for each kind that octaves can tell but `barred`.
void append_larger(const ModelStructure& from, const ProcessKind* barred, std::size_t most_parameters,
                   std::vector<ModelStructure>& all) {
  for (const ProcessKind& kind : process_registry()) {
    const bool there = std::find(from.kinds.begin(), from.kinds.end(), &kind) != from.kinds.end();
    if (!kind.in_octave_search || &kind == barred || (there && !kind.repeats) ||
        from.kinds.size() == kMaxModelProcesses) {
      continue;
    }
    ModelStructure larger = from;
    const auto place = std::upper_bound(
        larger.kinds.begin(), larger.kinds.end(), &kind,
        [](const ProcessKind* a, const ProcessKind* b) { return registry_index(a) < registry_index(b); });
    larger.kinds.insert(place, &kind);
    if (larger.shape_count() <= kMaxModelShapes && larger.parameter_count() <= most_parameters) {
      all.push_back(std::move(larger));
    }
  }
}

}  // namespace

std::vector<ModelStructure> neighbouring_structures(const ModelStructure& from, std::size_t most_parameters) {
  std::vector<ModelStructure> all;
  append_larger(from, nullptr, most_parameters, all);
  for (std::size_t k = 0; k < from.kinds.size(); ++k) {
    if (k > 0 && from.kinds[k] == from.kinds[k - 1]) {
      continue;  // the same model as without the one before
    }
    ModelStructure smaller = from;
    smaller.kinds.erase(smaller.kinds.begin() + static_cast<std::ptrdiff_t>(k));
    append_larger(smaller, from.kinds[k], most_parameters, all);
    if (!smaller.kinds.empty()) {
      all.push_back(std::move(smaller));
    }
  }
  return all;
}

Status search_models(const WaveletMoments& moments, const Eigen::VectorXd& sd, const CovarianceLaw& covariance_of,
                     CandidateSet& set, const RunControl& control) {
  measure_by_own(moments, set, covariance_of);
  std::vector<Candidate>& known = set.candidates;
  const auto usable = static_cast<std::size_t>((moments.nu.array() > 0.0).count());
  std::size_t best = best_of(known, moments.samples);
  for (int step = 0; step < kMostSteps; ++step) {
    for (const ModelStructure& structure : neighbouring_structures(known[best].structure, usable)) {
      if (control.stop.stop_requested()) {
        return fail(ErrorCode::Cancelled, "The search for a model was cancelled.");
      }
      const bool fitted =
          std::any_of(known.begin(), known.end(), [&](const Candidate& other) { return other.structure == structure; });
      if (fitted) {
        continue;
      }
      control.report("fit " + model_name(structure), static_cast<double>(step) / kMostSteps);
      Candidate candidate = fit_candidate(moments, structure, sd, set.curve, known);
      if (candidate.log_fit) {
        candidate.own_distance = distance_under_own(moments, candidate, covariance_of);
        known.push_back(std::move(candidate));
      }
    }
    const std::size_t next = best_of(known, moments.samples);
    if (next == best) {
      break;
    }
    best = next;
  }
  return {};
}

}  // namespace driftlab
