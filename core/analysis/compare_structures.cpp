#include "core/analysis/compare_structures.hpp"

#include "core/campaign/told_structure.hpp"

namespace driftlab {

PooledStructure compare_structures(const std::vector<FittedRow>& rows) {
  std::vector<const std::vector<ReportedFit>*> fits;
  for (const FittedRow& row : rows) {
    fits.push_back(&row.fits);
  }
  const std::vector<std::string> models = shared_models(fits);
  std::vector<std::vector<StructureScore>> scores;
  std::vector<std::string> labels;
  for (const FittedRow& row : rows) {
    std::vector<StructureScore> of_row;
    for (const std::string& model : models) {
      of_row.push_back(score_of(*find_fit(row.fits, model)));
    }
    scores.push_back(std::move(of_row));
    labels.push_back(row.label);
  }
  if (models.empty()) {
    PooledStructure none;
    none.verdict = name_of(StructureVerdict::Undecided);
    none.statement = "No structure was fitted to every recording.";
    return none;
  }
  return told_structure(choose_structure(models, scores, StructureRows::Recordings), models, labels);
}

}  // namespace driftlab
