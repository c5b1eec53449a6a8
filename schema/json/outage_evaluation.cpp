#include "schema/json/outage_evaluation.hpp"

#include "core/navigate/outage_progress.hpp"
#include "core/signal/angle.hpp"
#include "schema/json/outage_scenario.hpp"
#include "schema/json/partial_outages.hpp"
#include "schema/json/rounded.hpp"
#include "schema/json/stored_channel.hpp"

#include <algorithm>

namespace driftlab {
namespace {

Json ellipse(const ErrorEllipse& axes) {
  return Json{{"fraction", axes.fraction},
              {"semi_major_m", number(axes.semi_major_m)},
              {"semi_minor_m", number(axes.semi_minor_m)},
              {"major_axis_azimuth_deg", number(axes.azimuth_rad / kDegree)}};
}

Json moments(const PlaneCovariance& p) {
  const auto [half, most] = error_ellipses(p);
  return Json{{"north_m2", number(p.north)},
              {"east_m2", number(p.east)},
              {"north_east_m2", number(p.north_east)},
              {"ellipses", Json{ellipse(half), ellipse(most)}}};
}

Json path_json(const OutagePath& path) {
  const auto list = [](const std::vector<double>& values) {
    Json out = Json::array();
    for (const double value : values) {
      out.push_back(rounded(value, 3));  // millimetres
    }
    return out;
  };
  return Json{{"time_s", list(path.time_s)}, {"north_m", list(path.north_m)}, {"east_m", list(path.east_m)}};
}

/// Evenly spaced points in centimetres.
Json track_json(const OutagePath& track) {
  const auto list = [](const std::vector<double>& values) {
    Json out = Json::array();
    for (const double value : values) {
      out.push_back(rounded(value, 2));
    }
    return out;
  };
  return Json{{"start_s", track.time_s.empty() ? Json(nullptr) : number(track.time_s.front())},
              {"rate_hz", number(kTrackRateHz)},
              {"north_m", list(track.north_m)},
              {"east_m", list(track.east_m)}};
}

Json outage_json(const OutageSummary& outage) {
  Json north = Json::array();
  Json east = Json::array();
  for (const auto& point : outage.scatter) {
    north.push_back(rounded(point[0], 3));
    east.push_back(rounded(point[1], 3));
  }
  return Json{{"index", outage.index},
              {"start_s", number(outage.start_s)},
              {"end_s", number(outage.end_s)},
              {"error_m", quantity(outage.error_m, 1.0, "m")},
              {"rms_m", number(outage.rms_m)},
              {"median_m", number(outage.median_m)},
              {"p95_m", number(outage.p95_m)},
              {"nees", number(outage.nees.value)},
              {"nees_ci95", interval(outage.nees.ci95)},
              {"coverage50", number(outage.coverage50)},
              {"coverage95", number(outage.coverage95)},
              {"heading_rms_deg", number(outage.heading_rms_rad / kDegree)},
              {"tilt_rms_deg", number(outage.tilt_rms_rad / kDegree)},
              {"mean_error_m", {{"north", number(outage.mean_north_m)}, {"east", number(outage.mean_east_m)}}},
              {"predicted", moments(outage.predicted)},
              {"actual", moments(outage.actual)},
              {"errors", {{"north_m", std::move(north)}, {"east_m", std::move(east)}}},
              {"track", track_json(outage.track)}};
}

Json filter_json(const FilterEvaluation& filter) {
  Json outages = Json::array();
  for (const OutageSummary& outage : filter.outages) {
    outages.push_back(outage_json(outage));
  }
  return Json{{"name", filter.name},
              {"about", filter.about},
              {"states", filter.states},
              {"mean_error_m", quantity(filter.mean_error_m, 1.0, "m")},
              {"outages", std::move(outages)},
              {"nees", number(filter.nees.value)},
              {"nees_ci95", interval(filter.nees.ci95)},
              {"coverage50", number(filter.coverage50)},
              {"coverage95", number(filter.coverage95)},
              {"heading_rms_deg", number(filter.heading_rms_rad / kDegree)},
              {"tilt_rms_deg", number(filter.tilt_rms_rad / kDegree)},
              {"trajectory", path_json(filter.path)}};
}

Json pair_json(const PairedDifference& pair) {
  Json outages = Json::array();
  for (const Estimate& difference : pair.by_outage_m) {
    outages.push_back(quantity(difference, 1.0, "m"));
  }
  return Json{{"filter", pair.filter},
              {"against", pair.against},
              {"difference_m", quantity(pair.difference_m, 1.0, "m")},
              {"relative", quantity(pair.relative, 1.0, "1")},
              {"outages", std::move(outages)}};
}

}  // namespace

Json to_json(const OutageReport& report) {
  const OutageEvaluation& evaluation = report.evaluation;
  Json filters = Json::array();
  for (const FilterEvaluation& filter : evaluation.filters) {
    filters.push_back(filter_json(filter));
  }
  Json paired = Json::array();
  for (const PairedDifference& pair : evaluation.paired) {
    paired.push_back(pair_json(pair));
  }
  Json attribution(nullptr);
  if (const auto& parts = report.attribution) {
    attribution = Json{{"total", pair_json(parts->total)},
                       {"low_frequency_noise", pair_json(parts->low_frequency_noise)},
                       {"gauss_markov_states", pair_json(parts->gauss_markov_states)},
                       {"switching", pair_json(parts->switching)},
                       {"switching_av", pair_json(parts->switching_av)}};
  }
  Json claims = Json::array();
  for (const Claim& claim : report.claims) {
    claims.push_back(Json{{"claim", claim.claim}, {"supported", claim.supported}, {"because", claim.because}});
  }
  Json tracks = Json::array();
  for (const OutagePath& track : evaluation.true_tracks) {
    tracks.push_back(track_json(track));
  }
  return Json{{"scenario", to_json(report.scenario)},
              {"summary", to_json(report.summary)},
              {"runs", evaluation.runs},
              {"seed", evaluation.seed},
              {"stopped_early", evaluation.stopped_early},
              {"algorithm_version", kOutageAlgorithmVersion},
              {"filters", std::move(filters)},
              {"paired", std::move(paired)},
              {"attribution", std::move(attribution)},
              {"claims", std::move(claims)},
              {"trajectory", path_json(evaluation.truth)},
              {"tracks", std::move(tracks)}};
}

OutageOptions outage_options_from_json(const Json& parameters, const std::string& pointer, Faults& faults) {
  OutageOptions options;
  ObjectReader reader(parameters, pointer, faults);
  const std::int64_t runs = reader.integer("runs").value_or(options.runs);
  const std::int64_t seed = reader.integer("seed").value_or(1);
  options.relative_precision = reader.real("relative_precision").value_or(0.0);
  reader.reject_unknown();
  if (runs < 2 || runs > 100000) {
    faults.add(pointer + "/runs", ErrorCode::InvalidArgument, "The runs are a whole number from 2 to 100000.");
  }
  if (seed < 0) {
    faults.add(pointer + "/seed", ErrorCode::InvalidArgument, "The seed is a whole number from 0.");
  } else {
    options.seed = static_cast<std::uint64_t>(seed);
  }
  if (!(options.relative_precision >= 0.0 && options.relative_precision < 1.0)) {
    faults.add(pointer + "/relative_precision", ErrorCode::InvalidArgument, "The precision lies from 0 to below 1.");
  }
  options.runs = static_cast<int>(within(runs, 2, 100000));
  return options;
}

Json to_json(const OutageOptions& options) {
  return Json{
      {"runs", options.runs}, {"seed", options.seed}, {"relative_precision", number(options.relative_precision)}};
}

Json partial_outages_json(std::string_view stage) {
  const auto known = outages_so_far(stage);
  if (!known) {
    return nullptr;
  }
  Json filters = Json::array();
  for (const OutagesSoFar::Filter& filter : known->filters) {
    filters.push_back(Json{{"name", filter.name}, {"error_m", quantity(filter.error_m, 1.0, "m")}});
  }
  return Json{{"runs", known->runs}, {"filters", std::move(filters)}};
}

}  // namespace driftlab
