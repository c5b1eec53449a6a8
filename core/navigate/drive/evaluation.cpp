#include "core/navigate/drive/evaluation.hpp"

#include "core/process/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace driftlab::drive {
namespace {

constexpr double kNaturalIntervals = 3.0;

double mean_over(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<NaturalOutage> natural_outages(const Drive& drive) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < drive.fixes.size(); ++i) {
    steps.push_back(drive.fixes[i].time_s - drive.fixes[i - 1].time_s);
  }
  const double usual = middle_of(steps);
  std::vector<NaturalOutage> natural;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] > kNaturalIntervals * usual) {
      natural.push_back({drive.fixes[i].time_s, steps[i]});
    }
  }
  return natural;
}

void turn_heading(NavigationState& state, double by_rad) {
  if (by_rad != 0.0) {
    const Vector3 down = ned_axes(state.position_ecef_m).col(2);
    state.attitude = rotation(by_rad * down) * state.attitude;
  }
}

/// Mean over components of the correlation of normalised innovations `lag_s` apart.
double correlation_at(const std::vector<const Innovation*>& list, double lag_s, double tolerance_s) {
  double product = 0.0;
  double square = 0.0;
  double pairs = 0.0;
  double singles = 0.0;
  std::size_t later = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    later = std::max(later, i + 1);
    while (later < list.size() && list[later]->time_s < list[i]->time_s + lag_s - tolerance_s) {
      ++later;
    }
    const bool paired = later < list.size() && list[later]->time_s <= list[i]->time_s + lag_s + tolerance_s;
    for (int k = 0; k < std::min(list[i]->count, 2); ++k) {
      const ScalarInnovation& a = list[i]->scalar[static_cast<std::size_t>(k)];
      const double x = a.value / std::sqrt(a.variance);
      square += x * x;
      singles += 1.0;
      if (paired) {
        const ScalarInnovation& b = list[later]->scalar[static_cast<std::size_t>(k)];
        product += x * b.value / std::sqrt(b.variance);
        pairs += 1.0;
      }
    }
  }
  return pairs > 0.0 && square > 0.0 ? (product / pairs) / (square / singles) : 0.0;
}

std::vector<InnovationSummary> summarise_innovations(const std::vector<Innovation>& innovations) {
  std::vector<InnovationSummary> summaries;
  for (const MeasurementKind kind :
       {MeasurementKind::Position, MeasurementKind::Velocity, MeasurementKind::Constraint,
        MeasurementKind::ZeroVelocity, MeasurementKind::ZeroTurn, MeasurementKind::Odometer}) {
    InnovationSummary summary;
    summary.kind = kind;
    std::vector<const Innovation*> list;
    for (const Innovation& innovation : innovations) {
      if (innovation.kind != kind) {
        continue;
      }
      list.push_back(&innovation);
      for (int k = 0; k < std::min(innovation.count, 2); ++k) {  // horizontal; right and down of a constraint
        const ScalarInnovation& scalar = innovation.scalar[static_cast<std::size_t>(k)];
        ++summary.count;
        summary.rms += scalar.value * scalar.value;
        summary.stated_rms += scalar.variance;
        summary.normalised += scalar.value * scalar.value / scalar.variance;
      }
    }
    if (list.size() < 8) {
      continue;
    }
    const double many = static_cast<double>(summary.count);
    summary.rms = std::sqrt(summary.rms / many);
    summary.stated_rms = std::sqrt(summary.stated_rms / many);
    summary.normalised /= many;
    const double step = (list.back()->time_s - list.front()->time_s) / static_cast<double>(list.size() - 1);
    summary.correlation_next = correlation_at(list, step, 0.5 * step);
    summary.correlation_1s = correlation_at(list, std::max(1.0, step), 0.5 * step);
    summary.correlation_4s = correlation_at(list, std::max(4.0, step), 0.5 * step);
    summaries.push_back(summary);
  }
  return summaries;
}

std::string seconds(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g s", value);
  return text.data();
}

