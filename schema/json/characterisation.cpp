#include "schema/json/characterisation.hpp"

#include "core/fit/noise_equivalents.hpp"
#include "schema/json/recording_spec.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

Interval root(const Interval& variance) {
  return {std::sqrt(std::max(variance.low, 0.0)), std::sqrt(std::max(variance.high, 0.0))};
}

Json allan_json(const AllanCurve& curve, double factor) {
  Json tau = Json::array();
  Json deviation = Json::array();
  Json ci95 = Json::array();
  Json edf = Json::array();
  for (std::size_t i = 0; i < curve.tau_s.size(); ++i) {
    tau.push_back(number(curve.tau_s[i]));
    deviation.push_back(number(std::sqrt(curve.variance[i]) * factor));
    ci95.push_back(interval(root(curve.ci95[i]), factor));
    edf.push_back(number(curve.edf[i]));
  }
  return Json{{"tau_s", std::move(tau)},
              {"deviation", std::move(deviation)},
              {"ci95", std::move(ci95)},
              {"edf", std::move(edf)}};
}

/// Robust variances, null where the estimator has no root. `efficiency` is the mean over the scales where it has one.
Json robust_json(const HaarCurve& curve, double square_factor) {
  Json variance = Json::array();
  Json ci95 = Json::array();
  Json efficiencies = Json::array();
  double sum = 0.0;
  int defined = 0;
  for (std::size_t i = 0; i < curve.robust_variance.size(); ++i) {
    const std::optional<double>& value = curve.robust_variance[i];
    variance.push_back(value ? number(*value * square_factor) : Json(nullptr));
    ci95.push_back(value ? interval(curve.robust_ci95[i], square_factor) : Json(nullptr));
    efficiencies.push_back(value ? number(curve.robust_efficiency[i]) : Json(nullptr));
    sum += value ? curve.robust_efficiency[i] : 0.0;
    defined += value ? 1 : 0;
  }
  return Json{{"method", curve.robust_sample_wise ? "sample_wise" : "coefficient_wise"},
              {"variance", std::move(variance)},
              {"ci95", std::move(ci95)},
              {"efficiency", defined > 0 ? number(sum / defined) : Json(nullptr)},
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

Json contamination_json(const Contamination& contamination) {
  return Json{{"verdict", contamination.verdict},
              {"p", number(contamination.p)},
              {"disjoint_scales", contamination.disjoint_scales},
              {"flagged_samples", contamination.flagged_samples},
              {"not_gaussian", contamination.not_gaussian}};
}

Json allan_parameters_json(const AllanParameters& parameters, Dimension dimension) {
  struct Entry {
    const char* name;
    int second_power_halves;
    const std::optional<Estimate>& estimate;
    const std::string& reason;
  };
  const Entry entries[] = {{"N", 1, parameters.n, parameters.n_reason},
                           {"B", 0, parameters.b, parameters.b_reason},
                           {"K", -1, parameters.k, parameters.k_reason},
                           {"Q", 2, parameters.q, parameters.q_reason},
                           {"R", -2, parameters.r, parameters.r_reason}};
  Json document = Json::object();
  Json reasons = Json::object();
  for (const Entry& entry : entries) {
    const ParameterUnit unit = lab_unit(dimension, entry.second_power_halves);
    document[entry.name] = entry.estimate ? quantity(*entry.estimate, unit.per_si, unit.symbol) : Json(nullptr);
    if (!entry.estimate) {
      reasons[entry.name] = entry.reason;
    }
  }
  document["reasons"] = std::move(reasons);
  return document;
}

ParameterUnit unit_of(const FittedParameter& parameter, Dimension channel) {
  if (parameter.channel_power == 0) {
    return lab_unit(Dimension::One, parameter.second_power_halves);
  }
  return lab_unit(channel, parameter.second_power_halves);
}

Json process_json(const FittedProcess& process, Dimension dimension) {
  Json params = Json::object();
  Json reasons = Json::object();
  for (const FittedParameter& parameter : process.parameters) {
    const ParameterUnit unit = unit_of(parameter, dimension);
    params[parameter.name] =
        parameter.estimate ? quantity(*parameter.estimate, unit.per_si, unit.symbol) : Json(nullptr);
    if (!parameter.estimate) {
      reasons[parameter.name] = parameter.reason;
    }
  }
  Json document{{"process", process.process}, {"params", std::move(params)}};
  if (!reasons.empty()) {
    document["reasons"] = std::move(reasons);
  }
  return document;
}

/// N and K of the best model in the numbers of other books.
Json equivalents_json(const ChannelCharacterisation& channel, Dimension dimension) {
  Json document = Json::object();
  for (const FittedProcess& process : channel.fits[channel.best].processes) {
    const FittedParameter& level = process.parameters.front();
    const bool white = process.process == "white_noise";
    if (!level.estimate || (!white && process.process != "random_walk")) {
      continue;
    }
    Json all = Json::array();
    for (const NoiseEquivalent& one :
         white ? white_noise_equivalents(dimension, channel.dt_s) : random_walk_equivalents(dimension, channel.dt_s)) {
      Json entry = quantity(*level.estimate, one.factor, one.unit);
      entry["convention"] = one.convention;
      all.push_back(std::move(entry));
    }
    document[level.name] = std::move(all);
  }
  return document;
}

}  // namespace

Json to_json(const ModelFit& fit, const Unit& unit) {
  Json processes = Json::array();
  for (const FittedProcess& process : fit.processes) {
    processes.push_back(process_json(process, unit.dimension));
  }
  Json document{{"model", fit.model},
                {"robust", fit.robust},
                {"processes", std::move(processes)},
                {"objective", number(fit.objective)},
                {"wic", number(fit.wic)},
                {"equation_8", number(fit.eq8)},
                {"optimism", number(fit.optimism)},
                {"condition_number", number(fit.condition_number)},
                {"bounds_active", fit.bounds_active},
                {"intervals", fit.intervals},
                {"plausible", fit.plausible}};
  document["j_test"] = fit.j_test ? Json{{"statistic", number(fit.j_test->statistic)},
                                         {"dof", number(fit.j_test->dof)},
                                         {"p", number(fit.j_test->p)}}
                                  : Json(nullptr);
  document["status"] = fit.status;
  document["warnings"] = fit.warnings;
  return document;
}

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
                {"allan", allan_json(channel.allan, factor)},
                {"haar", haar_json(channel.haar, factor)},
                {"contamination", contamination_json(channel.contamination)},
                {"allan_parameters", allan_parameters_json(channel.allan_parameters, unit.dimension)}};
  Json fits = Json::array();
  for (const ModelFit& fit : channel.fits) {
    fits.push_back(to_json(fit, unit));
  }
  document["fits"] = std::move(fits);
  document["equivalents"] = channel.fits.empty() ? Json::object() : equivalents_json(channel, unit.dimension);
  document["best"] = channel.fits.empty() ? Json(nullptr) : Json(channel.best);
  document["warnings"] = channel.warnings;
  return document;
}

Json recording_document(const std::string& id, const RecordingSpec& spec, const Window& window,
                        std::vector<Json> channels) {
  return Json{{"id", id},
              {"condition", to_json(spec.condition)},
              {"duration_s", number(static_cast<double>(window.count + window.quality.missing) * window.time.dt_s)},
              {"rate_hz", number(1.0 / window.time.dt_s)},
              {"quality", to_json(window.quality)},
              {"channels", std::move(channels)}};
}

Json characterisation_document(std::vector<Json> recordings) {
  return Json{{"study", nullptr}, {"recordings", std::move(recordings)}};
}

}  // namespace driftlab
