#include "core/signal/full_scale.hpp"

#include "core/signal/channel_survey.hpp"

namespace driftlab {

Rails find_rails(const std::string& column, std::span<const double> values) {
  const ChannelSurvey survey = survey_channel(column, values);
  if (survey.quality.saturated == 0) {
    return {};
  }
  const bool varied = !survey.quality.distinct || *survey.quality.distinct >= kVaried;
  Extreme high;
  Extreme low;
  auto unsound = survey.unsound.begin();
  bool first = true;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (unsound != survey.unsound.end() && *unsound == i) {
      ++unsound;
      continue;
    }
    high.take(values[i], first);
    low.take(-values[i], first);
    first = false;
  }
  Rails rails;
  if (high.saturated(varied) > 0) {
    rails.high = high.value;
  }
  if (low.saturated(varied) > 0) {
    rails.low = -low.value;
  }
  return rails;
}

}  // namespace driftlab
