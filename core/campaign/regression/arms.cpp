#include "core/campaign/regression/arms.hpp"

#include "core/campaign/words.hpp"
#include "core/signal/number.hpp"

#include <algorithm>

namespace driftlab::regression {
namespace {

constexpr double kSameRate = 1e-3;  // clocks of one nominal rate differ by less

std::string rates_text(const std::vector<double>& rates_hz) {
  std::vector<std::string> texts;
  for (const double rate : rates_hz) {
    texts.push_back(short_text(rate));
  }
  return joined(texts) + " Hz";
}

}  // namespace

std::vector<std::string> ArmReport::merged() const {
  std::vector<std::string> names;
  for (const Session& session : sessions) {
    if (session.recordings.size() > 1) {
      names.push_back(session.name);
    }
  }
  return names;
}

ArmReport arm_report(const Recordings& arm, const PowerUps& sessions) {
  ArmReport told;
  told.label = arm.label;
  for (const PowerUp& session : sessions.sessions) {
    ArmReport::Session one{session.name, {}, 0.0};
    for (const ComparedRecording* recording : session.recordings) {
      one.recordings.push_back(recording->id);
      one.duration_s += recording->duration_s;
      told.rates_hz.push_back(recording->rate_hz);
    }
    told.sessions.push_back(std::move(one));
  }
  std::sort(told.rates_hz.begin(), told.rates_hz.end());
  told.rates_hz.erase(std::unique(told.rates_hz.begin(), told.rates_hz.end(),
                                  [](double a, double b) { return b <= (1.0 + kSameRate) * a; }),
                      told.rates_hz.end());
  return told;
}

std::string rates_sentence(const ArmReport& baseline, const ArmReport& candidate, double from_s) {
  std::string sentence = "Baseline " + rates_text(baseline.rates_hz) + ", candidate " + rates_text(candidate.rates_hz) +
                         ": compared from " + short_text(from_s) + " s on";
  const double before_hz = baseline.rates_hz.back();
  const double now_hz = candidate.rates_hz.back();
  const bool in_candidate = now_hz > before_hz;
  std::vector<std::string> alone;  // scales of the faster arm below the shortest of the slower one
  for (double tau_s = 1.0 / std::max(before_hz, now_hz); tau_s < (1.0 - kSameRate) / std::min(before_hz, now_hz);
       tau_s *= 2.0) {
    alone.push_back(short_text(tau_s));
  }
  if (!alone.empty()) {
    sentence += "; " + joined(alone) + (alone.size() == 1 ? " s exists" : " s exist") + " only in the " +
                (in_candidate ? "candidate" : "baseline");
  }
  return sentence + ".";
}

}  // namespace driftlab::regression
