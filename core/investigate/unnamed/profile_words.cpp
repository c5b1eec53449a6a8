#include "core/investigate/unnamed/profile_words.hpp"

#include "core/signal/significant.hpp"

#include <utility>

namespace driftlab::investigate {

std::string sentence_of(const UnnamedEffect& effect, const std::vector<double>& se, const LabUnit& unit) {
  constexpr double kSure = 3.0;
  constexpr double kKnown = 0.001;  // a period, and better: what is shown of it
  const bool mean = effect.kind == UnnamedKind::Mean;
  const ProfileUnit along = unit_of(effect.against);
  std::vector<std::string> ends;
  for (const double sign : {1.0, -1.0}) {
    double surest = kSure;
    std::string end;
    for (std::size_t k = 0; k < effect.value.size(); ++k) {
      const double z = sign * (effect.value[k] - (mean ? 0.0 : 1.0)) / se[k];
      if (z > surest) {
        surest = z;
        end = mean ? significant(effect.value[k] * unit.per_si) + " " + unit.symbol : significant(effect.value[k]);
        end += (mean ? " at " : " times at ") + significant(along.to_lab(effect.edge[k])) + " to " +
               significant(along.to_lab(effect.edge[k + 1])) + " " + along.symbol;
      }
    }
    if (!end.empty()) {
      ends.push_back(std::move(end));
    }
  }
  const std::string of = "of " + effect.column + " " +
                         (effect.recordings.empty()       ? "in all recordings"
                          : effect.recordings.size() == 1 ? "in " + effect.recordings.front()
                                                          : "in the recordings that tell it");
  const std::string where = ends.empty()       ? "a little everywhere"
                            : ends.size() == 1 ? ends[0]
                                               : ends[0] + " and " + ends[1];
  std::string along_what(words_of(effect.against));
  if (effect.against == Against::Phase) {
    along_what += " of " +
                  significant(effect.period_s, effect.period_s * (1.0 - kKnown), effect.period_s * (1.0 + kKnown)) +
                  " s";
  }
  switch (effect.kind) {
    case UnnamedKind::Spectrum:
      return "The noise " + of + " has another density than the model's: " + where;
    case UnnamedKind::Variance:
      return "The power of the noise " + of + " goes with " + along_what + ", over that of the model: " + where;
    case UnnamedKind::Mean:
      break;
  }
  return "The mean " + of + " goes with " + along_what + ": " + where;
}

}  // namespace driftlab::investigate
