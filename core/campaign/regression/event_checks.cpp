#include "core/campaign/regression/event_checks.hpp"

#include "core/campaign/regression/comparability.hpp"
#include "core/campaign/regression/gross_errors.hpp"
#include "core/campaign/regression/held_share.hpp"
#include "core/signal/sort_keeping_ties.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <set>
#include <utility>

namespace driftlab::regression {
namespace {

template <class... Arguments>
std::string written(const char* format, Arguments... arguments) {
  std::array<char, 256> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), format, arguments...);
  return {buffer.data(), std::min(static_cast<std::size_t>(length), buffer.size() - 1)};
}

/// A figure of a channel, by unit: the largest over a session's recordings.
using Figure = std::function<double(const ComparedRecording&, const ComparedChannel&)>;
using ByUnit = std::map<std::string, double>;

ByUnit largest_of(const PowerUp& session, const Figure& figure) {
  ByUnit largest;
  for (const ComparedRecording* recording : session.recordings) {
    for (const ComparedChannel& channel : recording->channels) {
      const std::string name = unit_name(*recording, channel.result);
      const double value = figure(*recording, channel);
      const auto [at, fresh] = largest.emplace(name, value);
      at->second = fresh ? value : std::max(at->second, value);
    }
  }
  return largest;
}

ByUnit largest_of(const std::vector<PowerUp>& sessions, const Figure& figure) {
  ByUnit largest;
  for (const PowerUp& session : sessions) {
    for (const auto& [name, value] : largest_of(session, figure)) {
      const auto [at, fresh] = largest.emplace(name, value);
      at->second = fresh ? value : std::max(at->second, value);
    }
  }
  return largest;
}

struct Excess {
  std::string unit;
  double baseline = 0.0;
  double candidate = 0.0;
  std::vector<std::string> sessions;
};

/// The same figure in both arms, or one for each.
struct Figures {
  Figures(Figure both) : baseline(both), candidate(std::move(both)) {}  // NOLINT(google-explicit-constructor)
  Figures(Figure before, Figure now) : baseline(std::move(before)), candidate(std::move(now)) {}

  Figure baseline;
  Figure candidate;
};

/// Units in which a candidate session's figure is more than `exceeds` permits after the baseline's largest; the worst
/// first. `sessions` of it: all that show it.
std::vector<Excess> exceeding(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                              const Figures& figures, const std::function<bool(double, double)>& exceeds) {
  const ByUnit before = largest_of(baseline, figures.baseline);
  std::map<std::string, Excess> found;
  for (const PowerUp& session : candidate) {
    for (const auto& [name, value] : largest_of(session, figures.candidate)) {
      const auto known = before.find(name);
      if (known == before.end() || !exceeds(value, known->second)) {
        continue;
      }
      Excess& excess = found[name];
      excess.unit = name;
      excess.baseline = known->second;
      excess.candidate = std::max(excess.candidate, value);
      excess.sessions.push_back(session.name);
    }
  }
  std::vector<Excess> list;
  for (auto& [name, excess] : found) {
    list.push_back(std::move(excess));
  }
  sort_keeping_ties(
      list, [](const Excess& a, const Excess& b) { return a.candidate - a.baseline > b.candidate - b.baseline; });
  return list;
}

EventCheck told(const char* name, const std::vector<Excess>& found,
                const std::function<std::string(const Excess&)>& sentence) {
  EventCheck check{name, CheckVerdict::Ok, "", {}, std::nullopt};
  if (!found.empty()) {
    check.verdict = CheckVerdict::Fail;
    check.sentence = sentence(found.front());
    check.sessions = found.front().sessions;
  }
  return check;
}

