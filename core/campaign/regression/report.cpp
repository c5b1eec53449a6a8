#include "core/campaign/regression/report.hpp"

#include "core/campaign/regression/bias_check.hpp"
#include "core/campaign/regression/pooled_unit.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>

namespace driftlab::regression {
namespace {

constexpr double kDoesNotRepeat = 4.0;

/// All sessions in one list: baseline, candidate, then the releases.
struct Sessions {
  PowerUps baseline;
  PowerUps candidate;
  std::vector<PowerUps> history;

  [[nodiscard]] std::vector<const PowerUp*> all() const {
    std::vector<const PowerUp*> list;
    for (const PowerUps* arm : {&baseline, &candidate}) {
      for (const PowerUp& session : arm->sessions) {
        list.push_back(&session);
      }
    }
    for (const PowerUps& release : history) {
      for (const PowerUp& session : release.sessions) {
        list.push_back(&session);
      }
    }
    return list;
  }
  [[nodiscard]] std::size_t compared() const { return baseline.sessions.size() + candidate.sessions.size(); }
};

struct NamedUnit {
  std::string name;
  std::string condition;
  Quantity quantity = Quantity::Unspecified;
  std::string axis;
};

/// Units of a session's channels by name.
std::map<std::string, NamedUnit> units_of(const std::vector<PowerUp>& sessions) {
  std::map<std::string, NamedUnit> units;
  for (const PowerUp& session : sessions) {
    for (const ComparedRecording* recording : session.recordings) {
      for (const ComparedChannel& channel : recording->channels) {
        if (const std::string name = unit_name(*recording, channel.result); !name.empty()) {
          units[name] = {name, recording->condition,
                         parse_quantity(channel.result.quantity).value_or(Quantity::Unspecified), channel.result.axis};
        }
      }
    }
  }
  return units;
}

SessionChannels channels_of(const PowerUp& session, const std::string& unit) {
  SessionChannels channels;
  for (const ComparedRecording* recording : session.recordings) {
    for (const ComparedChannel& channel : recording->channels) {
      if (unit_name(*recording, channel.result) == unit) {
        channels.push_back(&channel.result);
      }
    }
  }
  return channels;
}

double margin_at(const Margins& margins, double tau_s) {
  const double percent = tau_s <= 1.0 ? margins.percent[0] : tau_s <= 10.0 ? margins.percent[1] : margins.percent[2];
  return std::log1p(percent / 100.0);
}

/// By the declared unit of the level: N has a root of time, sigma and B none, the others more.
double margin_of(const Level& level, const Margins& margins, const Settings& settings) {
  const ProcessKind* const kind = find_process(level.process);
  const int halves = kind != nullptr ? kind->parameters[0].second_power_halves : 0;
  const double percent = halves == 1   ? margins.percent[0]
                         : halves == 0 ? settings.margin_sigma_percent
                                       : settings.margin_slow_percent;
  return std::log1p(percent / 100.0);
}

/// A white density must be shown where the scales that must be shown consist of it by half.
bool is_gated(const Level& level, const PooledUnit& pooled, Eigen::Index p, std::size_t rows, double through_s) {
  const ProcessKind* const kind = find_process(level.process);
  bool shows = false;
  for (std::size_t row = 0; row < rows; ++row) {
    shows = shows || (pooled.tau_s[row] <= through_s && pooled.sensitivity(static_cast<Eigen::Index>(row), p) >= 0.5);
  }
  return shows && kind != nullptr && kind->white_square != nullptr;
}

/// The best model of one arm, by the least sum of criteria.
std::string structure_of(const std::vector<PowerUp>& sessions, const std::string& unit) {
  std::map<std::string, double> sums;
  std::map<std::string, std::size_t> counts;
  std::size_t channels = 0;
  for (const PowerUp& session : sessions) {
    for (const ReportedChannel* channel : channels_of(session, unit)) {
      ++channels;
      for (const ReportedFit& fit : channel->fits) {
        sums[fit.model] += fit.wic;
        ++counts[fit.model];
      }
    }
  }
  std::string best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [model, sum] : sums) {
    if (counts[model] == channels && sum < least) {
      best = model;
      least = sum;
    }
  }
  return best;
}

/// The design under construction: rows unit by unit.
class Builder {
 public:
  Builder(const Sessions& sessions, const Settings& settings)
      : sessions_(sessions),
        settings_(settings),
        all_(sessions.all()),
        x_(all_.size()),
        has_(all_.size()),
        sampling_(all_.size()) {}

