#include "core/campaign/regression/bias_check.hpp"

#include "core/campaign/regression/report.hpp"
#include "core/process/distributions.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/unit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace driftlab::regression {
namespace {

constexpr std::size_t kFewestSessions = 3;

/// Session means of one unit [SI], and what the sentences need of it.
struct Means {
  std::vector<double> baseline;
  std::vector<double> candidate;
  bool gyroscope = false;
};

/// The mean of each unit over one session, weighted by samples. Channels without a unit or a mean have no share.
std::map<std::string, std::pair<double, bool>> means_of(const PowerUp& session) {
  struct Sum {
    double weighted = 0.0;
    double samples = 0.0;
    bool gyroscope = false;
  };
  std::map<std::string, Sum> sums;
  for (const ComparedRecording* recording : session.recordings) {
    for (const ComparedChannel& channel : recording->channels) {
      const std::string name = unit_name(*recording, channel.result);
      const driftlab::Unit unit = channel.result.parsed_unit();
      if (name.empty() || !channel.facts.mean || unit.dimension == Dimension::One) {
        continue;
      }
      const auto samples = static_cast<double>(channel.result.samples);
      Sum& sum = sums[name];
      sum.weighted += samples * unit.to_si(*channel.facts.mean);
      sum.samples += samples;
      sum.gyroscope = unit.dimension == Dimension::AngularRate;
    }
  }
  std::map<std::string, std::pair<double, bool>> means;
  for (const auto& [name, sum] : sums) {
    if (sum.samples > 0.0) {
      means.emplace(name, std::pair(sum.weighted / sum.samples, sum.gyroscope));
    }
  }
  return means;
}

std::map<std::string, Means> means_of(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate) {
  std::map<std::string, Means> all;
  for (const auto& [sessions, list] :
       {std::pair(&baseline, &Means::baseline), std::pair(&candidate, &Means::candidate)}) {
    for (const PowerUp& session : *sessions) {
      for (const auto& [name, mean] : means_of(session)) {
        Means& means = all[name];
        (means.*list).push_back(mean.first);
        means.gyroscope = mean.second;
      }
    }
  }
  std::erase_if(all, [](const auto& one) { return one.second.baseline.empty() || one.second.candidate.empty(); });
  return all;
}

struct Spread {
  double mean = 0.0;
  double of_mean = 0.0;  ///< squared standard error
};

Spread spread_of(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  Spread spread;
  for (const double value : values) {
    spread.mean += value / count;
  }
  for (const double value : values) {
    spread.of_mean += values.size() > 1 ? (value - spread.mean) * (value - spread.mean) / (count * (count - 1.0)) : 0.0;
  }
  return spread;
}

/// P of so much beyond the margin.
double welch_p(const Means& means, double margin) {
  const Spread before = spread_of(means.baseline);
  const Spread now = spread_of(means.candidate);
  const double square = before.of_mean + now.of_mean;
  const double beyond = std::abs(now.mean - before.mean) - margin;
  if (!(square > 0.0)) {
    return beyond > 0.0 ? 0.0 : 1.0;
  }
  const double dof = square * square /
                     (before.of_mean * before.of_mean / (static_cast<double>(means.baseline.size()) - 1.0) +
                      now.of_mean * now.of_mean / (static_cast<double>(means.candidate.size()) - 1.0));
  return student_tail(beyond / std::sqrt(square), dof);
}

/// As people write it: `+0.12 deg/s`, `-3.1 mg`.
std::string text_of(double value, bool gyroscope) {
  const auto unit = parse_unit(gyroscope ? "deg/s" : "mg");
  return significant(unit ? unit->from_si(value) : value) + (gyroscope ? " deg/s" : " mg");
}

double difference_of(const Means& means) { return spread_of(means.candidate).mean - spread_of(means.baseline).mean; }

std::string moved(const std::string& name, const Means& means) {
  const double difference = difference_of(means);
  return short_name(name) + ": the bias moved by " + (difference > 0.0 ? "+" : "") +
         text_of(difference, means.gyroscope);
}

/// The largest move for a reader where nothing is tested: a gyroscope's before an accelerometer's, whose mean holds
/// gravity.
std::string largest_move(const std::map<std::string, Means>& all) {
  const auto found = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::pair(a.second.gyroscope, std::abs(difference_of(a.second))) <
           std::pair(b.second.gyroscope, std::abs(difference_of(b.second)));
  });
  return found == all.end() ? std::string() : moved(found->first, found->second) + "; no margin is set for it.";
}

}  // namespace

EventCheck check_bias(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                      const BiasMargins& margins, double level) {
  EventCheck check{"bias", CheckVerdict::Ok, "", {}, std::nullopt};
  const std::map<std::string, Means> all = means_of(baseline, candidate);
  if (!margins.any()) {
    check.sentence = largest_move(all);
    return check;
  }
  double tests = 0.0;
  for (const auto& [name, means] : all) {
    const double margin = means.gyroscope ? margins.gyroscope : margins.accelerometer;
    if (!(margin > 0.0)) {
      continue;
    }
    if (std::min(means.baseline.size(), means.candidate.size()) < kFewestSessions) {
      check.verdict = CheckVerdict::Note;
      check.sentence =
          "The bias is not tested: its margin needs three sessions an arm, for nobody knows how much the "
          "bias of this sensor moves from one power-up to the next.";
      return check;
    }
    ++tests;
    const double p = welch_p(means, margin);
    if (!check.p || p < *check.p) {
      check.p = p;
      check.sentence = moved(name, means) + ", margin " + text_of(margin, means.gyroscope) + ".";
    }
  }
  if (check.p && *check.p * tests <= level) {
    check.verdict = CheckVerdict::Fail;
    for (const PowerUp& session : candidate) {
      check.sessions.push_back(session.name);
    }
  }
  return check;
}

}  // namespace driftlab::regression