EventCheck check_share(const char* name, const char* words, const std::vector<PowerUp>& baseline,
                       const std::vector<PowerUp>& candidate, std::size_t ChannelFacts::* count, double limit) {
  const Figure share = [count](const ComparedRecording& recording, const ComparedChannel& channel) {
    const double samples = static_cast<double>(std::max<std::size_t>(channel.facts.samples, 1));
    const double own = static_cast<double>(channel.facts.*count);
    const bool missing = count == &ChannelFacts::missing;
    const double lost = missing ? static_cast<double>(recording.missing) : 0.0;
    return (own + lost) / (samples + lost);
  };
  return told(
      name, exceeding(baseline, candidate, share, [limit](double now, double before) { return now > before + limit; }),
      [&](const Excess& excess) {
        return written("%s: %.2g %% of the samples are %s, in the baseline at most %.2g %%.", excess.unit.c_str(),
                       100.0 * excess.candidate, words, 100.0 * excess.baseline);
      });
}

/// Mean square of the differences of neighbours [channel unit^2]: four times the first wavelet variance.
double mean_square_of(const ComparedChannel& channel) {
  const ReportedHaar& haar = channel.result.haar;
  return haar.scale.empty() || haar.scale.front() != 2 ? 0.0 : 4.0 * haar.variance.front();
}

/// Samples held over from the one before, without those that rounding makes equal (held_share.hpp).
EventCheck check_repeated(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate, double limit) {
  const auto held = [](double HeldShare::* bound) -> Figure {
    return [bound](const ComparedRecording& /*recording*/, const ComparedChannel& channel) {
      const std::size_t samples = std::max<std::size_t>(channel.facts.samples, 1);
      const double equal = static_cast<double>(channel.facts.repeated) / static_cast<double>(samples);
      const double mean_square = mean_square_of(channel);
      const double step = mean_square > 0.0 ? channel.facts.resolution : 0.0;
      return held_share(equal, samples, mean_square, step).*bound;
    };
  };
  return told("repeated",
              exceeding(baseline, candidate, {held(&HeldShare::high), held(&HeldShare::low)},
                        [limit](double now, double before) { return now > before + limit; }),
              [](const Excess& excess) {
                return written(
                    "%s: at least %.2g %% of the samples are held over from the one before, in the baseline "
                    "at most %.2g %%.",
                    excess.unit.c_str(), 100.0 * excess.candidate, 100.0 * excess.baseline);
              });
}

EventCheck check_saturation(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate) {
  const Figure saturated = [](const ComparedRecording& /*recording*/, const ComparedChannel& channel) {
    return static_cast<double>(channel.facts.saturated);
  };
  return told(
      "saturation",
      exceeding(baseline, candidate, saturated, [](double now, double before) { return now > 0.0 && before == 0.0; }),
      [](const Excess& excess) {
        return written("%s: %.0f samples lie at the full scale, in the baseline none.", excess.unit.c_str(),
                       excess.candidate);
      });
}

EventCheck check_jitter(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                        const EventLimits& limits) {
  const Figure jitter = [](const ComparedRecording& recording, const ComparedChannel& /*channel*/) {
    return recording.jitter_s * recording.rate_hz;
  };
  return told("timestamps",
              exceeding(baseline, candidate, jitter,
                        [&](double now, double before) {
                          return now > limits.jitter * before && now > limits.jitter_of_interval;
                        }),
              [](const Excess& excess) {
                return written("The time stamps jitter by %.2g of a sample interval, in the baseline by %.2g.",
                               excess.candidate, excess.baseline);
              });
}

/// What a full scale that somebody changed would explain: all axes of the sensor have steps larger by one factor.
std::string full_scale_hint(const std::vector<Excess>& found) {
  constexpr double kOneFactor = 0.02;
  const Excess& worst = found.front();
  const double factor = worst.candidate / worst.baseline;
  const std::string sensor = worst.unit.substr(0, worst.unit.find(' '));
  const auto alike = std::count_if(found.begin(), found.end(), [&](const Excess& excess) {
    return excess.unit.starts_with(sensor) && std::abs(excess.candidate / excess.baseline / factor - 1.0) < kOneFactor;
  });
  return alike < 2 ? std::string()
                   : written(
                         "; so do the other axes, as with a full scale %.3g times as large: state full_scale of the "
                         "recordings if it was changed on purpose",
                         factor);
}