  /// False where no scale has enough degrees of freedom in both arms.
  bool add(const NamedUnit& named, UnitReport& told) {
    std::vector<SessionChannels> channels;
    for (const PowerUp* session : all_) {
      channels.push_back(channels_of(*session, named.name));
    }
    const auto pooled = pool_unit(channels, sessions_.compared());
    if (!pooled || rows_of(*pooled) == 0) {
      return false;
    }
    const std::size_t rows = rows_of(*pooled);
    mixed_rates = mixed_rates || pooled->mixed_rates;
    const bool gyroscope = named.quantity == Quantity::AngularRate;
    const Margins& margins = gyroscope ? settings_.gyroscope : settings_.accelerometer;
    Unit unit;
    unit.tau0 = gyroscope ? settings_.tau0_gyroscope : settings_.tau0_accelerometer;
    unit.first = design.rows.size();
    unit.count = rows;
    unit.levels = pooled->levels;
    unit.shapes = pooled->shapes;
    const auto count = static_cast<Eigen::Index>(rows);
    if (!unit.levels.empty()) {
      unit.modelled = pooled->modelled.head(count);
      unit.sensitivity = pooled->sensitivity.topRows(count);
    }
    for (std::size_t p = 0; p < unit.levels.size(); ++p) {
      unit.levels[p].margin = margin_of(unit.levels[p], margins, settings_);
      unit.levels[p].gated =
          is_gated(unit.levels[p], *pooled, static_cast<Eigen::Index>(p), rows, settings_.test.through_s);
    }
    for (std::size_t row = 0; row < rows; ++row) {
      const double tau_s = pooled->tau_s[row];
      design.rows.push_back({design.units.size(), static_cast<int>(row), tau_s, margin_at(margins, tau_s)});
      told.tau_s.push_back(tau_s);
    }
    told.model = pooled->model;
    for (std::vector<double>& edf : told.edf) {
      edf.assign(rows, 0.0);
    }
    for (std::size_t s = 0; s < all_.size(); ++s) {
      add_session(s, pooled->sessions[s], rows, told);
    }
    design.units.push_back(std::move(unit));
    return true;
  }

  void finish() {
    std::map<std::vector<bool>, std::size_t> groups;
    for (std::size_t s = 0; s < all_.size(); ++s) {
      Session session;
      session.arm = arm_of(s);
      session.release = release_of(s);
      session.x = Eigen::Map<const Eigen::VectorXd>(x_[s].data(), static_cast<Eigen::Index>(x_[s].size()));
      session.has = has_[s];
      std::vector<bool> units;
      for (const Unit& unit : design.units) {
        units.push_back(has_[s][unit.first]);
      }
      session.group = groups.emplace(units, groups.size()).first->second;
      for (const Session& other : design.sessions) {  // equal lengths share one law
        if (*other.sampling == sampling_[s]) {
          session.sampling = other.sampling;
          break;
        }
      }
      if (session.sampling == nullptr) {
        session.sampling = std::make_shared<Sampling>(sampling_[s]);
      }
      design.sessions.push_back(std::move(session));
    }
  }

  Design design;
  bool mixed_rates = false;

