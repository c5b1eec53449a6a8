/// duplicated_blocks: blocks of samples that were written a second time (core/investigate/facts/copied_blocks.hpp). The
/// second copy counts as absent in everything that follows.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/recordings.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/facts/copied_blocks.hpp"
#include "core/process/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

struct Copies {
  std::size_t recording = 0;
  std::vector<CopiedBlock> blocks;
};

std::vector<CopiedBlock> blocks_of(const StudyRecording& recording, const std::stop_token& stop) {
  std::vector<std::span<const double>> columns;
  for (const Channel& channel : recording.channels) {
    const auto [low, high] = std::minmax_element(channel.rows.begin(), channel.rows.end());
    if (!channel.rows.empty() && *low != *high) {
      columns.push_back(channel.rows);
    }
  }
  return find_copied_blocks(columns, stop);
}

/// The grid places of the copies.
std::vector<unsigned char> places_of(const StudyRecording& recording, const std::vector<CopiedBlock>& blocks) {
  const Presence& valid = recording.channels.front().valid;
  std::vector<unsigned char> gone(valid.size(), 0);
  std::size_t row = 0;
  std::size_t next = 0;  // block
  for (std::size_t i = 0; i < valid.size(); ++i) {
    if (valid[i] == 0) {
      continue;
    }
    while (next < blocks.size() && row >= blocks[next].copy + blocks[next].length) {
      ++next;
    }
    gone[i] = next < blocks.size() && row >= blocks[next].copy ? 1 : 0;
    ++row;
  }
  return gone;
}

/// Of the expected number of blocks, in units of the number that was seen: their number is Poisson (Garwood's
/// interval). `count`: of blocks of equal length, whose samples would scatter as much.
Interval count_interval(double count) {
  return {0.5 * chi_squared_quantile(0.025, 2.0 * count) / count,
          0.5 * chi_squared_quantile(0.975, 2.0 * count + 2.0) / count};
}

/// Of the mean length of the blocks that a logger writes twice, of which `blocks` were seen.
Interval length_interval(double mean, double variance, double blocks) {
  // Fewer do not tell how much lengths scatter; they are taken to scatter as exponential ones do. Chosen, not measured.
  constexpr double kTells = 4.0;
  if (blocks < kTells) {
    return {std::max(1.0, 2.0 * blocks * mean / chi_squared_quantile(0.975, 2.0 * blocks)),
            2.0 * blocks * mean / chi_squared_quantile(0.025, 2.0 * blocks)};
  }
  const double half = student_quantile(0.975, blocks - 1.0) * std::sqrt(std::max(variance, 1.0) / blocks);
  return {std::max(1.0, mean - half), mean + half};
}

FaultyRecordings describe(const Study& study, const std::vector<Copies>& copies) {
  FaultyRecordings fault;
  std::vector<std::string> ids;
  double blocks = 0.0;
  double repeated = 0.0;
  double square = 0.0;
  double samples = 0.0;
  double first_s = 0.0;
  for (const Copies& copy : copies) {
    const StudyRecording& recording = study.recordings[copy.recording];
    ids.push_back(recording.id);
    for (const Channel& channel : recording.channels) {
      if (!channel.input_only && !channel.error.empty()) {
        fault.channels.push_back(name_of(recording, channel));
      }
    }
    samples += static_cast<double>(recording.length);
    first_s = copy.recording == copies.front().recording
                  ? static_cast<double>(copy.blocks.front().copy) * recording.dt_s
                  : first_s;
    for (const CopiedBlock& block : copy.blocks) {
      const auto length = static_cast<double>(block.length);
      blocks += 1.0;
      repeated += length;
      square += length * length;
    }
  }
  const double mean = repeated / blocks;
  const double variance = blocks > 1.0 ? (square - blocks * mean * mean) / (blocks - 1.0) : 0.0;
  const double fraction = repeated / samples;
  const Interval of_count = count_interval(repeated * repeated / std::max(square, blocks * mean * mean));
  fault.parameters = {
      {"fraction", {fraction, {fraction * of_count.low, std::min(1.0, fraction * of_count.high)}}, units::one({})},
      {"mean_length", {mean, length_interval(mean, variance, blocks)}, units::one({})}};
  fault.sentence = list_of_names(ids) + ": " + in_digits(blocks) +
                   (blocks > 1.0 ? " blocks of samples were written twice" : " block of samples was written twice") +
                   ", first at " + in_digits(first_s) + " s of " + ids.front() +
                   ". The second copies count as absent in what follows.";
  fault.mend = [copies](Study& mended, std::deque<std::vector<double>>& rows) {
    for (const Copies& copy : copies) {
      StudyRecording& recording = mended.recordings[copy.recording];
      leave_out(recording, places_of(recording, copy.blocks), rows);
    }
  };
  return fault;
}

std::vector<FaultyRecordings> find(const Study& study, const std::stop_token& stop) {
  std::vector<Copies> copies;
  for (std::size_t r = 0; r < study.recordings.size(); ++r) {
    Copies copy{r, blocks_of(study.recordings[r], stop)};
    if (!copy.blocks.empty()) {
      copies.push_back(std::move(copy));
    }
  }
  return copies.empty() ? std::vector<FaultyRecordings>{} : std::vector{describe(study, copies)};
}

/// Blocks of 0.4 to 1.6 times the mean length are overwritten with the samples just before them. Where they begin is
/// drawn from what the axes share, for a logger repeats whole rows.
void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  // After a copy as many samples pass again before the next, so that no copy is of a copy.
  const double start = 1.0 / (values[1] * std::max(0.5, 1.0 / values[0] - 2.0));
  std::size_t fresh = 0;
  std::vector<CopiedBlock> blocks;
  for (std::size_t i = 0; i + 1 < draft.shared.size(); ++i) {
    if (normal_tail(draft.shared[i]) >= start) {
      continue;
    }
    const auto length =
        static_cast<std::size_t>(std::max(1.0, values[1] * (0.4 + 1.2 * normal_tail(draft.shared[i + 1]))));
    if (i < fresh + length || i + length > draft.shared.size()) {
      continue;
    }
    blocks.push_back({i - length, i, length});
    fresh = i + length;
    i = fresh;
  }
  draft.output.emplace_back([blocks](std::vector<double>& out) {
    for (const CopiedBlock& block : blocks) {
      std::copy_n(out.begin() + static_cast<std::ptrdiff_t>(block.first), block.length,
                  out.begin() + static_cast<std::ptrdiff_t>(block.copy));
    }
  });
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) { return {0.001 * stage.z, 100.0}; }

}  // namespace

Cause duplicated_blocks() {
  return {.name = "duplicated_blocks",
          .title = "blocks of samples that were written twice",
          .equation = "z(k) = z(k − m) within copies of m samples; mean length: of m; fraction: copied samples of all",
          .family = RecordingFault{.find = find},
          .rivals = {"stuck_samples"},
          .needs = "any recording",
          .separates = "",
          .parameters = {{"fraction", units::one}, {"mean_length", units::one}},
          .inject = inject_effect,
          .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
