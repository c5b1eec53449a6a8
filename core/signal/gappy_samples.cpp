#include "core/signal/gappy_samples.hpp"

#include <algorithm>

namespace driftlab {

std::size_t GappySamples::missing_count() const {
  return static_cast<std::size_t>(std::count_if(missing.begin(), missing.end(), [](auto flag) { return flag != 0; }));
}

Result<GappySamples> on_grid(std::span<const double> rows, std::span<const Gap> gaps) {
  std::size_t absent = 0;
  std::size_t before = 0;
  for (const Gap& gap : gaps) {
    if (gap.row <= before || gap.row >= rows.size() || gap.missing == 0) {
      return fail(ErrorCode::InvalidArgument, "The gaps of a series must rise and lie between two of its rows.",
                  {{"row", std::to_string(gap.row + 1)}});
    }
    before = gap.row;
    const std::size_t most = kMostMissingPerRow * rows.size();
    if (gap.missing > most - absent) {
      return fail(ErrorCode::LimitExceeded,
                  "More than " + std::to_string(kMostMissingPerRow) + " samples are missing for each that is there.",
                  {{"limit", std::to_string(most)}});
    }
    absent += gap.missing;
  }
  GappySamples samples;
  samples.values.reserve(rows.size() + absent);
  if (gaps.empty()) {
    samples.values.assign(rows.begin(), rows.end());
    return samples;
  }
  samples.missing.reserve(rows.size() + absent);
  std::size_t row = 0;
  const auto copy_to = [&](std::size_t end) {
    samples.values.insert(samples.values.end(), rows.begin() + static_cast<std::ptrdiff_t>(row),
                          rows.begin() + static_cast<std::ptrdiff_t>(end));
    samples.missing.insert(samples.missing.end(), end - row, std::uint8_t{0});
    row = end;
  };
  for (const Gap& gap : gaps) {
    copy_to(gap.row);
    samples.values.insert(samples.values.end(), gap.missing, 0.0);
    samples.missing.insert(samples.missing.end(), gap.missing, std::uint8_t{1});
  }
  copy_to(rows.size());
  return samples;
}

}  // namespace driftlab
