#include "core/navigate/model_schedule.hpp"

#include "core/process/process.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace driftlab {
namespace {

constexpr std::size_t kMostBands = 4096;

tl::unexpected<Error> bad(std::string why) {
  return fail(ErrorCode::InvalidArgument, std::move(why), {{"parameter", "schedule"}});
}

bool same_structure(const Model& a, const Model& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Process& x, const Process& y) { return x.kind == y.kind; });
}

bool all_same_structure(const std::vector<Model>& models) {
  return std::all_of(models.begin(), models.end(), [&](const Model& m) { return same_structure(m, models.front()); });
}

/// At fraction u between two models of one structure.
Model blend(const Model& a, const Model& b, double u) {
  Model mixed = a;
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (std::size_t p = 0; p < a[k].parameters.size(); ++p) {
      const double low = a[k].parameters[p];
      const double high = b[k].parameters[p];
      const bool positive = a[k].kind->parameters[p].transform == ParameterTransform::Log && low > 0.0 && high > 0.0;
      mixed[k].parameters[p] =
          positive ? std::exp((1.0 - u) * std::log(low) + u * std::log(high)) : (1.0 - u) * low + u * high;
    }
  }
  return mixed;
}

}  // namespace

ModelSchedule ModelSchedule::constant(Model model) {
  ModelSchedule schedule;
  schedule.models_ = {std::move(model)};
  return schedule;
}

Result<ModelSchedule> ModelSchedule::by_rate(std::vector<double> bounds_rad_s, std::vector<Model> models,
                                             double hysteresis_rad_s) {
  if (models.empty() || models.size() != bounds_rad_s.size() + 1 || models.size() > kMostBands) {
    return bad("A schedule has one model more than it has bounds, and at most 4096.");
  }
  double before = 0.0;
  for (const double bound : bounds_rad_s) {
    if (!(bound > before && std::isfinite(bound))) {
      return bad("The bounds of a schedule are positive and ascend.");
    }
    if (hysteresis_rad_s > 0.5 * (bound - before)) {
      return bad("The hysteresis of a schedule is at most half of its narrowest band.");
    }
    before = bound;
  }
  if (!(hysteresis_rad_s >= 0.0)) {
    return bad("The hysteresis of a schedule is not negative.");
  }
  if (!all_same_structure(models)) {
    return bad("All models of a schedule hold the same kinds of processes in the same order.");
  }
  ModelSchedule schedule;
  schedule.bounds_ = std::move(bounds_rad_s);
  schedule.models_ = std::move(models);
  schedule.hysteresis_ = hysteresis_rad_s;
  return schedule;
}

Result<ModelSchedule> ModelSchedule::interpolated(const std::vector<double>& rates_rad_s,
                                                  const std::vector<Model>& models, double step_rad_s) {
  if (models.empty() || models.size() != rates_rad_s.size() || !all_same_structure(models)) {
    return bad("A trend has one rate per model, and its models have one structure.");
  }
  for (std::size_t i = 0; i < rates_rad_s.size(); ++i) {
    if (!(rates_rad_s[i] >= 0.0 && std::isfinite(rates_rad_s[i]) && (i == 0 || rates_rad_s[i] > rates_rad_s[i - 1]))) {
      return bad("The rates of a trend are not negative and ascend.");
    }
  }
  const double span = rates_rad_s.back();
  if (!(step_rad_s > 0.0) || span / step_rad_s > static_cast<double>(kMostBands - 2)) {
    return bad("A trend is tabulated in at most 4096 steps.");
  }
  const auto bands = static_cast<std::size_t>(std::ceil(span / step_rad_s)) + 1;
  ModelSchedule schedule;
  schedule.models_.clear();
  for (std::size_t band = 0; band < bands; ++band) {
    // Band 0 is centred on 0 and half as wide; the last one holds the last rate and all above.
    const double rate = std::min(static_cast<double>(band) * step_rad_s, span);
    const auto above = std::upper_bound(rates_rad_s.begin(), rates_rad_s.end(), rate);
    if (above == rates_rad_s.begin() || above == rates_rad_s.end()) {
      schedule.models_.push_back(above == rates_rad_s.begin() ? models.front() : models.back());
    } else {
      const auto i = static_cast<std::size_t>(above - rates_rad_s.begin()) - 1;
      const double u = (rate - rates_rad_s[i]) / (rates_rad_s[i + 1] - rates_rad_s[i]);
      schedule.models_.push_back(blend(models[i], models[i + 1], u));
    }
    if (band + 1 < bands) {
      schedule.bounds_.push_back((static_cast<double>(band) + 0.5) * step_rad_s);
    }
  }
  return schedule;
}

ModelSchedule ModelSchedule::without(const std::function<bool(const Process&)>& drop) const {
  ModelSchedule rest = *this;
  for (std::size_t k = models_.front().size(); k-- > 0;) {
    if (drop(models_.front()[k])) {
      for (Model& model : rest.models_) {
        model.erase(model.begin() + static_cast<std::ptrdiff_t>(k));
      }
    }
  }
  return rest;
}

std::size_t ModelSchedule::band(double rate_rad_s) const {
  const auto above = std::upper_bound(bounds_.begin(), bounds_.end(), std::fabs(rate_rad_s));
  return static_cast<std::size_t>(above - bounds_.begin());
}

std::size_t ModelSchedule::next_band(std::size_t current, double rate_rad_s) const {
  const double rate = std::fabs(rate_rad_s);
  const bool above = current < bounds_.size() && rate > bounds_[current] + hysteresis_;
  const bool below = current > 0 && rate < bounds_[current - 1] - hysteresis_;
  return above || below ? band(rate) : current;
}

}  // namespace driftlab
