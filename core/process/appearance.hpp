#pragma once
/// What the presence of a process in a curve is called, as a person reads it: `before`, a figure where the name has
/// one, `after`. "white noise averaged over 3.2 samples" is {"white noise averaged over ", 3.2, " samples"}; how many
/// digits the figure gets is for the writer of the sentence.
#include <optional>
#include <string_view>

namespace driftlab {

struct Appearance {
  std::string_view before;
  std::optional<double> figure;
  std::string_view after;
};

}  // namespace driftlab
