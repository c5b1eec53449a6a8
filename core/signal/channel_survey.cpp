#include "core/signal/channel_survey.hpp"

#include "core/signal/full_scale.hpp"
#include "core/signal/number.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>

namespace driftlab {
namespace {

constexpr std::size_t kMostDistinct = 256;
constexpr std::size_t kShortestFrozen = 200;
constexpr std::size_t kFrozenToOthers = 20;
constexpr std::size_t kSamplesForSteps = 4096;
constexpr std::array kSentinels{-9999.0, 9999.0, -99999.0, 99999.0, -999.0};
constexpr double kGarbage = 1e6;

/// Calls `passed` at the end of each million samples of a pass.
class Pieces {
 public:
  Pieces(std::span<const double> values, const Passed& passed) : values_(values), passed_(passed) {}
  void done(std::size_t i) const {
    if ((i + 1) % kPiece == 0 && passed_) {
      passed_(values_.subspan(i + 1 - kPiece, kPiece));
    }
  }

 private:
  static constexpr std::size_t kPiece = std::size_t{1} << 20U;
  std::span<const double> values_;
  const Passed& passed_;
};

/// Distinct values up to kMostDistinct, in a table of open addresses.
class DistinctValues {
 public:
  void take(double value) {
    if (count_ > kMostDistinct) {
      return;
    }
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    std::size_t slot = static_cast<std::size_t>((bits * 0x9E3779B97F4A7C15U) >> 54U);
    while (used_[slot] && table_[slot] != value) {
      slot = (slot + 1) % table_.size();
    }
    if (!used_[slot]) {
      used_[slot] = true;
      table_[slot] = value;
      ++count_;
    }
  }
  [[nodiscard]] std::optional<std::size_t> count() const {
    return count_ <= kMostDistinct ? std::optional(count_) : std::nullopt;
  }

 private:
  std::array<double, 1024> table_{};
  std::array<bool, 1024> used_{};
  std::size_t count_ = 0;
};

/// Runs of one value among the sound samples: the longest and the one after it.
class Runs {
 public:
  void take(std::size_t row, bool same) {
    if (!same) {
      close();
      run_ = {row, row, 0};
    }
    run_.end = row + 1;
    ++run_.samples;
    ++samples_;
  }
  void close() {
    if (run_.samples > longest_.samples) {
      second_ = longest_.samples;
      longest_ = run_;
    } else {
      second_ = std::max(second_, run_.samples);
    }
    run_ = {};
  }
  /// Rows of the stretch; none where it is all that there is, or no longer than others.
  [[nodiscard]] std::pair<std::size_t, std::size_t> frozen() const {
    const bool stuck = longest_.samples >= kShortestFrozen && longest_.samples > kFrozenToOthers * second_ &&
                       longest_.samples < samples_;
    return stuck ? std::pair(longest_.begin, longest_.end) : std::pair<std::size_t, std::size_t>{0, 0};
  }

 private:
  struct Run {
    std::size_t begin = 0;
    std::size_t end = 0;  ///< behind its last sound sample
    std::size_t samples = 0;
  };
  Run run_;
  Run longest_;
  std::size_t second_ = 0;
  std::size_t samples_ = 0;
};

bool suspicious(double value) {
  return std::abs(value) > kGarbage || std::find(kSentinels.begin(), kSentinels.end(), value) != kSentinels.end();
}

/// The median, and the distance from it within which 95 % of the numbers lie.
std::pair<double, double> middle_and_width(std::span<const double> values) {
  std::vector<double> finite;
  finite.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](double value) { return !std::isnan(value); });
  const auto at = [&](double p) {
    const auto place = finite.begin() + static_cast<std::ptrdiff_t>(p * static_cast<double>(finite.size() - 1));
    std::nth_element(finite.begin(), place, finite.end());
    return *place;
  };
  const double median = at(0.5);
  for (double& value : finite) {
    value = std::abs(value - median);
  }
  return {median, at(0.95)};
}

/// Rows whose number is no measurement.
std::vector<std::size_t> implausible_rows(std::span<const double> values) {
  const auto [median, width] = middle_and_width(values);
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    if (std::isnan(value) || !suspicious(value)) {
      continue;
    }
    const double distance = std::abs(value - median);
    const bool sentinel = std::find(kSentinels.begin(), kSentinels.end(), value) != kSentinels.end();
    if ((sentinel && distance > 100.0 * width) || (std::abs(value) > kGarbage && distance > kGarbage * width)) {
      rows.push_back(i);
    }
  }
  return rows;
}

