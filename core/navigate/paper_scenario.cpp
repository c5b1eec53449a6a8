#include "core/navigate/paper_scenario.hpp"

#include "core/process/published_models.hpp"
#include "core/signal/angle.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

constexpr double kMilliG = 1e-3 * kStandardGravity;
constexpr std::array kConditions{"static", "constant_rate:z:9:deg/s", "constant_rate:z:18:deg/s",
                                 "constant_rate:z:36:deg/s"};
/// Table 5: upper ends of the bands of |z reading|; the last band goes on.
constexpr std::array kBounds{5.0, 15.0, 25.0};
/// Hysteresis of the filters' switching [deg/s]; the rates of the drive lie 3 deg/s and more from every bound.
constexpr double kHysteresis = 0.5;
/// Tables 1 and 2, iPhone 5S, experiments 0 to 3: N in deg/sqrt(h).
constexpr std::array kAllanN{1.0978, 1.1788, 1.702, 2.4233};

enum class Kind { StatAv, DynAv, DynGmwm, StatGmwm, StatAvRw, StatNeqRw };

struct Candidate {
  const char* name;
  Kind kind;
  const char* about;
};
constexpr std::array kCandidates{
    Candidate{"M_stat(AV)", Kind::StatAv, "white noise, N of Table 1; constant bias"},
    Candidate{"M_dyn(AV)", Kind::DynAv,
              "white noise, N of Tables 1 and 2 by |z reading| through Table 5; constant bias"},
    Candidate{"M_dyn(GMWM)", Kind::DynGmwm, "WN + 2 GM of Table 4 by |z reading| through Table 5"},
    Candidate{"M_stat(GMWM)", Kind::StatGmwm, "WN + 2 GM of Table 4, experiment 0"},
    Candidate{"M_stat(AV)+RW", Kind::StatAvRw,
              "N of Table 1; random-walk bias with q = sigma2 sqrt(2 beta2) of experiment 0"},
    Candidate{"M_stat(Neq)+RW", Kind::StatNeqRw,
              "N_eq = sqrt(N^2 + 2 sigma1^2/beta1) of experiment 0; the same random-walk bias"}};

Process process_of(std::string_view name, std::vector<double> values) { return *make_process(name, std::move(values)); }

/// Table 4 of one experiment: white noise, fast and slow Gauss-Markov.
Model table4(std::size_t experiment) {
  return *published_model("iphone5s-z", *parse_condition(kConditions[experiment]));
}

Model white_only(const Model& model) { return {model.front()}; }

Model allan_white(std::size_t experiment) {
  return {process_of("white_noise", {kAllanN[experiment] / 60.0 * kDegree})};
}

/// By Table 5 from one model per experiment.
ModelSchedule table5(Model (*model)(std::size_t), double hysteresis_deg_s) {
  std::vector<double> bounds;
  std::vector<Model> models{model(0)};
  for (std::size_t i = 0; i < kBounds.size(); ++i) {
    bounds.push_back(kBounds[i] * kDegree);
    models.push_back(model(i + 1));
  }
  return *ModelSchedule::by_rate(bounds, models, hysteresis_deg_s * kDegree);
}

/// What a filter without Gauss-Markov states holds of experiment 0.
Model static_substitute(Kind kind, bool gauss_markov) {
  const Model exact = table4(0);
  const double n = exact[0].parameters[0];
  const double sigma1 = exact[1].parameters[0];
  const double beta1 = exact[1].parameters[1];
  const double sigma2 = exact[2].parameters[0];
  const double beta2 = exact[2].parameters[1];
  Model model =
      kind == Kind::StatNeqRw
          ? Model{process_of("white_noise", {gauss_markov ? std::sqrt(n * n + 2.0 * sigma1 * sigma1 / beta1) : n})}
          : allan_white(0);
  if (kind != Kind::StatAv && gauss_markov) {
    model.push_back(process_of("random_walk", {sigma2 * std::sqrt(2.0 * beta2)}));
  }
  return model;
}

AxisModel believed_axis(Kind kind, bool is_z, bool gauss_markov, double bias_sd) {
  AxisModel axis;
  const double slow = table4(0)[2].parameters[0];
  const bool has_states = kind == Kind::DynGmwm || kind == Kind::StatGmwm;
  axis.bias_sd = has_states || !gauss_markov ? bias_sd : std::hypot(bias_sd, slow);
  if (has_states) {
    if (kind == Kind::DynGmwm && is_z) {
      axis.processes = table5(table4, kHysteresis);
    } else {
      axis.processes = ModelSchedule::constant(gauss_markov ? table4(0) : white_only(table4(0)));
    }
  } else if (kind == Kind::DynAv && is_z) {
    axis.processes = table5(allan_white, kHysteresis);
  } else {
    axis.processes =
        ModelSchedule::constant(static_substitute(kind == Kind::DynAv ? Kind::StatAv : kind, gauss_markov));
  }
  return axis;
}

