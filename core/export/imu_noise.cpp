#include "core/export/imu_noise.hpp"

#include "core/campaign/replicates.hpp"
#include "core/campaign/table_cells.hpp"
#include "core/export/exportable_columns.hpp"
#include "core/fit/fit_report.hpp"
#include "core/process/model.hpp"
#include "core/signal/condition.hpp"
#include "core/signal/number.hpp"
#include "core/signal/significant.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace driftlab {
namespace {

/// A Gauss-Markov process that forgets within fewer sample intervals is no bias (core/export/imu_noise.hpp).
constexpr double kFewestBiasSteps = 10.0;

std::optional<double> times(const std::optional<double>& value, double factor) {
  return value ? std::optional(*value * factor) : std::nullopt;
}

std::optional<double> square(const std::optional<double>& value) { return value ? times(value, *value) : value; }

std::optional<double> finite(double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; }

NoiseFigure without(std::string reason) {
  NoiseFigure figure;
  figure.remark = std::move(reason);
  return figure;
}

NoiseFigure figure_of(const Estimate& estimate, std::string remark) {
  return {estimate.value, finite(estimate.ci95.low), finite(estimate.ci95.high), false, std::move(remark)};
}

/// A level of a fit, or its upper limit where the data do not identify it.
NoiseFigure figure_of(const FittedParameter& parameter, const std::string& model) {
  if (parameter.estimate) {
    return figure_of(*parameter.estimate, "joint fit " + model);
  }
  if (std::isfinite(parameter.upper_limit) && parameter.upper_limit > 0.0) {
    return {parameter.upper_limit, std::nullopt, std::nullopt, true,
            "not identified by the fit " + model + ", this is the upper limit at 95 %"};
  }
  return without("The fit " + model + " does not identify it. " + parameter.reason);
}

const FittedParameter* find(const ModelFit& fit, std::string_view process, std::string_view name) {
  for (const FittedProcess& one : fit.processes) {
    if (one.kind != nullptr && one.kind->name == process) {
      for (const FittedParameter& parameter : one.parameters) {
        if (parameter.declared->name == name) {
          return &parameter;
        }
      }
    }
  }
  return nullptr;
}

/// The joint fit of a model to the recordings of an axis; empty where no component of it is there.
std::optional<ModelFit> fit_of(Replicates& stack, const std::string& model) {
  const auto structure = parse_model(model);
  if (!structure || structure->parameter_count() > stack.rows()) {
    return std::nullopt;
  }
  Candidate candidate = stack.fit(*structure);
  if (candidate.log_fit == nullptr) {
    return std::nullopt;
  }
  return stack.report(candidate, IntervalMethod::Profile);
}

/// The coefficient N of the recordings, averaged, in SI.
NoiseFigure reported_density(const std::vector<const TableSource*>& sources, Dimension dimension) {
  std::vector<ReportedValue> values;
  for (const TableSource* source : sources) {
    for (auto& [name, cell] : allan_cells(source->channel)) {
      if (name == "N") {
        values.push_back(std::move(cell));
      }
    }
  }
  const ReportedValue cell = averaged(values);
  if (!cell.value) {
    return without(cell.reason);
  }
  const NoiseFigure lab{cell.value, cell.low, cell.high, false, "density at low frequencies"};
  return lab.scaled(1.0 / lab_unit(dimension, 1).per_si);
}

void add_walk(Replicates& stack, AxisNoise& axis) {
  const auto fit = fit_of(stack, "WN+RW");
  const FittedParameter* const walk = fit ? find(*fit, "random_walk", "K") : nullptr;
  const FittedParameter* const white = fit ? find(*fit, "white_noise", "N") : nullptr;
  axis.walk = walk != nullptr ? figure_of(*walk, "WN+RW") : without("The model WN+RW has no fit to this recording.");
  if (!axis.density.value && white != nullptr && white->estimate) {
    axis.density =
        figure_of(*white->estimate, "white noise of the fit WN+RW, for the density at low frequencies is refused: " +
                                        axis.density.remark);
  }
}

/// The walk as a Gauss-Markov process of the record's length T: its variance grows by 2 sigma^2 / T = K^2 a second at
/// first.
void add_markov_from_walk(AxisNoise& axis) {
  const std::string why =
      "the fit WN+GM does not identify a Gauss-Markov bias, the random walk K stands for it, with the length of the "
      "record as "
      "its correlation time";
  if (!axis.walk.value) {
    axis.bias_sd = without("Neither the fit WN+GM nor WN+RW identifies a bias that moves. " + axis.walk.remark);
    axis.correlation_s = axis.bias_sd;
    return;
  }
  axis.bias_sd = axis.walk.scaled(std::sqrt(0.5 * axis.duration_s));
  axis.bias_sd.remark = why;
  axis.correlation_s = {axis.duration_s, std::nullopt, std::nullopt, false, why};
}

/// `4.12 ms` or `2.5 s`.
std::string duration_text(double seconds) {
  return seconds < 1.0 ? significant(1e3 * seconds) + " ms" : significant(seconds) + " s";
}

/// Why the process of the fit `WN+GM` is no bias; empty: it is one.
std::string no_bias(const AxisNoise& axis, double sigma, double time_s) {
  const double steps = time_s * axis.rate_hz;
  if (steps >= kFewestBiasSteps) {
    return "";
  }
  const double at_zero = 2.0 * sigma * sigma * time_s;  // its density at frequency zero
  const bool held = axis.density.value && *axis.density.value * *axis.density.value >= 0.5 * at_zero;
  return "The process that the fit WN+GM finds has a correlation time of " + duration_text(time_s) + ", " +
         significant(steps) + " sample intervals: so fast it is noise of the readings and no bias, which must last " +
         "for " + short_text(kFewestBiasSteps) + " of them." +
         (held ? " The density at low frequencies holds what it adds." : "");
}

std::optional<double> inverse(double rate) {
  return rate > 0.0 && std::isfinite(rate) ? std::optional(1.0 / rate) : std::nullopt;
}

void add_markov(Replicates& stack, AxisNoise& axis) {
  const auto fit = fit_of(stack, "WN+GM");
  const FittedParameter* const sigma = fit ? find(*fit, "gauss_markov", "sigma") : nullptr;
  const FittedParameter* const beta = fit ? find(*fit, "gauss_markov", "beta") : nullptr;
  const bool identified = sigma != nullptr && beta != nullptr && sigma->estimate && beta->estimate;
  if (!identified || !(beta->estimate->value * axis.duration_s > 1.0)) {
    add_markov_from_walk(axis);
    return;
  }
  const Estimate& rate = *beta->estimate;
  if (const std::string why = no_bias(axis, sigma->estimate->value, 1.0 / rate.value); !why.empty()) {
    axis.bias_sd = axis.correlation_s = without(why);
    return;
  }
  axis.bias_sd = figure_of(*sigma->estimate, "joint fit WN+GM");
  axis.correlation_s = {1.0 / rate.value, inverse(rate.ci95.high), inverse(rate.ci95.low), false, "joint fit WN+GM"};
}

/// The recordings at rest, or those of the first condition there is.
std::vector<const TableSource*> chosen(const std::vector<TableSource>& sources) {
  std::optional<Condition> best;
  std::vector<const TableSource*> found;
  for (const TableSource& source : sources) {
    const Condition condition = parse_condition(source.condition).value_or(Condition{});
    if (!best || comes_before(condition, *best)) {
      best = condition;
      found.clear();
    }
    if (!comes_before(*best, condition)) {
      found.push_back(&source);
    }
  }
  return found;
}

AxisNoise axis_noise(const SensorSources& sensor, const std::vector<const TableSource*>& sources) {
  AxisNoise axis;
  axis.axis = sources.front()->channel.axis;
  axis.channel = sources.front()->channel.channel;
  axis.rate_hz = 1.0 / sources.front()->channel.dt_s;
  std::vector<WaveletRecord> records;
  for (const TableSource* source : sources) {
    const ReportedChannel& channel = source->channel;
    records.push_back(record_of(channel));
    axis.duration_s = std::max(axis.duration_s, static_cast<double>(channel.samples + channel.missing) * channel.dt_s);
  }
  axis.density = reported_density(sources, sources.front()->channel.parsed_unit().dimension);
  auto stack = Replicates::stack(records);
  if (!stack) {
    const NoiseFigure none = without(stack.error().message);
    axis.walk = axis.bias_sd = axis.correlation_s = none;
    return axis;
  }
  add_walk(*stack, axis);
  add_markov(*stack, axis);
  if (sensor.axis.empty()) {
    axis.axis.clear();
  }
  return axis;
}

/// `noise.missing`: what is left out, and why.
void add_axis(const SensorSources& sensor, ImuNoise& imu, SensorNoise& noise) {
  if (const std::string why = unit_conflict(sensor.sources); !why.empty()) {
    noise.missing += (noise.missing.empty() ? "" : " ") + why;
    return;
  }
  const std::vector<const TableSource*> sources = chosen(sensor.sources);
  if (imu.condition.empty()) {
    imu.condition = label(parse_condition(sources.front()->condition).value_or(Condition{}));
  }
  for (const TableSource* source : sources) {
    if (std::find(imu.recordings.begin(), imu.recordings.end(), source->recording_id) == imu.recordings.end()) {
      imu.recordings.push_back(source->recording_id);
    }
  }
  noise.axes.push_back(axis_noise(sensor, sources));
}

ExportColumn column_of(const SensorSources& sensor) {
  const ReportedChannel& first = sensor.sources.front().channel;
  return {first.channel, parse_quantity(sensor.quantity).value_or(Quantity::Unspecified), first.axis,
          first.parsed_unit().dimension};
}

void conclude(SensorNoise& noise, const char* name) {
  std::sort(noise.axes.begin(), noise.axes.end(), [](const AxisNoise& a, const AxisNoise& b) {
    return std::pair(a.axis.empty(), a.axis + a.channel) < std::pair(b.axis.empty(), b.axis + b.channel);
  });
  if (noise.axes.empty() && noise.missing.empty()) {
    noise.missing = std::string("No column is known to be ") + name + ".";
  }
}

}  // namespace

