#include "core/investigate/report/explain.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/report/figures.hpp"
#include "core/signal/significant.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {

std::string list_of(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) {
      text.append(i + 1 == items.size() ? " and " : ", ");
    }
    text.append(items[i]);
  }
  return text;
}

std::string percent(double share) {
  const double hundred = std::round(100.0 * share);
  if (hundred < 1.0) {
    return "less than 1 %";
  }
  return std::to_string(static_cast<int>(std::min(100.0, hundred))) + " %";
}

std::string in_words(const FoundParameter& parameter) {
  const double k = parameter.unit.per_si;
  const double low = parameter.estimate.ci95.low * k;
  const double high = parameter.estimate.ci95.high * k;
  std::string text = significant(parameter.estimate.value * k, low, high);
  if (parameter.unit.symbol != "1") {
    text.append(" ").append(parameter.unit.symbol);
  }
  text.append(" (").append(significant(low, low, high)).append(" to ");
  text.append(significant(high, low, high)).append(")");
  return text;
}

std::string explain(const Finding& finding, const ChannelGroup& group) {
  const Evidence& evidence = finding.evidence;
  std::string text = "The recordings of ";
  text.append(group.column).append(" show ").append(evidence.cause->title).append(": ");
  std::vector<std::string> parts;
  for (const FoundParameter& parameter : evidence.parameters) {
    parts.push_back(spoken_name(parameter.name) + " = " + in_words(parameter));
  }
  text.append(list_of(parts)).append(", in ");
  text.append(evidence.members.size() == group.members.size()
                  ? std::string("all recordings")
                  : list_of(finding.channels.size() <= 6
                                ? texts_of(finding.channels)
                                : std::vector<std::string>{finding.channels.front().text(), "others"}));
  text.append(".");
  if (evidence.cause->as<FileFact>() != nullptr) {
    text.append(" The file itself shows it.").append(evidence.note.empty() ? "" : " ").append(evidence.note);
  } else if (finding.gain.heldout) {
    text.append(" It explains ").append(percent(finding.gain.explained));
    text.append(" of what the baseline gets wrong, on samples it was not fitted to.");
  }
  if (evidence.ambiguous && !evidence.rivals.empty()) {
    std::vector<std::string> names;
    for (const Evidence& rival : evidence.rivals) {
      names.emplace_back(rival.cause->title);
    }
    text.append(" These data cannot tell it from ").append(list_of(names)).append(".");
  }
  if (!evidence.doubt.empty()) {
    text.append(" It may be an effect that has no name here: ").append(evidence.doubt).append(".");
  }
  return text;
}

std::string next_measurement(const Finding& finding) {
  return finding.evidence.ambiguous ? std::string(finding.evidence.cause->separates) : std::string();
}

std::string allan_in_words(const ChannelFigures& figures) {
  const std::vector<AllanChange> changes = allan_changes(figures);
  LabUnit unit = level_unit(figures.unit);
  if (unit.symbol == "deg/s") {
    unit = {"deg/h", 3600.0 * unit.per_si};
  }
  std::vector<std::string> parts;
  for (const double wanted : {1.0, 10.0, 100.0, 1000.0}) {
    const auto nearest =
        std::min_element(changes.begin(), changes.end(), [&](const AllanChange& a, const AllanChange& b) {
          return std::fabs(std::log(a.tau_s / wanted)) < std::fabs(std::log(b.tau_s / wanted));
        });
    if (nearest == changes.end() || std::fabs(std::log(nearest->tau_s / wanted)) > 0.5 || !(nearest->baseline > 0.0) ||
        std::fabs(nearest->extended / nearest->baseline - 1.0) < 0.05) {
      continue;
    }
    parts.push_back("at " + significant(nearest->tau_s) + " s " + significant(nearest->measured * unit.per_si) +
                    " measured, " + significant(nearest->baseline * unit.per_si) + " in the baseline, " +
                    significant(nearest->extended * unit.per_si) + " in the extended model");
  }
  if (parts.empty()) {
    return "";
  }
  std::string text = "Allan deviation of " + figures.channel + " [" + unit.symbol + "]: ";
  for (std::size_t i = 0; i < parts.size(); ++i) {
    text.append(i > 0 ? "; " : "").append(parts[i]);
  }
  return text + ".";
}

}  // namespace driftlab::investigate
