#pragma once
/// The verdict on a result: one sentence that a person can act on.
///
/// Command line, API and page show the same sentence, so it is made once, here, from what is kept of a channel
/// (core/campaign/reported_channel.hpp) or of a device (core/campaign/parameter_table.hpp): results just computed and
/// results stored years ago read alike. Whether a model fits outranks which one is ranked first: "best of nine, does
/// not fit" is the usual state of real recordings. A figure is named only where the data identify it, with the digits
/// that its interval lets stand (core/signal/significant.hpp).
#include "core/campaign/parameter_table.hpp"
#include "core/campaign/reported_channel.hpp"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace driftlab {

/// Whether a result can be used.
enum class VerdictLevel {
  Fine,
  Look,   ///< usable, with something that a reader must know first
  Wrong,  ///< not to be used as it is
};

[[nodiscard]] std::string_view name_of(VerdictLevel level);

struct Verdict {
  std::string sentence;
  std::vector<std::string> details;  ///< sentences with the evidence
  VerdictLevel level = VerdictLevel::Fine;
  /// The values on which the sentence rests, each with its JSON pointer into the channel's document.
  std::vector<std::pair<std::string, double>> facts;
};

/// Details of the test for gross errors (core/variance/contamination.hpp).
struct GrossErrorEvidence {
  bool not_gaussian = false;
  std::size_t disjoint_scales = 0;
  std::size_t scales = 0;
};

/// Of a channel with `scales` scales.
[[nodiscard]] GrossErrorEvidence evidence_of(const Contamination& contamination, std::size_t scales);

/// Of one channel of one recording.
[[nodiscard]] Verdict verdict_of(const ReportedChannel& channel, const GrossErrorEvidence& evidence);

/// Of one sensor axis over its conditions.
[[nodiscard]] Verdict verdict_of(const ParameterTable& table);

/// The channel that a person should look at first, by its verdict.
struct GravestChannel {
  std::string channel;  ///< the file's column
  Verdict verdict;
};

/// Index of the first verdict of the worst level; nothing for an empty list.
[[nodiscard]] std::optional<std::size_t> gravest_of(std::span<const Verdict> verdicts);

}  // namespace driftlab
