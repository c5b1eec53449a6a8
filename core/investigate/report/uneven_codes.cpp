#include "core/investigate/report/uneven_codes.hpp"

#include "core/investigate/study/lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kPeriod = 32;  ///< codes, the longest
/// The chance of n = 10^7 is then off by less than n exp(-2 kApart) = 10^-5.
constexpr double kApart = 14.0;
constexpr double kCode = 0.02;  ///< step over noise. Chosen, not measured
/// Kurtosis of differences above a normal variate's: a distribution with a peak is in no phase uniform. Chosen, not
/// measured.
constexpr double kPeaked = 0.25;
constexpr std::size_t kPairsOfBlock = 500;    ///< differences that tell how loud the noise is. Chosen, not measured
constexpr std::size_t kFewestCodes = 5000;    ///< samples
constexpr std::size_t kRowsLooked = 100'000;  ///< that tell the lattice

using CodeCounts = std::array<double, kPeriod>;

/// The step of a channel's lattice [SI]; 0: none.
double step_of(const Channel& channel) {
  const std::span<const double> rows(channel.rows);
  return find_lattice(rows.first(std::min(rows.size(), kRowsLooked))).step * std::fabs(channel.unit.factor);
}

/// The values of a channel whose noise is looked at.
struct Codes {
  CodeCounts counts{};
  double quietest = 0.0;  ///< standard deviation of the noise in the quietest block [SI]
  double fourth = 0.0;    ///< of differences, each in units of its block's
  double pairs = 0.0;
};

/// Differences of consecutive samples, a block of them at a time.
void take_block(const std::vector<double>& differences, Codes& codes) {
  double square = 0.0;
  for (const double d : differences) {
    square += d * d / static_cast<double>(differences.size());
  }
  const double deviation = std::sqrt(0.5 * square);
  codes.quietest = codes.pairs == 0.0 ? deviation : std::min(codes.quietest, deviation);
  for (const double d : differences) {
    codes.fourth += square > 0.0 ? d * d * d * d / (square * square) : 0.0;
  }
  codes.pairs += static_cast<double>(differences.size());
}

void look_at(const ChannelGroup::Member& member, const std::vector<unsigned char>& used, double step, Codes& codes) {
  const Series& measured = member.channel->measured;
  const std::size_t begin = member.recording->begin;
  constexpr auto kModulus = static_cast<long long>(kPeriod);
  std::vector<double> differences;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) {
      continue;
    }
    const long long code = std::llround(measured[begin + i] / step);
    codes.counts.at(static_cast<std::size_t>((code % kModulus + kModulus) % kModulus)) += 1.0;
    if (i > 0 && used[i - 1] != 0) {
      differences.push_back(measured[begin + i] - measured[begin + i - 1]);
    }
    if (differences.size() == kPairsOfBlock) {
      take_block(differences, codes);
      differences.clear();
    }
  }
}

}  // namespace

Remainder uneven_codes(const ChannelGroup& group, const FullRate& data) {
  Remainder best;
  const double step = step_of(*group.members.front().channel);
  Codes codes;
  for (std::size_t r = 0; step > 0.0 && r < group.members.size(); ++r) {
    look_at(group.members[r], data.used[r], step, codes);
  }
  const double samples = std::accumulate(codes.counts.begin(), codes.counts.end(), 0.0);
  const double noise = noise_behind_lattice(codes.quietest, step);
  if (samples < kFewestCodes || codes.pairs == 0.0 || step < kCode * noise ||
      codes.fourth / codes.pairs > 3.0 + kPeaked) {
    return best;
  }
  const double deviation = noise / step;
  double largest = 0.0;
  best.places = 0.0;
  for (std::size_t j = 1; j <= kPeriod / 2; ++j) {
    const double period = static_cast<double>(kPeriod) / static_cast<double>(j);
    if (2.0 * std::numbers::pi * std::numbers::pi * deviation * deviation / (period * period) < kApart) {
      continue;
    }
    std::complex<double> sum = 0.0;
    for (std::size_t k = 0; k < kPeriod; ++k) {
      sum +=
          codes.counts.at(k) * std::polar(1.0, 2.0 * std::numbers::pi * static_cast<double>(k * j % kPeriod) / kPeriod);
    }
    best.places += 1.0;
    // The nearest periods show it too where the values spread over few codes: the largest sum is that of its own.
    if (std::abs(sum) > largest) {
      largest = std::abs(sum);
      // Of period two the sum is real: the square of a normal value has twice the exponent.
      best.observed = largest * largest / samples * (2 * j == kPeriod ? 0.5 : 1.0);
      best.sentence = group.column + ": the codes of the output do not come alike: again after every " +
                      three_digits(period) + " of them they are more and less frequent by " +
                      three_digits((2 * j == kPeriod ? 100.0 : 200.0) * largest / samples) + " %";
    }
  }
  best.places = std::max(best.places, 1.0);
  return best;
}

}  // namespace driftlab::investigate