/// The step of the lattice on which the first samples lie: the smallest difference of distinct values, if 95 % of the
/// other differences are multiples of it; else 0.
double smallest_step(std::span<const double> values, const std::vector<std::size_t>& unsound) {
  std::vector<double> some;
  for (std::size_t i = 0; i < values.size() && some.size() < kSamplesForSteps; ++i) {
    if (!std::binary_search(unsound.begin(), unsound.end(), i)) {
      some.push_back(values[i]);
    }
  }
  std::sort(some.begin(), some.end());
  const double rounding = some.empty() ? 0.0 : 1e-12 * std::max(std::abs(some.front()), std::abs(some.back()));
  std::vector<double> steps;
  for (std::size_t i = 1; i < some.size(); ++i) {
    if (some[i] - some[i - 1] > rounding) {
      steps.push_back(some[i] - some[i - 1]);
    }
  }
  if (steps.empty()) {
    return 0.0;
  }
  const double smallest = *std::min_element(steps.begin(), steps.end());
  const auto whole = std::count_if(steps.begin(), steps.end(), [smallest](double step) {
    const double multiple = step / smallest;
    return std::abs(multiple - std::round(multiple)) < 0.05;
  });
  return static_cast<double>(whole) >= 0.95 * static_cast<double>(steps.size()) ? smallest : 0.0;
}

/// Everything that needs the sound samples in order.
void walk(std::span<const double> values, const Pieces& pieces, ChannelSurvey& survey) {
  DistinctValues distinct;
  Runs runs;
  Extreme high;
  Extreme low;
  ChannelQuality& quality = survey.quality;
  auto unsound = survey.unsound.begin();
  bool first = true;
  double before = 0.0;
  for (std::size_t i = 0; i < values.size(); pieces.done(i), ++i) {
    if (unsound != survey.unsound.end() && *unsound == i) {
      ++unsound;
      continue;  // a hole neither ends a run nor counts in one
    }
    const double value = values[i];
    const bool same = !first && value == before;
    quality.repeated += same ? 1 : 0;
    runs.take(i, same);
    if (!same) {
      distinct.take(value);
    }
    high.take(value, first);
    low.take(-value, first);
    first = false;
    before = value;
  }
  runs.close();
  quality.distinct = distinct.count();
  survey.frozen = runs.frozen();
  const bool varied = !quality.distinct || *quality.distinct >= kVaried;
  quality.saturated = high.value == -low.value ? 0 : high.saturated(varied) + low.saturated(varied);
}

}  // namespace

ChannelSurvey survey_channel(const std::string& column, std::span<const double> values, const Passed& passed) {
  const Pieces pieces(values, passed);
  ChannelSurvey survey;
  survey.quality.column = column;
  bool look_closer = false;
  for (std::size_t i = 0; i < values.size(); pieces.done(i), ++i) {
    if (std::isnan(values[i])) {
      survey.unsound.push_back(i);
    } else {
      look_closer = look_closer || suspicious(values[i]);
    }
  }
  survey.quality.missing = survey.unsound.size();
  if (look_closer) {
    const std::vector<std::size_t> implausible = implausible_rows(values);
    survey.quality.implausible = implausible.size();
    survey.unsound.insert(survey.unsound.end(), implausible.begin(), implausible.end());
    std::sort(survey.unsound.begin(), survey.unsound.end());
  }
  walk(values, pieces, survey);
  survey.quality.resolution = smallest_step(values, survey.unsound);
  survey.quality.frozen = survey.frozen.second - survey.frozen.first;
  survey.quality.frozen_from = survey.quality.frozen > 0 ? survey.frozen.first + 1 : 0;
  return survey;
}