NoiseFigure NoiseFigure::scaled(double factor) const {
  NoiseFigure figure = *this;
  figure.value = times(value, factor);
  figure.low = times(low, factor);
  figure.high = times(high, factor);
  return figure;
}

NoiseFigure NoiseFigure::squared() const {
  NoiseFigure figure = *this;
  figure.value = square(value);
  figure.low = square(low);
  figure.high = square(high);
  return figure;
}

Result<ImuNoise> imu_noise_of(const std::string& device, const std::vector<SensorSources>& sensors,
                              const RunControl& control) {
  std::vector<ExportColumn> columns;
  std::transform(sensors.begin(), sensors.end(), std::back_inserter(columns), column_of);
  if (auto checked = check_exportable(columns); !checked) {
    return fail(std::move(checked.error()));
  }
  ImuNoise imu;
  imu.device = device;
  imu.gyroscope.missing = missing_units(columns, Quantity::AngularRate);
  imu.accelerometer.missing = missing_units(columns, Quantity::SpecificForce);
  std::size_t done = 0;
  for (const SensorSources& sensor : sensors) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The export was cancelled.");
    }
    control.report("models for export", static_cast<double>(done++) / static_cast<double>(sensors.size()));
    if (const ExportColumn column = column_of(sensor); column.exportable()) {
      add_axis(sensor, imu, column.quantity == Quantity::AngularRate ? imu.gyroscope : imu.accelerometer);
    }
  }
  conclude(imu.gyroscope, "a gyroscope");
  conclude(imu.accelerometer, "an accelerometer");
  if (imu.gyroscope.axes.empty() && imu.accelerometer.axes.empty()) {
    return fail(ErrorCode::NotFound,
                "There is nothing to export: " + imu.gyroscope.missing + " " + imu.accelerometer.missing);
  }
  imu.rate_hz =
      imu.gyroscope.axes.empty() ? imu.accelerometer.axes.front().rate_hz : imu.gyroscope.axes.front().rate_hz;
  return imu;
}

}  // namespace driftlab
