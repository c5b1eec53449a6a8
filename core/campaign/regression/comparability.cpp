#include "core/campaign/regression/comparability.hpp"

#include "core/campaign/regression/event_checks.hpp"
#include "core/campaign/words.hpp"
#include "core/signal/number.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/unit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace driftlab::regression {
namespace {

constexpr double kSameRange = 1e-3;  // of a full scale: closer ones are one figure, written in two units

std::set<std::string> units_of(const std::vector<PowerUp>& sessions) {
  std::set<std::string> units;
  for (const PowerUp& session : sessions) {
    for (const ComparedRecording* recording : session.recordings) {
      for (const ComparedChannel& channel : recording->channels) {
        if (std::string name = unit_name(*recording, channel.result); !name.empty()) {
          units.insert(std::move(name));
        }
      }
    }
  }
  return units;
}

/// Sentences of sessions that were recorded under a condition of the arm's other sessions and lack an axis of theirs:
/// what is broken in one session must not be left out of the comparison in silence.
std::vector<std::string> lacking_sessions(const std::vector<PowerUp>& sessions, const std::string& arm) {
  std::map<std::string, std::set<std::string>> units;  // by condition
  for (const PowerUp& session : sessions) {
    for (const ComparedRecording* recording : session.recordings) {
      units[recording->condition].merge(units_of({PowerUp{session.name, {recording}}}));
    }
  }
  std::vector<std::string> sentences;
  for (const PowerUp& session : sessions) {
    const std::set<std::string> own = units_of({session});
    std::set<std::string> lacking;
    for (const ComparedRecording* recording : session.recordings) {
      std::set_difference(units[recording->condition].begin(), units[recording->condition].end(), own.begin(),
                          own.end(), std::inserter(lacking, lacking.end()));
    }
    for (const std::string& unit : lacking) {
      std::string sentence = "Session " + session.name + " of the ";
      sentences.push_back(sentence.append(arm).append(" lacks ").append(unit).append(", which its others have."));
    }
  }
  return sentences;
}

std::vector<double> temperatures_of(const std::vector<PowerUp>& sessions) {
  std::vector<double> all;
  for (const PowerUp& session : sessions) {
    for (const ComparedRecording* recording : session.recordings) {
      if (recording->temperature_degc) {
        all.push_back(*recording->temperature_degc);
      }
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// The different full scales [SI] that recordings state of a sensor, rising.
std::vector<double> full_scales_of(const std::vector<PowerUp>& sessions, Quantity sensor) {
  std::vector<double> all;
  for (const PowerUp& session : sessions) {
    for (const ComparedRecording* recording : session.recordings) {
      const FullScales& stated = recording->full_scale;
      if (const auto& one = sensor == Quantity::AngularRate ? stated.gyroscope : stated.accelerometer) {
        all.push_back(*one);
      }
    }
  }
  std::sort(all.begin(), all.end());
  const auto end = std::unique(all.begin(), all.end(), [](double a, double b) { return b <= (1.0 + kSameRange) * a; });
  all.erase(end, all.end());
  return all;
}

/// "250 deg/s", "2 and 4 g".
std::string full_scales_text(Quantity sensor, const std::vector<double>& full_scales) {
  const std::string symbol = sensor == Quantity::AngularRate ? "deg/s" : "g";
  const auto unit = parse_unit(symbol);
  std::vector<std::string> texts;
  for (const double full_scale : full_scales) {
    texts.push_back(short_text(unit ? unit->from_si(full_scale) : full_scale));
  }
  return joined(texts) + " " + symbol;
}

std::string full_scale_sentence(Quantity sensor, const std::vector<double>& before, const std::vector<double>& now) {
  const std::string name(sensor_of(sensor));
  const std::string why = ": noise and resolution of another range say nothing about the change.";
  if (!before.empty() && !now.empty() && before.size() == 1 && now.size() == 1) {
    return "The full scale of the " + name + " went from " + full_scales_text(sensor, before) + " to " +
           full_scales_text(sensor, now) + why;
  }
  const bool of_baseline = before.size() > 1;
  return std::string("The recordings of the ") + (of_baseline ? "baseline" : "candidate") +
         " have different full scales of the " + name + " (" + full_scales_text(sensor, of_baseline ? before : now) +
         ")" + why;
}

}  // namespace

std::vector<Incomparable> compare_arms(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                                       const EventLimits& limits) {
  std::vector<Incomparable> found;
  const std::set<std::string> before = units_of(baseline);
  const std::set<std::string> now = units_of(candidate);
  for (const std::string& unit : before) {
    if (!now.contains(unit)) {
      found.push_back({"unit", "Candidate lacks " + unit + "."});
    }
  }
  for (const std::string& unit : now) {
    if (!before.contains(unit)) {
      found.push_back({"unit", "Baseline lacks " + unit + "."});
    }
  }
  for (const auto& [sessions, arm] : {std::pair{&baseline, "baseline"}, std::pair{&candidate, "candidate"}}) {
    for (std::string& sentence : lacking_sessions(*sessions, arm)) {
      found.push_back({"unit", std::move(sentence)});
    }
  }
  const std::vector<double> cold = temperatures_of(baseline);
  const std::vector<double> warm = temperatures_of(candidate);
  if (!cold.empty() && !warm.empty()) {
    const double apart = warm[warm.size() / 2] - cold[cold.size() / 2];
    if (std::abs(apart) > limits.temperature_k) {
      found.push_back({"temperature", "The candidate was " + significant(std::abs(apart)) + " K " +
                                          (apart > 0.0 ? "warmer" : "colder") + " than the baseline; at most " +
                                          short_text(limits.temperature_k) + " K apart can be compared."});
    }
  }
  for (const Quantity sensor : changed_full_scales(baseline, candidate)) {
    found.push_back({"full_scale",
                     full_scale_sentence(sensor, full_scales_of(baseline, sensor), full_scales_of(candidate, sensor))});
  }
  return found;
}

std::set<Quantity> changed_full_scales(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate) {
  std::set<Quantity> changed;
  for (const Quantity sensor : {Quantity::AngularRate, Quantity::SpecificForce}) {
    std::vector<double> all = full_scales_of(baseline, sensor);
    const std::vector<double> now = full_scales_of(candidate, sensor);
    all.insert(all.end(), now.begin(), now.end());
    const auto [least, largest] = std::minmax_element(all.begin(), all.end());
    if (!all.empty() && *largest > (1.0 + kSameRange) * *least) {
      changed.insert(sensor);
    }
  }
  return changed;
}

}  // namespace driftlab::regression