 private:
  [[nodiscard]] Arm arm_of(std::size_t session) const {
    return session < sessions_.baseline.sessions.size() ? Arm::Baseline
           : session < sessions_.compared()             ? Arm::Candidate
                                                        : Arm::History;
  }
  [[nodiscard]] std::size_t release_of(std::size_t session) const {
    std::size_t first = sessions_.compared();
    for (std::size_t release = 0; release < sessions_.history.size(); ++release) {
      first += sessions_.history[release].sessions.size();
      if (session < first) {
        return release;
      }
    }
    return 0;
  }
  /// As far as both arms reach with enough degrees of freedom, or one of them.
  [[nodiscard]] std::size_t rows_of(const PooledUnit& pooled) const {
    std::array<std::size_t, 2> reach{0, 0};
    for (std::size_t s = 0; s < sessions_.compared(); ++s) {
      std::size_t& own = reach[arm_of(s) == Arm::Candidate ? 1 : 0];
      for (std::size_t row = own; row < pooled.tau_s.size(); ++row) {
        if (pooled.sessions[s].edf(static_cast<Eigen::Index>(row)) >= settings_.min_edf) {
          own = row + 1;
        }
      }
    }
    return std::min(reach[0], reach[1]);
  }
  void add_session(std::size_t s, const SessionCurve& curve, std::size_t rows, UnitReport& told) {
    const auto count = static_cast<Eigen::Index>(rows);
    for (Eigen::Index row = 0; row < count; ++row) {
      const bool has = curve.edf(row) >= settings_.min_edf;
      x_[s].push_back(has ? curve.x(row) : 0.0);
      has_[s].push_back(has);
      if (arm_of(s) != Arm::History) {
        told.edf[arm_of(s) == Arm::Candidate ? 1 : 0][static_cast<std::size_t>(row)] += curve.edf(row);
      }
    }
    sampling_[s].push_back(curve.sampling.topLeftCorner(count, count));
  }

  const Sessions& sessions_;
  const Settings& settings_;
  std::vector<const PowerUp*> all_;
  std::vector<std::vector<double>> x_;
  std::vector<std::vector<bool>> has_;
  std::vector<Sampling> sampling_;
};

ArmReport arm_report(const Recordings& arm, const PowerUps& sessions) {
  ArmReport told;
  told.label = arm.label;
  for (const PowerUp& session : sessions.sessions) {
    ArmReport::Session one{session.name, {}, 0.0};
    for (const ComparedRecording* recording : session.recordings) {
      one.recordings.push_back(recording->id);
      one.duration_s += recording->duration_s;
      told.rate_hz = told.rate_hz > 0.0 ? told.rate_hz : recording->rate_hz;
    }
    told.sessions.push_back(std::move(one));
  }
  return told;
}

/// Releases in the order of time where every recording has one, else as listed.
ReleaseOrder order_of(const Request& request, const Sessions& sessions) {
  struct Release {
    double key;
    std::size_t sessions;
  };
  std::vector<const Recordings*> arms{&request.baseline, &request.candidate};
  const std::size_t before = std::min(request.before_baseline.value_or(request.history.size()), request.history.size());
  const auto last = static_cast<double>(request.history.size());
  std::vector<Release> releases{{static_cast<double>(before) - 0.5, sessions.baseline.sessions.size()},
                                {last, sessions.candidate.sessions.size()}};
  for (std::size_t i = 0; i < request.history.size(); ++i) {
    arms.push_back(&request.history[i]);
    releases.push_back({static_cast<double>(i), sessions.history[i].sessions.size()});
  }
  std::vector<double> began;
  for (const Recordings* arm : arms) {
    double first = std::numeric_limits<double>::infinity();
    for (const ComparedRecording& recording : arm->recordings) {
      first = std::min(first, recording.began_s.value_or(-std::numeric_limits<double>::infinity()));
    }
    began.push_back(first);
  }
  const bool timed = std::all_of(began.begin(), began.end(), [](double time) { return std::isfinite(time); });
  std::vector<double> keys;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    releases[i].key = timed ? began[i] : releases[i].key;
    keys.push_back(releases[i].key);
  }
  std::sort(keys.begin(), keys.end());
  const auto rank = [&](double key) {
    return static_cast<double>(std::lower_bound(keys.begin(), keys.end(), key) - keys.begin());
  };
  ReleaseOrder order;
  for (const Release& release : releases) {
    order.position.insert(order.position.end(), release.sessions, rank(release.key));
  }
  order.anchor = rank(releases[0].key);
  order.candidate = rank(releases[1].key);
  return order;
}