/// A sentence on stated starts of outages that were not scored; empty where all were.
std::string left_out_of_plan(const PreparedDrive& prepared, const std::vector<DurationSummary>& durations) {
  const OutagePlan& plan = prepared.drive().document.outages;
  std::string list;
  for (const double at : plan.at_s) {
    for (const double duration : plan.duration_s) {
      const bool scored = std::any_of(durations.begin(), durations.end(), [&](const DurationSummary& one) {
        return one.duration_s == duration &&
               std::any_of(one.outages.begin(), one.outages.end(),
                           [&](const DriveOutage& outage) { return outage.outage.start_s == at; });
      });
      if (!scored) {
        list += (list.empty() ? "" : ", ") + seconds(duration) + " from " + seconds(at);
      }
    }
  }
  return list.empty() ? list
                      : "Not scored, for the filter has not begun there, an outage before it ends less than 20 s "
                        "earlier, or no reference lies at an end: outages of " +
                            list + ".";
}

}  // namespace

std::vector<PlannedRun> plan_outages(const Drive& drive, const Start& start) {
  const OutagePlan& plan = drive.document.outages;
  const UniformRun& run = drive.runs[start.run];
  const auto counts = [&](const Outage& outage) {
    return outage.start_s > start.time_s && outage.end_s() < run.end_s() &&
           reference_at(drive.reference, outage.start_s) && reference_at(drive.reference, outage.end_s());
  };
  std::vector<PlannedRun> runs;
  for (std::size_t d = 0; d < plan.duration_s.size(); ++d) {
    const double duration = plan.duration_s[d];
    if (!plan.at_s.empty()) {
      PlannedRun planned{d, 0, {}};
      for (const double at : plan.at_s) {
        const Outage outage{at, duration};
        const bool apart = planned.outages.empty() || at >= planned.outages.back().end_s() + 20.0;
        if (apart && counts(outage)) {
          planned.outages.push_back(outage);
        }
      }
      runs.push_back(std::move(planned));
      continue;
    }
    const double every = plan.every_s[d];
    for (int phase = 0; phase < plan.phases; ++phase) {
      PlannedRun planned{d, static_cast<std::size_t>(phase), {}};
      const double first = start.time_s + plan.settle_s + every * phase / plan.phases;
      for (int k = 0;; ++k) {
        const Outage outage{first + k * every, duration};
        if (outage.end_s() >= run.end_s()) {
          break;
        }
        if (counts(outage)) {
          planned.outages.push_back(outage);
        }
      }
      runs.push_back(std::move(planned));
    }
  }
  std::erase_if(runs, [](const PlannedRun& planned) { return planned.outages.empty(); });
  return runs;
}

Result<PreparedDrive> PreparedDrive::make(const Drive& drive, const FilterOptions& options) {
  PreparedDrive prepared;
  prepared.drive_ = &drive;
  prepared.options_ = options;
  std::optional<Error> refused;
  for (std::size_t run = 0; run < drive.runs.size(); ++run) {
    auto start = find_start(drive, run);
    if (!start) {
      refused = refused ? refused : start.error();
      prepared.not_started_.push_back({run, start.error().message});
      continue;
    }
    turn_heading(start->state, options.initial_heading_rad);
    auto design = make_design(drive.document, drive.runs[run].dt_s, *start, options);
    if (!design) {
      return fail(design.error());
    }
    const bool shaken = options.gyro_vibration > 0.0 || options.force_vibration > 0.0;
    prepared.parts_.push_back({*start, corrected_readings(drive.runs[run], options.errors), std::move(*design),
                               shaken ? Vibration(drive.runs[run].readings, drive.runs[run].dt_s) : Vibration()});
  }
  if (prepared.parts_.empty()) {
    return fail(refused.value_or(Error{ErrorCode::NoSamples, "The drive has no readings.", {}}));
  }
  return prepared;
}

FilterRun PreparedDrive::run(std::size_t part, const FilterTask& task) const {
  const Part& own = parts_[part];
  FilterTask whole = task;
  whole.vibration = task.vibration != nullptr ? task.vibration : &own.vibration;
  return run_filter(*drive_, own.start, own.readings, own.design, options_, whole);
}

std::vector<std::vector<DriveOutage>> scored_outages(const PreparedDrive& prepared, const RunControl& control) {
  struct Task {
    std::size_t part;
    PlannedRun planned;
  };
  std::vector<Task> tasks;
  for (std::size_t part = 0; part < prepared.parts(); ++part) {
    for (PlannedRun& planned : plan_outages(prepared.drive(), prepared.start(part))) {
      tasks.push_back({part, std::move(planned)});
    }
  }
  std::vector<std::vector<DriveOutage>> scored(tasks.size());
  parallel_for(
      control.threads, tasks.size(),
      [&](std::size_t i) {
        FilterTask task;
        task.outages = tasks[i].planned.outages;
        task.phase = tasks[i].planned.phase;
        scored[i] = prepared.run(tasks[i].part, task).outages;
      },
      control.stop);
  std::vector<std::vector<DriveOutage>> by_duration(prepared.drive().document.outages.duration_s.size());
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    auto& list = by_duration[tasks[i].planned.duration];
    list.insert(list.end(), scored[i].begin(), scored[i].end());
  }
  return by_duration;
}