SegmentPlan paper_drive() {
  SegmentPlan plan;
  plan.start = {51.08 * kDegree, -114.13 * kDegree, 1100.0};  // Calgary, where the paper comes from
  plan.duration_s = 480.0;
  plan.segments.push_back(
      {.kind = SegmentKind::Accelerate, .start_s = 5.0, .acceleration_m_s2 = 1.0, .until_speed_m_s = 15.0});
  for (int turn = 0; turn < 4; ++turn) {
    const bool slow = turn % 2 == 0;
    plan.segments.push_back({.kind = SegmentKind::Turn,
                             .start_s = 90.0 + 100.0 * turn,
                             .duration_s = slow ? 10.0 : 5.0,
                             .rate_rad_s = (slow ? 9.0 : 18.0) * kDegree});
  }
  return plan;
}

/// S-curves every 20 s, counted from 20 s after each outage's start (10 s after departure before the first), as long as
/// they end before the next turn.
void add_s_curves(SegmentPlan& plan, const std::vector<Outage>& outages) {
  const double needed = 10.0 + plan.ramp_s;
  std::vector<Segment> all = plan.segments;
  for (std::size_t i = 0; i <= outages.size(); ++i) {
    const double limit = i < outages.size() ? outages[i].start_s : plan.duration_s;
    for (double start = i == 0 ? 30.0 : outages[i - 1].start_s + 20.0; start + needed < limit; start += 20.0) {
      all.push_back({.kind = SegmentKind::SCurve, .start_s = start, .duration_s = 5.0, .rate_rad_s = 36.0 * kDegree});
    }
  }
  std::sort(all.begin(), all.end(), [](const Segment& a, const Segment& b) { return a.start_s < b.start_s; });
  plan.segments = std::move(all);
}

}  // namespace

const std::vector<std::string>& scenario_names() {
  static const std::vector<std::string> names{"paper", "paper-position-only", "paper-nhc", "paper-s-curves"};
  return names;
}

std::array<AxisModel, 3> paper_true_gyroscope(double bias_sd_rad_s, bool gauss_markov_on_all_axes) {
  AxisModel level;
  level.bias_sd = bias_sd_rad_s;
  level.processes = ModelSchedule::constant(gauss_markov_on_all_axes ? table4(0) : white_only(table4(0)));
  AxisModel vertical;
  vertical.bias_sd = bias_sd_rad_s;
  vertical.processes = table5(table4, 0.0);
  return {level, level, vertical};
}

Result<std::array<AxisModel, 3>> paper_gyroscope(std::string_view filter, double bias_sd_rad_s,
                                                 bool gauss_markov_on_all_axes) {
  for (const Candidate& candidate : kCandidates) {
    if (filter == candidate.name || filter == candidate.about) {
      const AxisModel level = believed_axis(candidate.kind, false, gauss_markov_on_all_axes, bias_sd_rad_s);
      const AxisModel vertical = believed_axis(candidate.kind, true, true, bias_sd_rad_s);
      return std::array<AxisModel, 3>{level, level, vertical};
    }
  }
  return fail(ErrorCode::NotFound, "The paper's comparison has no filter '" + std::string(filter) + "'.",
              {{"parameter", "filters"}});
}

Result<OutageScenario> paper_scenario(std::string_view name) {
  const auto& names = scenario_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    std::string known;
    for (const std::string& each : names) {
      known += (known.empty() ? "" : ", ") + each;
    }
    return fail(ErrorCode::NotFound, "There is no scenario '" + std::string(name) + "'; there are " + known + ".",
                {{"parameter", "scenario"}});
  }
  const bool s_curves = name == "paper-s-curves";
  OutageScenario scenario;
  scenario.name = name;
  scenario.about = "Section 4 of Radi, Nassar and El-Sheimy (2017) with the unstated values fixed";
  scenario.drive = paper_drive();
  for (const Segment& segment : scenario.drive.segments) {
    if (segment.kind == SegmentKind::Turn) {
      scenario.outages.push_back({segment.start_s, 10.0});
    }
  }
  if (s_curves) {
    add_s_curves(scenario.drive, scenario.outages);
  }
  scenario.initial.tilt_sd_rad = 1.0 * kDegree;
  scenario.initial.heading_sd_rad = 3.0 * kDegree;
  constexpr double kBias = 0.05 * kDegree;
  AxisModel accelerometer;
  accelerometer.bias_sd = 10.0 * kMilliG;
  accelerometer.processes = ModelSchedule::constant(
      {process_of("white_noise", {2.0 * kMilliG}), process_of("gauss_markov", {1.0 * kMilliG, 1.0 / 100.0})});
  scenario.truth.axes.fill(accelerometer);
  const auto gyroscope = paper_true_gyroscope(kBias, !s_curves);
  std::copy(gyroscope.begin(), gyroscope.end(), scenario.truth.axes.begin());
  for (const Candidate& candidate : kCandidates) {
    FilterCandidate filter;
    filter.name = candidate.name;
    filter.about = candidate.about;
    filter.settings.initial = scenario.initial;
    filter.settings.imu.axes.fill(accelerometer);
    const auto believed = *paper_gyroscope(candidate.name, kBias, !s_curves);
    std::copy(believed.begin(), believed.end(), filter.settings.imu.axes.begin());
    filter.settings.use_velocity = name != "paper-position-only";
    if (name == "paper-nhc") {
      filter.settings.non_holonomic = NonHolonomic{10.0, 0.2};
    }
    scenario.filters.push_back(std::move(filter));
  }
  return scenario;
}

}  // namespace driftlab