void tell_trends(const Design& design, const ReleaseOrder& order, Report& report) {
  const Comparison& comparison = report.comparison;
  for (ReleaseTrend& trend : release_trends(design, scatter_terms(design), comparison.scatter, comparison.contrast,
                                            order, report.settings.test.through_s)) {
    std::string name;
    if (trend.level) {
      const Level& level = design.units[trend.unit].levels[*trend.level];
      name = level.process + "." + level.parameter;
    }
    report.trends.push_back({report.units[trend.unit].name, std::move(name), trend});
  }
}

void tell_tests(const Design& design, Report& report) {
  const Comparison& comparison = report.comparison;
  for (std::size_t u = 0; u < design.units.size(); ++u) {
    report.units[u].structure_test = comparison.contrast.structures[u];
  }
  for (std::size_t t = 0; t < comparison.contrast.tests.size(); ++t) {
    const Test& test = comparison.contrast.tests[t];
    ScaleReport told{test, comparison.outcomes[t], "", comparison.contrast.theta(static_cast<Eigen::Index>(t)),
                     comparison.gate.gated[t]};
    if (test.level) {
      const Level& level = design.units[test.unit].levels[*test.level];
      told.name = level.process + "." + level.parameter;
    }
    report.units[test.unit].tests.push_back(std::move(told));
  }
}

/// Every unit must reach the scales that must be shown.
void check_length(const Design& design, Report& report) {
  double reach_s = std::numeric_limits<double>::infinity();
  for (const Unit& unit : design.units) {
    reach_s = std::min(reach_s, design.rows[unit.first + unit.count - 1].tau_s);
  }
  const double through_s = report.settings.test.through_s;
  if (2.0 * reach_s > through_s) {
    return;
  }
  double length_s = 0.0;
  for (const ArmReport* arm : {&report.baseline, &report.candidate}) {
    for (const ArmReport::Session& session : arm->sessions) {
      length_s = length_s > 0.0 ? std::min(length_s, session.duration_s) : session.duration_s;
    }
  }
  const double enough_s = 60.0 * std::ceil(length_s * through_s / reach_s / 60.0);
  report.comparability.push_back({"length", "Too short: a session of " + duration_text(length_s) + " reaches " +
                                                duration_text(reach_s) + "; " + duration_text(enough_s) + " reach " +
                                                duration_text(through_s) + "."});
}

/// The same samples twice are no second session, and candidate and baseline at once show that nothing changed.
Status check_copies(const Request& request) {
  std::vector<const ComparedRecording*> all;
  for (const Recordings* arm : {&request.baseline, &request.candidate}) {
    for (const ComparedRecording& recording : arm->recordings) {
      all.push_back(&recording);
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto& a = all[i]->channels;
      const auto& b = all[j]->channels;
      const bool copies = !a.empty() && a.size() == b.size() &&
                          std::equal(a.begin(), a.end(), b.begin(), [](const auto& one, const auto& other) {
                            return one.result.haar.variance == other.result.haar.variance;
                          });
      if (copies) {
        return fail(ErrorCode::InvalidArgument,
                    "The recordings " + all[j]->id + " and " + all[i]->id + " hold the same samples.",
                    {{"recording", all[i]->id}});
      }
    }
  }
  return {};
}

Status check_arms(const Request& request) {
  for (const auto& [arm, name] : {std::pair{&request.baseline, "baseline"}, {&request.candidate, "candidate"}}) {
    if (arm->recordings.empty()) {
      return fail(ErrorCode::InvalidArgument, std::string("The ") + name + " has no recordings.", {{"arm", name}});
    }
  }
  std::set<std::string> base;
  for (const ComparedRecording& recording : request.baseline.recordings) {
    base.insert(recording.id);
  }
  for (const ComparedRecording& recording : request.candidate.recordings) {
    if (base.contains(recording.id)) {
      return fail(ErrorCode::InvalidArgument, "The recording " + recording.id + " is in both arms.",
                  {{"recording", recording.id}});
    }
  }
  return check_copies(request);
}

}  // namespace

