#include "core/investigate/search/candidates.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/search/hold_out.hpp"
#include "core/investigate/search/thresholds.hpp"

#include <algorithm>

namespace driftlab::investigate {
namespace {

bool is_rival(const Cause& cause, const Cause& other) {
  const auto names = [](const Cause& a, const Cause& b) {
    return std::find(a.rivals.begin(), a.rivals.end(), b.name) != a.rivals.end();
  };
  return &cause != &other && (names(cause, other) || names(other, cause));
}

/// Rivals whose score comes within the margin, best first.
void set_rivals(Evidence& winner, const std::vector<Evidence>& candidates) {
  winner.rivals.clear();
  for (const Evidence& other : candidates) {
    if (is_rival(*winner.cause, *other.cause) && other.score > winner.score - kMargin && other.score > 0.0) {
      auto same = std::find_if(winner.rivals.begin(), winner.rivals.end(),
                               [&](const Evidence& e) { return e.cause == other.cause; });
      if (same == winner.rivals.end()) {
        winner.rivals.push_back(other);
      }
    }
  }
  std::sort(winner.rivals.begin(), winner.rivals.end(),
            [](const Evidence& a, const Evidence& b) { return a.score > b.score; });
  if (winner.rivals.size() > kMostAlternatives) {
    winner.rivals.resize(kMostAlternatives);
  }
  winner.ambiguous = !winner.rivals.empty();
}

}  // namespace

const Evidence* strongest(const std::vector<Evidence>& candidates) {
  const Evidence* best = nullptr;
  for (const Evidence& candidate : candidates) {
    if (best == nullptr || candidate.score > best->score) {
      best = &candidate;
    }
  }
  return best;
}

void keep_best(std::vector<Evidence>& examined, const std::vector<Evidence>& fresh) {
  for (const Evidence& evidence : fresh) {
    auto same =
        std::find_if(examined.begin(), examined.end(), [&](const Evidence& e) { return e.cause == evidence.cause; });
    if (same == examined.end()) {
      examined.push_back(evidence);
    } else if (evidence.score > same->score) {
      *same = evidence;
    }
  }
}

void keep_last(std::vector<Evidence>& remaining, const std::vector<Evidence>& fresh,
               const std::function<bool(const Cause&)>& looked_for) {
  std::erase_if(remaining, [&](const Evidence& old) { return looked_for(*old.cause); });
  std::vector<Evidence> latest;
  keep_best(latest, fresh);
  remaining.insert(remaining.end(), latest.begin(), latest.end());
}

std::optional<Evidence> choose(const FullRate& data, std::vector<Evidence>& candidates) {
  for (;;) {
    const Evidence* const best = strongest(candidates);
    if (best == nullptr || best->score < kThreshold || data.stopped()) {
      return std::nullopt;
    }
    Evidence winner = *best;
    if (!winner.cause->is_slow()) {
      hold_out(data, winner);
      if (winner.heldout && winner.heldout_gain < 0.0) {
        candidates[static_cast<std::size_t>(best - candidates.data())].score = 0.0;
        continue;
      }
    }
    set_rivals(winner, candidates);
    return winner;
  }
}

}  // namespace driftlab::investigate
