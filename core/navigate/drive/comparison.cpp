#include "core/navigate/drive/comparison.hpp"

#include "core/navigate/drive/profile.hpp"
#include "core/navigate/outage_claims.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <set>

namespace driftlab::drive {
namespace {

constexpr double kFirstNoiseFactor = 4.0;   ///< of the search for a level, as where causes are sought
constexpr std::uint64_t kPairStream = 700;  ///< of the bootstrap, beside those of one filter's figures

Status check_models(const std::vector<BelievedModel>& models) {
  std::set<std::string> names;
  for (const BelievedModel& model : models) {
    if (!names.insert(model.name).second) {
      return fail(ErrorCode::InvalidArgument, "Two models are called '" + model.name + "'.", {{"parameter", "models"}});
    }
  }
  return models.size() < 2
             ? fail(ErrorCode::InvalidArgument, "A comparison takes at least two models.", {{"parameter", "models"}})
             : Status{};
}

double mean_error(const std::vector<DriveOutage>& outages, std::span<const std::size_t> which) {
  double sum = 0.0;
  for (const std::size_t i : which) {
    sum += outages[i].error_m();
  }
  return sum / static_cast<double>(which.size());
}

FilterDifference difference_of(const ComparedFilter& filter, const ComparedFilter& against, std::size_t duration,
                               const EvaluationOptions& settings) {
  const DurationSummary& mine = filter.durations[duration];
  const DurationSummary& theirs = against.durations[duration];
  FilterDifference pair;
  pair.duration_s = mine.duration_s;
  pair.count = mine.outages.size();
  pair.filter = filter.name;
  pair.against = against.name;
  const auto blocks = blocks_of(mine.outages, mine.period_s);
  const auto absolute = [&](std::span<const std::size_t> which) {
    return mean_error(mine.outages, which) - mean_error(theirs.outages, which);
  };
  const auto relative = [&](std::span<const std::size_t> which) {
    return mean_error(mine.outages, which) / mean_error(theirs.outages, which) - 1.0;
  };
  std::vector<std::size_t> all(pair.count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  pair.bounded = blocks.size() >= kLeastBlocks && settings.resamples >= 20;
  pair.difference_m = {absolute(all), bootstrap_interval(blocks, absolute, settings, kPairStream + duration)};
  pair.relative = {relative(all), bootstrap_interval(blocks, relative, settings, kPairStream + duration)};
  return pair;
}

/// "M_dyn(AV) errs 3.1 % [1.2 %, 5 %] more than M_stat(AV)"; where less, the numbers are those of the gain.
std::string shown_difference(const FilterDifference& pair) {
  const double sign = pair.relative.value < 0.0 ? -100.0 : 100.0;
  const double low = std::min(sign * pair.relative.ci95.low, sign * pair.relative.ci95.high);
  const double high = std::max(sign * pair.relative.ci95.low, sign * pair.relative.ci95.high);
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), " errs %.2g %% [%.2g %%, %.2g %%] %s", sign * pair.relative.value, low, high,
                sign < 0.0 ? "less" : "more");
  std::string sentence = pair.filter + text.data() + " than " + pair.against;
  if (std::abs(pair.relative.value) < kPracticalSize) {
    sentence += ", which is of no practical size";
  }
  return sentence;
}

}  // namespace

const FilterDifference* FilterComparison::difference(std::string_view filter, std::string_view against,
                                                     double duration_s) const {
  const auto found = std::find_if(differences.begin(), differences.end(), [&](const FilterDifference& pair) {
    return pair.filter == filter && pair.against == against && pair.duration_s == duration_s;
  });
  return found == differences.end() ? nullptr : &*found;
}

Result<FilterComparison> compare_filters(const Drive& drive, const std::vector<BelievedModel>& models,
                                         const FilterOptions& options, const ComparisonOptions& settings,
                                         const RunControl& control) {
  if (auto status = check_models(models); !status) {
    return fail(status.error());
  }
  const EvaluationOptions evaluated{.seed = settings.seed, .resamples = settings.resamples, .innovations = false};
  FilterComparison comparison;
  Drive believed = drive;
  for (const BelievedModel& model : models) {
    control.report(model.name, static_cast<double>(comparison.filters.size()) / static_cast<double>(models.size()));
    believed.document.model = model.imu;
    FilterOptions own = options;
    if (settings.fit_noise) {
      own = Profile(believed, {true, true}, control).with_noise_fitted(own, kFirstNoiseFactor);
    }
    auto evaluation = evaluate_drive(believed, own, evaluated, control);
    if (!evaluation) {
      return fail(evaluation.error());
    }
    if (comparison.filters.empty()) {
      comparison.notes = evaluation->notes;
    }
    comparison.filters.push_back(
        {model.name, model.about, own.gyro_noise, own.force_noise, std::move(evaluation->durations)});
  }
  for (std::size_t d = 0; d < comparison.filters.front().durations.size(); ++d) {
    for (std::size_t i = 1; i < comparison.filters.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        comparison.differences.push_back(difference_of(comparison.filters[i], comparison.filters[k], d, evaluated));
      }
    }
  }
  comparison.notes.push_back("Each interval holds 95 % by itself: of the " +
                             with_count(comparison.differences.size(), "comparison", "comparisons") +
                             " given here about one in twenty may exclude 0 by chance.");
  control.report("comparison", 1.0);
  return comparison;
}

std::vector<std::string> verdicts_of(const FilterComparison& comparison) {
  const std::string& first = comparison.filters.front().name;
  std::vector<std::string> sentences;
  for (const DurationSummary& duration : comparison.filters.front().durations) {
    std::string shown;
    double largest = 0.0;
    std::size_t open = 0;
    bool bounded = true;
    for (const FilterDifference& pair : comparison.differences) {
      if (pair.against != first || pair.duration_s != duration.duration_s) {
        continue;
      }
      bounded = bounded && pair.bounded;
      if (pair.shown()) {
        shown += (shown.empty() ? "" : "; ") + shown_difference(pair);
      } else {
        ++open;
        largest = std::max({largest, std::abs(pair.relative.ci95.low), std::abs(pair.relative.ci95.high)});
      }
    }
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "After %.3g s without fixes (%s) ", duration.duration_s,
                  with_count(duration.outages.size(), "outage").c_str());
    std::string sentence = text.data();
    if (!bounded) {
      sentences.push_back(sentence + "there are too few outages to say which model errs less.");
      continue;
    }
    if (!shown.empty()) {
      sentence += shown;
    }
    if (open > 0) {
      std::snprintf(text.data(), text.size(), "no %sdifference from ", shown.empty() ? "" : "other ");
      sentence += (shown.empty() ? "" : "; ") + std::string(text.data()) + first;
      std::snprintf(text.data(), text.size(), " larger than %.2g %% is shown", 100.0 * largest);
      sentence += text.data();
    }
    sentences.push_back(sentence + ".");
  }
  return sentences;
}

}  // namespace driftlab::drive