Result<Report> run_regression(const Request& request) {
  if (auto checked = check_arms(request); !checked) {
    return fail(checked.error());
  }
  Sessions sessions{group_sessions(request.baseline), group_sessions(request.candidate), {}};
  Report report;
  report.device = request.device;
  report.settings = request.settings;
  report.excluded = request.excluded;
  report.baseline = arm_report(request.baseline, sessions.baseline);
  report.candidate = arm_report(request.candidate, sessions.candidate);
  for (const Recordings& release : request.history) {
    sessions.history.push_back(group_sessions(release));
    report.history.push_back(arm_report(release, sessions.history.back()));
  }
  for (const PowerUps* arm : {&sessions.baseline, &sessions.candidate}) {
    for (const std::string& note : arm->notes) {
      if (std::find(report.notes.begin(), report.notes.end(), note) == report.notes.end()) {
        report.notes.push_back(note);
      }
    }
  }
  report.comparability = compare_arms(sessions.baseline.sessions, sessions.candidate.sessions);
  Builder builder(sessions, request.settings);
  const auto now = units_of(sessions.candidate.sessions);
  for (const auto& [name, unit] : units_of(sessions.baseline.sessions)) {
    if (!now.contains(name)) {
      continue;
    }
    UnitReport told;
    told.name = name;
    told.condition = unit.condition;
    told.sensor = sensor_of(unit.quantity);
    told.axis = unit.axis;
    told.structure = {structure_of(sessions.baseline.sessions, name), structure_of(sessions.candidate.sessions, name)};
    if (builder.add(unit, told)) {
      report.units.push_back(std::move(told));
    } else {
      report.comparability.push_back({"length", "Too short: no scale of " + name + " has " +
                                                    std::to_string(static_cast<int>(request.settings.min_edf)) +
                                                    " degrees of freedom in both arms."});
    }
  }
  if (report.units.empty() && report.comparability.empty()) {
    return fail(ErrorCode::InvalidArgument,
                "There is nothing to compare: no column of the recordings is known to be an axis of a gyroscope or an "
                "accelerometer. Name them, for example --columns gz=angular_rate:z:deg/s.");
  }
  if (!report.units.empty()) {
    builder.finish();
    report.comparison = compare(builder.design, request.settings.test);
    report.scope_s = report.comparison.gate.scope_s;
    tell_tests(builder.design, report);
    tell_trends(builder.design, order_of(request, sessions), report);
    check_length(builder.design, report);
  }
  if (builder.mixed_rates) {
    report.notes.push_back("The recordings have different rates: scales are compared at equal averaging time, from " +
                           duration_text(report.units.front().tau_s.front()) + " on.");
  }
  if (report.comparison.scatter.contrasts > 0 &&
      std::sqrt(report.comparison.scatter.mean_square_common()) > kDoesNotRepeat) {
    report.comparability.push_back(
        {"repeatability",
         "The rig does not repeat: sessions without a change differ more than four times as much as "
         "sessions of such sensors do."});
  }
  // Where the bias is tested too, it takes half of the level of the events.
  const double level =
      request.settings.test.look_share * request.settings.test.event_alpha * (request.settings.bias.any() ? 0.5 : 1.0);
  report.checks = check_events(sessions.baseline.sessions, sessions.candidate.sessions, level);
  report.checks.push_back(
      check_bias(sessions.baseline.sessions, sessions.candidate.sessions, request.settings.bias, level));
  const bool event = std::any_of(report.checks.begin(), report.checks.end(),
                                 [](const EventCheck& check) { return check.verdict == CheckVerdict::Fail; });
  report.verdict = event                           ? Verdict::Fail
                   : !report.comparability.empty() ? Verdict::Inconclusive
                                                   : report.comparison.verdict;
  report.leaning_worse = report.verdict == Verdict::Inconclusive && report.comparison.worse_shown;
  tell(report);
  return report;
}

}  // namespace driftlab::regression
