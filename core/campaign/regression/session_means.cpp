#include "core/campaign/regression/session_means.hpp"

#include "core/campaign/regression/report.hpp"
#include "core/process/distributions.hpp"
#include "core/signal/short_name.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab::regression {
namespace {

constexpr std::size_t kFewestSessions = 3;

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
double welch_p(const ArmFigures& figures, double margin) {
  const Spread before = spread_of(figures.baseline);
  const Spread now = spread_of(figures.candidate);
  const double square = before.of_mean + now.of_mean;
  const double beyond = std::abs(now.mean - before.mean) - margin;
  if (!(square > 0.0)) {
    return beyond > 0.0 ? 0.0 : 1.0;
  }
  const double dof = square * square /
                     (before.of_mean * before.of_mean / (static_cast<double>(figures.baseline.size()) - 1.0) +
                      now.of_mean * now.of_mean / (static_cast<double>(figures.candidate.size()) - 1.0));
  return student_tail(beyond / std::sqrt(square), dof);
}

std::string moved(const std::string& unit, const ArmFigures& figures, const ShiftWords& words) {
  const double difference = figures.difference();
  return short_sensor_name(unit) + ": the " + words.figure + " moved by " + (difference > 0.0 ? "+" : "") +
         words.text(difference, figures.gyroscope);
}

/// The largest move for a reader where nothing is tested: a gyroscope's before an accelerometer's, whose mean holds
/// gravity.
std::string largest_move(const FiguresByUnit& all, const ShiftWords& words) {
  const auto found = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::pair(a.second.gyroscope, std::abs(a.second.difference())) <
           std::pair(b.second.gyroscope, std::abs(b.second.difference()));
  });
  return found == all.end() ? std::string() : moved(found->first, found->second, words) + "; no margin is set for it.";
}

}  // namespace

double ArmFigures::difference() const { return spread_of(candidate).mean - spread_of(baseline).mean; }

FiguresByUnit arm_figures(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                          const std::function<std::map<std::string, SessionFigure>(const PowerUp&)>& of) {
  FiguresByUnit all;
  for (const auto& [sessions, list] :
       {std::pair(&baseline, &ArmFigures::baseline), std::pair(&candidate, &ArmFigures::candidate)}) {
    for (const PowerUp& session : *sessions) {
      for (const auto& [unit, figure] : of(session)) {
        ArmFigures& figures = all[unit];
        (figures.*list).push_back(figure.value);
        figures.gyroscope = figure.gyroscope;
      }
    }
  }
  std::erase_if(all, [](const auto& one) { return one.second.baseline.empty() || one.second.candidate.empty(); });
  return all;
}

EventCheck check_shift(const FiguresByUnit& figures, const std::vector<PowerUp>& candidate, const ShiftMargins& margins,
                       const ShiftWords& words, double level) {
  EventCheck check{words.check, CheckVerdict::Ok, "", {}, std::nullopt};
  if (!(margins.gyroscope > 0.0) && !(margins.accelerometer > 0.0)) {
    check.sentence = largest_move(figures, words);
    return check;
  }
  const auto not_tested = [&](const std::string& why) {
    return EventCheck{
        words.check, CheckVerdict::Note, "The " + words.figure + " is not tested: " + why + ".", {}, std::nullopt};
  };
  if (figures.empty()) {
    return not_tested(words.without);
  }
  double tests = 0.0;
  for (const auto& [unit, own] : figures) {
    const double margin = own.gyroscope ? margins.gyroscope : margins.accelerometer;
    if (!(margin > 0.0)) {
      continue;
    }
    if (std::min(own.baseline.size(), own.candidate.size()) < kFewestSessions) {
      return not_tested("its margin needs three sessions an arm, for nobody knows how much the " + words.figure +
                        " of this sensor moves from one power-up to the next");
    }
    ++tests;
    const double p = welch_p(own, margin);
    if (!check.p || p < *check.p) {
      check.p = p;
      check.sentence = moved(unit, own, words) + ", margin " + words.text(margin, own.gyroscope) + ".";
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
