#include "schema/json/characterisation.hpp"

#include "core/fit/noise_equivalents.hpp"
#include "core/fit/robust_efficiency.hpp"
#include "core/variance/deviation.hpp"
#include "schema/json/quality.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/reported_channel.hpp"

namespace driftlab {
namespace {

Json allan_json(const DeviationCurve& curve, double factor) {
  Json ci95 = Json::array();
  for (const Interval& one : curve.ci95) {
    ci95.push_back(interval(one, factor));
  }
  return Json{{"tau_s", numbers(curve.tau_s)},
              {"deviation", numbers(curve.deviation, factor)},
              {"ci95", std::move(ci95)},
              {"edf", numbers(curve.edf)}};
}

/// Robust variances, null where the estimator has no root.
Json robust_json(const HaarCurve& curve, double square_factor) {
  const std::optional<double> efficiency = mean_robust_efficiency(curve);
  Json variance = Json::array();
  Json ci95 = Json::array();
  Json efficiencies = Json::array();
  for (std::size_t i = 0; i < curve.robust_variance.size(); ++i) {
    const std::optional<double>& value = curve.robust_variance[i];
    variance.push_back(value ? number(*value * square_factor) : Json(nullptr));
    ci95.push_back(value ? interval(curve.robust_ci95[i], square_factor) : Json(nullptr));
    efficiencies.push_back(value ? number(curve.robust_efficiency[i]) : Json(nullptr));
  }
  return Json{{"method", curve.robust_sample_wise ? "sample_wise" : "coefficient_wise"},
              {"variance", std::move(variance)},
              {"ci95", std::move(ci95)},
              {"efficiency", efficiency ? number(*efficiency) : Json(nullptr)},
              {"efficiency_by_scale", std::move(efficiencies)}};
}

Json haar_json(const HaarCurve& curve, double factor) {
  Json scale = Json::array();
  Json variance = Json::array();
  Json ci95 = Json::array();
  for (std::size_t i = 0; i < curve.scale.size(); ++i) {
    scale.push_back(curve.scale[i]);
    variance.push_back(number(curve.variance[i] * factor * factor));
    ci95.push_back(interval(curve.ci95[i], factor * factor));
  }
  Json document{{"scale", std::move(scale)},
                {"variance", std::move(variance)},
                {"ci95", std::move(ci95)},
                {"robust", robust_json(curve, factor * factor)}};
  if (!curve.efficiency.empty()) {
    for (const double efficiency : curve.efficiency) {
      document["efficiency_by_scale"].push_back(number(efficiency));
    }
  }
  return document;
}

Json psd_json(const PowerSpectrum& spectrum, double factor) {
  Json document{{"frequency_hz", Json::array()},
                {"density", Json::array()},
                {"ci95", Json::array()},
                {"edf", Json::array()},
                {"lines", Json::array()}};
  for (std::size_t i = 0; i < spectrum.density.size(); ++i) {
    document["frequency_hz"].push_back(number(spectrum.frequency_hz[i]));
    document["density"].push_back(number(spectrum.density[i] * factor * factor));
    document["ci95"].push_back(interval(spectrum.ci95[i], factor * factor));
    document["edf"].push_back(number(spectrum.edf[i]));
  }
  for (const SpectrumLine& line : spectrum.lines) {
    document["lines"].push_back({{"frequency_hz", number(line.frequency_hz)},
                                 {"amplitude", number(line.amplitude * factor)},
                                 {"excess", number(line.excess)}});
  }
  return document;
}

Json contamination_json(const Contamination& contamination) {
  Json document{{"verdict", contamination.verdict},
                {"p", number(contamination.p)},
                {"disjoint_scales", contamination.disjoint_scales},
                {"flagged_samples", contamination.flagged_samples},
                {"not_gaussian", contamination.not_gaussian}};
  if (contamination.bursts) {
    document["bursts"] = *contamination.bursts;
  }
  return document;
}

Json allan_parameters_json(const ReportedValues& parameters) {
  Json reasons = Json::object();
  Json document = to_json(parameters, reasons);
  document["reasons"] = std::move(reasons);
  return document;
}

/// Upper limits of the coefficients that the description does without, in the units of the field.
Json limits_json(const AllanParameters& parameters, Dimension dimension) {
  Json document = Json::object();
  const auto add = [&](const char* name, const std::optional<Estimate>& estimate, double limit, int halves) {
    const ParameterUnit unit = lab_unit(dimension, halves);
    const Json told = number(limit * unit.per_si);
    if (!estimate && !told.is_null()) {
      document[name] = Json{{"value", told}, {"unit", unit.symbol}};
    }
  };
  add("N", parameters.n, parameters.n_limit, 1);
  add("B", parameters.b, parameters.b_limit, 0);
  add("K", parameters.k, parameters.k_limit, -1);
  add("Q", parameters.q, parameters.q_limit, 2);
  add("R", parameters.r, parameters.r_limit, -2);
  return document;
}

Json description_json(const ChannelCharacterisation& channel, const Unit& unit) {
  if (!channel.description) {
    return nullptr;
  }
  const CurveDescription& description = *channel.description;
  ModelFit fit;
  fit.model = description.model;
  fit.processes = description.processes;
  return Json{{"model", description.model},
              {"verdict", description.verdict},
              {"discrepancy", number(description.discrepancy)},
              {"p", number(description.p)},
              {"parameters", description.parameters},
              {"scales", description.scales},
              {"processes", to_json(reported(fit, unit)).at("processes")},
              {"alternatives", description.alternatives},
              {"upper_limits", limits_json(channel.allan_parameters, unit.dimension)},
              {"B_tau_s", channel.allan_parameters.b ? number(channel.allan_parameters.b_tau_s) : Json(nullptr)},
              {"sentence", description.sentence}};
}

/// N and K of a fit in the numbers of other books.
Json equivalents_json(const std::vector<LevelEquivalents>& levels) {
  Json document = Json::object();
  for (const LevelEquivalents& level : levels) {
    Json all = Json::array();
    for (const NoiseEquivalent& one : level.conventions) {
      Json entry = quantity(level.level, one.factor, one.unit);
      entry["convention"] = one.convention;
      all.push_back(std::move(entry));
    }
    document[level.parameter] = std::move(all);
  }
  return document;
}

}  // namespace

namespace {

Json stationarity_json(const Stationarity& found, double dt_s, double factor, const std::string& unit) {
  Json changes = Json::array();
  for (const NoiseChange& change : found.changes) {
    const bool jump = change.kind == NoiseChange::Kind::Jump;
    changes.push_back({{"kind", jump ? "jump" : "level"},
                       {"time_s", number(change.time_s(dt_s))},
                       {"size", number(jump ? change.size * factor : change.size)},
                       {"unit", jump ? unit : "1"},
                       {"scale_s", number(change.half_s)},
                       {"statistic", number(change.statistic)}});
  }
  return {{"changes", std::move(changes)}, {"segment_s", {number(found.first_s(dt_s)), number(found.last_s(dt_s))}}};
}

Json dynamic_allan_json(const DynamicAllan& moving, double factor) {
  Json deviation = Json::array();
  for (const std::vector<double>& row : deviations_of(moving.variance)) {
    deviation.push_back(numbers(row, factor));
  }
  return {{"window_s", number(moving.window_s)},
          {"start_s", moving.start_s},
          {"tau_s", moving.tau_s},
          {"deviation", std::move(deviation)}};
}

}  // namespace

Json to_json(const ChannelIdentity& identity, const ChannelCharacterisation& channel) {
  const Unit unit = identity.role.unit.value_or(Unit{});
  const double factor = 1.0 / unit.factor;
  Json document{{"channel", identity.column},
                {"quantity", name_of(identity.role.quantity)},
                {"axis", identity.role.axis.empty() ? Json(nullptr) : Json(identity.role.axis)},
                {"unit", unit.symbol},
                {"samples", channel.samples},
                {"missing", channel.missing},
                {"dt_s", number(channel.dt_s)},
                {"mean", number(channel.mean * factor)},
                {"allan", allan_json(deviations_of(channel.allan), factor)},
                {"haar", haar_json(channel.haar, factor)},
                {"contamination", contamination_json(channel.contamination)},
                {"allan_parameters", allan_parameters_json(reported(channel.allan_parameters, unit.dimension))}};
  if (channel.further.allan) {
    document["allan_fine"] = allan_json(deviations_of(*channel.further.allan), factor);
  }
  if (channel.further.total) {
    document["total"] = allan_json(deviations_of(*channel.further.total), factor);
  }
  if (channel.further.theo1) {
    document["theo1"] = allan_json(deviations_of(*channel.further.theo1), factor);
  }
  if (channel.further.psd) {
    document["psd"] = psd_json(*channel.further.psd, factor);
  }
  document["description"] = description_json(channel, unit);
  Json fits = Json::array();
  for (const ModelFit& one : channel.fits) {
    Json fit = to_json(reported(one, unit));
    if (one.distance_2p) {
      fit["distance_2p"] = number(*one.distance_2p);
      fit["closest"] = one.closest();
    }
    fits.push_back(std::move(fit));
  }
  document["fits"] = std::move(fits);
  document["discrepancy"] = number(channel.discrepancy);
  if (channel.from_tau_s > 0.0) {
    document["from_tau_s"] = number(channel.from_tau_s);
  }
  document["equivalents"] =
      channel.fits.empty()
          ? Json::object()
          : equivalents_json(level_equivalents(channel.fits[channel.best], unit.dimension, channel.dt_s));
  document["best"] = channel.fits.empty() ? Json(nullptr) : Json(channel.best);
  if (!channel.stationarity.changes.empty()) {
    document["stationarity"] = stationarity_json(channel.stationarity, channel.dt_s, factor, unit.symbol);
  }
  if (channel.dynamic_allan) {
    document["dynamic_allan"] = dynamic_allan_json(*channel.dynamic_allan, factor);
  }
  document["warnings"] = channel.warnings;
  return document;
}

Json recording_document(const std::string& id, const RecordingSpec& spec, const Window& window,
                        std::vector<Json> channels) {
  return Json{{"id", id},
              {"condition", to_json(spec.condition)},
              {"duration_s", number(window.duration_s())},
              {"rate_hz", number(window.time.rate_hz())},
              {"quality", to_json(window.quality)},
              {"channels", std::move(channels)}};
}

bool is_characterisation(const Json& document) {
  const auto recordings = document.find("recordings");
  return recordings != document.end() && recordings->is_array() && !recordings->empty() &&
         recordings->front().is_object() && recordings->front().contains("channels");
}

Json characterisation_document(std::vector<Json> recordings) {
  return Json{{"study", nullptr}, {"recordings", std::move(recordings)}};
}

}  // namespace driftlab
