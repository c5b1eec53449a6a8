#pragma once
/// Error models that depend on the angular rate.
///
/// Radi, Nassar and El-Sheimy (2017) fit one model per dynamic condition and switch between them by the gyro's own
/// reading (their Table 5). A schedule is such a table: ascending bounds of |rate| and one model per band. A band is
/// left only when the reading is outside it by more than `hysteresis`, so that noise near a bound does not cause
/// repeated switching. Trends over the rate, in which the parameters are continuous, are schedules with narrow bands
/// (`interpolated`).
///
/// All models of a schedule consist of the same kinds of processes in the same order, so that a Kalman filter keeps its
/// states when the parameters change.
#include "core/process/model.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace driftlab {

class ModelSchedule {
 public:
  /// No error at all.
  ModelSchedule() : models_(1) {}

  /// One model whatever the rate.
  [[nodiscard]] static ModelSchedule constant(Model model);

  /// `models` has one member more than `bounds_rad_s`; band i reaches to bounds[i], the last one to infinity. Errors:
  /// InvalidArgument (numbers of models and bounds, bounds not ascending and positive, hysteresis negative or wider
  /// than half a band, models of different structure).
  [[nodiscard]] static Result<ModelSchedule> by_rate(std::vector<double> bounds_rad_s, std::vector<Model> models,
                                                     double hysteresis_rad_s);

  /// Parameters as functions of |rate|: linear between the given rates and constant beyond the ends, tabulated in bands
  /// of `step_rad_s`. The logarithm is interpolated if a parameter is positive by its declaration and in its values.
  /// Neighbouring bands differ so little that no hysteresis is needed. Errors: InvalidArgument (rates not ascending
  /// from 0 or above, models of different structure, more than 4096 bands).
  [[nodiscard]] static Result<ModelSchedule> interpolated(const std::vector<double>& rates_rad_s,
                                                          const std::vector<Model>& models, double step_rad_s);

  /// The same schedule with the processes left out for which `drop` holds in the first band's model.
  [[nodiscard]] ModelSchedule without(const std::function<bool(const Process&)>& drop) const;

  [[nodiscard]] std::size_t size() const { return models_.size(); }
  [[nodiscard]] const Model& model(std::size_t band) const { return models_[band]; }
  [[nodiscard]] const std::vector<double>& bounds_rad_s() const { return bounds_; }
  [[nodiscard]] double hysteresis_rad_s() const { return hysteresis_; }

  /// The band of |rate| by the bounds alone, as the true errors use it.
  [[nodiscard]] std::size_t band(double rate_rad_s) const;
  /// The band that a filter in band `current` selects when it reads `rate_rad_s`.
  [[nodiscard]] std::size_t next_band(std::size_t current, double rate_rad_s) const;

 private:
  std::vector<double> bounds_;
  std::vector<Model> models_;
  double hysteresis_ = 0.0;
};

}  // namespace driftlab
