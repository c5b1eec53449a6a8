#pragma once
/// What people are told about a curve in which a process is present: `before`, then a figure where the words have one,
/// then `after`. "white noise averaged over 3.2 samples" is {"white noise averaged over ", 3.2, " samples"}; how many
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