EventCheck check_resolution(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate, double limit) {
  const std::set<Quantity> changed = changed_full_scales(baseline, candidate);  // their steps say nothing
  const Figure step = [&](const ComparedRecording& /*recording*/, const ComparedChannel& channel) {
    const auto quantity = parse_quantity(channel.result.quantity);
    return quantity && changed.contains(*quantity) ? 0.0
                                                   : channel.facts.resolution * channel.result.parsed_unit().factor;
  };
  const auto sentence = [](const Excess& excess) {
    return written("%s: the step of the values went from %.3g to %.3g (SI)", excess.unit.c_str(), excess.baseline,
                   excess.candidate);
  };
  // Readings written as floats have the last digit of a small one for a step, which moves with the bias.
  constexpr double kSeen = 0.1;  // of the noise: a step below that adds less than a thousandth to its variance
  const Figure seen_step = [&](const ComparedRecording& recording, const ComparedChannel& channel) {
    const double noise = std::sqrt(0.5 * mean_square_of(channel));
    return channel.facts.resolution > kSeen * noise ? step(recording, channel) : 0.0;
  };
  const std::vector<Excess> coarser =
      exceeding(baseline, candidate, {step, seen_step},
                [limit](double now, double before) { return before > 0.0 && now > limit * before; });
  EventCheck check = told("resolution", coarser,
                          [&](const Excess& excess) { return sentence(excess) + full_scale_hint(coarser) + "."; });
  if (check.verdict == CheckVerdict::Ok) {
    const auto finer = exceeding(baseline, candidate, step,
                                 [limit](double now, double before) { return now > 0.0 && before > limit * now; });
    if (!finer.empty()) {
      check = {"resolution", CheckVerdict::Note, sentence(finer.front()) + ".", finer.front().sessions, std::nullopt};
    }
  }
  return check;
}

EventCheck check_rate(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate, double limit) {
  EventCheck check{"rate", CheckVerdict::Ok, "", {}, std::nullopt};
  for (const PowerUp& session : candidate) {
    for (const ComparedRecording* now : session.recordings) {
      bool like_one = false;
      double before_hz = 0.0;
      for (const PowerUp& other : baseline) {
        for (const ComparedRecording* before : other.recordings) {
          const double declared =
              now->declared_hz && before->declared_hz ? *now->declared_hz / *before->declared_hz : 1.0;
          before_hz = before->rate_hz * declared;
          like_one = like_one || std::abs(now->rate_hz / before_hz - 1.0) <= limit;
        }
      }
      if (!like_one && before_hz > 0.0) {
        check.verdict = CheckVerdict::Fail;
        check.sessions.push_back(session.name);
        check.sentence = written("The sampling rate is %.6g Hz where the baseline has %.6g Hz; nobody declared that.",
                                 now->rate_hz, before_hz);
      }
    }
  }
  return check;
}

EventCheck check_findings(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                          std::size_t limit) {
  std::set<std::string> before;
  bool known = false;
  for (const PowerUp& session : baseline) {
    for (const ComparedRecording* recording : session.recordings) {
      known = known || recording->investigated;
      before.insert(recording->causes.begin(), recording->causes.end());
    }
  }
  std::map<std::string, std::set<std::string>> fresh;
  for (const PowerUp& session : candidate) {
    for (const ComparedRecording* recording : session.recordings) {
      for (const std::string& cause : recording->causes) {
        if (!before.contains(cause)) {
          fresh[cause].insert(session.name);
        }
      }
    }
  }
  EventCheck check{"findings", CheckVerdict::Ok, "", {}, std::nullopt};
  for (const auto& [cause, sessions] : fresh) {
    const bool fails = known && sessions.size() >= limit;
    if (check.verdict != CheckVerdict::Fail && (fails || check.verdict == CheckVerdict::Ok)) {
      check.verdict = fails ? CheckVerdict::Fail : CheckVerdict::Note;
      check.sentence = "Investigations find " + cause + " in " + with_count(sessions.size(), "candidate session") +
                       (known ? " and in no baseline session." : "; no baseline session was investigated.");
      check.sessions.assign(sessions.begin(), sessions.end());
    }
  }
  return check;
}