std::vector<std::vector<std::size_t>> blocks_of(const std::vector<DriveOutage>& outages, double period_s) {
  double first = std::numeric_limits<double>::infinity();
  for (const DriveOutage& scored : outages) {
    first = std::min(first, scored.outage.start_s);
  }
  std::vector<std::vector<std::size_t>> blocks;
  for (std::size_t i = 0; i < outages.size(); ++i) {
    const auto block = static_cast<std::size_t>((outages[i].outage.start_s - first) / period_s + 1e-9);
    blocks.resize(std::max(blocks.size(), block + 1));
    blocks[block].push_back(i);
  }
  std::erase_if(blocks, [](const auto& block) { return block.empty(); });
  return blocks;
}

Interval bootstrap_interval(const std::vector<std::vector<std::size_t>>& blocks,
                            const std::function<double(std::span<const std::size_t>)>& statistic,
                            const EvaluationOptions& settings, std::uint64_t stream) {
  if (blocks.size() < kLeastBlocks || settings.resamples < 20) {
    return {};  // too few blocks to say anything
  }
  Random random(settings.seed, stream);
  std::vector<double> values;
  std::vector<std::size_t> drawn;
  for (int r = 0; r < settings.resamples; ++r) {
    drawn.clear();
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const auto& block = blocks[random.below(blocks.size())];
      drawn.insert(drawn.end(), block.begin(), block.end());
    }
    values.push_back(statistic(drawn));
  }
  return percentile_interval(std::move(values));
}

Interval percentile_interval(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {value_at_share(values, 0.025), value_at_share(values, 0.975)};
}

