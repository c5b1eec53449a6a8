#pragma once
/// The complete search in one channel group: facts of the file, forward selection, effects at full rate.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/search/channel_model.hpp"
#include "core/signal/progress.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab::investigate {

struct GroupOutcome {
  std::vector<Evidence> found;      ///< accepted, each with its rivals
  std::vector<Evidence> examined;   ///< the best of every cause that was examined, at first sight
  std::vector<Evidence> remaining;  ///< of every cause that was looked for again, as the last look saw it
  ChannelModel model;
  FullRate before;  ///< under the base alone, no effect taken out
  FullRate after;   ///< residuals and innovations with everything found taken out
  std::vector<std::string> examined_reasons;
  bool usable = false;
  std::string why_not;  ///< where it is not usable
  std::string needs;    ///< what would make it usable
};

/// `group` is number `index` of the study. Once `stop` is requested it ends soon, with an outcome of no meaning.
[[nodiscard]] GroupOutcome search_group(const Study& study, const ChannelGroup& group, std::size_t index,
                                        const RunControl& control = {});

}  // namespace driftlab::investigate