Status check_holes(const std::string& column, std::span<const double> values, const Passed& passed) {
  const Pieces pieces(values, passed);
  struct Found {
    std::size_t count = 0;
    std::uint64_t row = 0;
  };
  std::array<Found, static_cast<std::size_t>(Missing::Ended) + 1> found{};
  for (std::size_t i = 0; i < values.size(); pieces.done(i), ++i) {
    const double value = values[i];
    if (std::isfinite(value)) {
      continue;
    }
    const MissingSample hole = std::isnan(value) ? why_missing(value) : MissingSample{Missing::Infinite, 0};
    Found& kind = found[static_cast<std::size_t>(hole.why == Missing::Unknown ? Missing::Nan : hole.why)];
    kind.row = kind.count++ == 0 ? (hole.row != 0 ? hole.row : i + 1) : kind.row;
  }
  const auto refuse = [&](ErrorCode code, Missing why, const std::string& what) -> tl::unexpected<Error> {
    const std::string row = std::to_string(found[static_cast<std::size_t>(why)].row);
    return fail(code, "Row " + row + ", column '" + column + "' " + what, {{"row", row}, {"column", column}});
  };
  const auto count = [&](Missing why) { return found[static_cast<std::size_t>(why)].count; };
  const std::string of_all = " of " + std::to_string(values.size()) +
                             " rows; leave the column out (name the others with "
                             "columns), or cut these rows from the file.";
  if (count(Missing::Text) > 0) {
    return refuse(ErrorCode::NotANumber, Missing::Text,
                  "holds text where a number belongs; correct or delete that row.");
  }
  if (count(Missing::OutOfRange) > 0) {
    return refuse(ErrorCode::OutOfRange, Missing::OutOfRange,
                  "holds a number larger than a double can hold; correct or delete that row.");
  }
  if (count(Missing::Infinite) > 0) {
    return refuse(ErrorCode::NonFinite, Missing::Infinite, "holds an infinity; correct or delete that row.");
  }
  if (count(Missing::Nan) * 1000 >= values.size() && count(Missing::Nan) > 0) {
    return refuse(ErrorCode::NonFinite, Missing::Nan,
                  count(Missing::Nan) == 1
                      ? "is the only NaN" + of_all
                      : "is the first NaN; they are " + std::to_string(count(Missing::Nan)) + of_all);
  }
  if (count(Missing::Empty) * 20 > values.size()) {
    return refuse(ErrorCode::NotANumber, Missing::Empty,
                  count(Missing::Empty) == 1
                      ? "is the only empty cell" + of_all
                      : "is the first empty cell; they are " + std::to_string(count(Missing::Empty)) + of_all);
  }
  if (count(Missing::Ended) == values.size()) {
    return refuse(ErrorCode::NoSamples, Missing::Ended, "holds no sample at all.");
  }
  return {};
}

std::string describe(const ChannelQuality& quality, std::size_t window_rows) {
  std::vector<std::string> facts;
  if (quality.missing > 0) {
    facts.push_back(with_count(quality.missing, "sample is missing", "samples are missing"));
  }
  if (quality.implausible > 0) {
    facts.push_back(with_count(quality.implausible, "sample is no measurement (such as -9999) and is left out",
                               "samples are no measurements (such as -9999) and are left out"));
  }
  if (quality.frozen > 0) {
    facts.push_back("the sensor is frozen for " + with_count(quality.frozen, "sample") + " from sample " +
                    std::to_string(quality.frozen_from));
  }
  if (quality.saturated > 0) {
    facts.push_back(with_count(quality.saturated, "sample is at full scale", "samples are at full scale"));
  }
  if (quality.distinct && *quality.distinct == 1) {
    facts.emplace_back("every sample is the same");
  } else if (quality.distinct && *quality.distinct <= 16) {
    facts.push_back("it takes " + std::to_string(*quality.distinct) + " distinct values only" +
                    (quality.resolution > 0.0 ? ", " + short_text(quality.resolution) + " apart" : std::string()));
  }
  if (quality.analysed < window_rows) {
    const bool all = quality.last + 1 - quality.first == quality.analysed;
    facts.push_back((all ? "samples " : std::to_string(quality.analysed) + " of the samples ") +
                    std::to_string(quality.first) + " to " + std::to_string(quality.last) + " are analysed");
  }
  std::string sentence;
  for (const std::string& fact : facts) {
    sentence += sentence.empty() ? "Column '" + quality.column + "': " : "; ";
    sentence += fact;
  }
  return sentence.empty() ? sentence : sentence + ".";
}

}  // namespace driftlab