Estimate share_inside(const std::vector<DriveOutage>& outages, const std::vector<std::vector<std::size_t>>& blocks,
                      double fraction, const EvaluationOptions& settings, std::uint64_t stream) {
  const double limit = -2.0 * std::log(1.0 - fraction);  // chi-square of two degrees of freedom
  const auto share = [&](std::span<const std::size_t> which) {
    double count = 0.0;
    for (const std::size_t i : which) {
      count += outages[i].nees() <= limit ? 1.0 : 0.0;
    }
    return count / static_cast<double>(which.size());
  };
  std::vector<std::size_t> all(outages.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return {share(all), bootstrap_interval(blocks, share, settings, stream)};
}

DurationSummary summarise(std::vector<DriveOutage> outages, double duration_s, double period_s,
                          const EvaluationOptions& settings) {
  DurationSummary summary;
  summary.duration_s = duration_s;
  summary.period_s = period_s;
  summary.outages = std::move(outages);
  const auto column = [&](auto&& of) {
    std::vector<double> values;
    for (const DriveOutage& scored : summary.outages) {
      values.push_back(of(scored));
    }
    return values;
  };
  const auto errors = column([](const DriveOutage& o) { return o.error_m(); });
  const auto nees = column([](const DriveOutage& o) { return o.nees(); });
  const auto blocks = blocks_of(summary.outages, period_s);
  std::uint64_t stream = 100;
  const auto estimate = [&](const auto& of) {
    std::vector<std::size_t> all(summary.outages.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return Estimate{of(std::span<const std::size_t>(all)), bootstrap_interval(blocks, of, settings, stream++)};
  };
  const auto picked = [](const std::vector<double>& from, std::span<const std::size_t> which) {
    std::vector<double> values;
    values.reserve(which.size());
    for (const std::size_t i : which) {
      values.push_back(from[i]);
    }
    return values;
  };
  summary.rms_m = estimate([&](std::span<const std::size_t> w) { return root_mean_square(picked(errors, w)); });
  summary.median_m = estimate([&](std::span<const std::size_t> w) { return middle_of(picked(errors, w)); });
  summary.nees = estimate([&](std::span<const std::size_t> w) { return mean_over(picked(nees, w)); });
  summary.coverage50 = share_inside(summary.outages, blocks, 0.5, settings, stream++);
  summary.coverage95 = share_inside(summary.outages, blocks, 0.95, settings, stream++);
  summary.mean_m = mean_over(errors);
  std::vector<double> sorted = errors;
  std::sort(sorted.begin(), sorted.end());
  summary.p95_m = value_at_share(sorted, 0.95);
  summary.worst_m = sorted.back();
  summary.along_rms_m = root_mean_square(column([](const DriveOutage& o) { return o.along_m; }));
  summary.across_rms_m = root_mean_square(column([](const DriveOutage& o) { return o.across_m; }));
  summary.start_error_rms_m = root_mean_square(column([](const DriveOutage& o) { return o.start_error_m; }));
  summary.straight_line_rms_m = root_mean_square(column([](const DriveOutage& o) { return o.straight_line_error_m; }));
  summary.promised_rms_m = root_mean_square(
      column([](const DriveOutage& o) { return std::sqrt(o.covariance_ned(0, 0) + o.covariance_ned(1, 1)); }));
  summary.growth = growth_of(summary.outages, duration_s);
  for (const OutageClass one : {OutageClass::Rest, OutageClass::Straight, OutageClass::Turning}) {
    DurationSummary::Class of{one, 0, 0.0, 0.0};
    for (std::size_t i = 0; i < summary.outages.size(); ++i) {
      if (summary.outages[i].outage_class == one) {
        ++of.count;
        of.rms_m += errors[i] * errors[i];
        of.nees += nees[i];
      }
    }
    if (of.count > 0) {
      of.rms_m = std::sqrt(of.rms_m / static_cast<double>(of.count));
      of.nees /= static_cast<double>(of.count);
      summary.classes.push_back(of);
    }
  }
  return summary;
}

Result<DriveEvaluation> evaluate_drive(const Drive& drive, const FilterOptions& options,
                                       const EvaluationOptions& settings, const RunControl& control) {
  auto prepared = PreparedDrive::make(drive, options);
  if (!prepared) {
    return fail(prepared.error());
  }
  DriveEvaluation evaluation;
  const auto scored = scored_outages(*prepared, control);
  if (control.stop.stop_requested()) {
    return fail(ErrorCode::Cancelled, "The evaluation was cancelled.");
  }
  const OutagePlan& plan = drive.document.outages;
  for (std::size_t d = 0; d < scored.size(); ++d) {
    if (scored[d].empty()) {
      evaluation.notes.push_back("No outage of " + std::to_string(std::lround(plan.duration_s[d])) +
                                 " s fits the drive.");
      continue;
    }
    const double period = plan.at_s.empty() ? plan.every_s[d] : plan.duration_s[d] + 20.0;
    evaluation.durations.push_back(summarise(scored[d], plan.duration_s[d], period, settings));
  }
  if (evaluation.durations.empty()) {
    return fail(ErrorCode::TooFewSamples,
                "No outage of the plan fits the drive: it needs the time to settle, the outage and a reference at both "
                "of its ends.",
                {{"parameter", "outages"}});
  }
  if (const std::string told = left_out_of_plan(*prepared, evaluation.durations); !told.empty()) {
    evaluation.notes.push_back(told);
  }
  for (const PreparedDrive::NotStarted& one : prepared->not_started()) {
    const UniformRun& run = drive.runs[one.run];
    evaluation.notes.push_back("The filter cannot begin in the readings from " +
                               std::to_string(std::lround(run.start_s)) + " to " +
                               std::to_string(std::lround(run.end_s())) + " s: " + one.reason);
  }
  for (std::size_t part = 0; part < prepared->parts(); ++part) {
    evaluation.starts.push_back(prepared->start(part));
  }
  if (settings.innovations) {
    std::vector<Innovation> innovations;
    for (std::size_t part = 0; part < prepared->parts(); ++part) {
      FilterTask task;
      task.keep_innovations = true;
      FilterRun run = prepared->run(part, task);
      innovations.insert(innovations.end(), run.innovations.begin(), run.innovations.end());
      evaluation.rejected += run.rejected;
      evaluation.heading_known_s = evaluation.heading_known_s ? evaluation.heading_known_s : run.heading_known_s;
    }
    evaluation.innovations = summarise_innovations(innovations);
  }
  evaluation.natural = natural_outages(drive);
  return evaluation;
}

}  // namespace driftlab::drive