std::map<std::string, ErrorCounts> counts_of(const std::vector<PowerUp>& sessions) {
  std::map<std::string, ErrorCounts> counts;
  for (const PowerUp& session : sessions) {
    std::map<std::string, std::pair<double, double>> own;
    for (const ComparedRecording* recording : session.recordings) {
      for (const ComparedChannel& channel : recording->channels) {
        auto& [errors, hours] = own[unit_name(*recording, channel.result)];
        errors += channel.result.contaminated() ? static_cast<double>(channel.facts.bursts) : 0.0;
        hours += std::max(recording->duration_s, 1.0) / 3600.0;
      }
    }
    for (const auto& [unit, of] : own) {
      counts[unit].errors.push_back(of.first);
      counts[unit].hours.push_back(of.second);
    }
  }
  return counts;
}

EventCheck check_contamination(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                               double limit, double event_alpha) {
  EventCheck check{"contamination", CheckVerdict::Ok, "", {}, std::nullopt};
  const auto before = counts_of(baseline);
  std::string worst;
  double tests = 0.0;
  for (const auto& [unit, now] : counts_of(candidate)) {
    const auto known = before.find(unit);
    if (unit.empty() || known == before.end()) {
      continue;
    }
    ++tests;
    if (now.sum() > 0.0) {
      const double p = error_rate_p(known->second, now, limit);
      if (!check.p || p < *check.p) {
        check.p = p;
        worst = unit;
        check.sentence = written("%s: %.3g gross errors an hour, in the baseline %.3g.", unit.c_str(),
                                 now.sum() / now.time_h(), known->second.sum() / known->second.time_h());
      }
    }
  }
  // Holm fails something if and only if it fails the smallest p at level alpha over the number of tests.
  if (check.p && *check.p * tests <= event_alpha) {
    check.verdict = CheckVerdict::Fail;
    for (const PowerUp& session : candidate) {
      const auto own = counts_of({session});
      if (const auto found = own.find(worst); found != own.end() && found->second.sum() > 0.0) {
        check.sessions.push_back(session.name);
      }
    }
  } else {
    check.sentence.clear();
  }
  return check;
}

}  // namespace

std::string_view name_of(CheckVerdict verdict) {
  switch (verdict) {
    case CheckVerdict::Ok:
      return "ok";
    case CheckVerdict::Note:
      return "note";
    case CheckVerdict::Fail:
      break;
  }
  return "fail";
}

std::string unit_name(const ComparedRecording& recording, const ReportedChannel& channel) {
  const auto quantity = parse_quantity(channel.quantity);
  if (!quantity || *quantity == Quantity::Unspecified || !is_sensor(*quantity) || channel.axis.empty()) {
    return "";
  }
  std::string name = std::string(sensor_of(*quantity)) + " " + channel.axis;
  if (recording.condition != "static") {
    const auto condition = parse_condition(recording.condition);
    name += ", " + (condition ? label(*condition) : recording.condition);
  }
  return name;
}

std::vector<EventCheck> check_events(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                                     double event_alpha, const EventLimits& limits) {
  return {check_saturation(baseline, candidate),
          check_share("missing", "missing", baseline, candidate, &ChannelFacts::missing, limits.missing),
          check_share("frozen", "of a sensor that gives one value only", baseline, candidate, &ChannelFacts::frozen,
                      limits.missing),
          check_repeated(baseline, candidate, limits.missing),
          check_jitter(baseline, candidate, limits),
          check_resolution(baseline, candidate, limits.resolution),
          check_contamination(baseline, candidate, limits.contamination, event_alpha),
          check_findings(baseline, candidate, limits.findings),
          check_rate(baseline, candidate, limits.rate)};
}

}  // namespace driftlab::regression
