#pragma once
/// A campaign characterised channel by channel, for several workers that share it. Put together again, the channels are
/// what core/analysis/characterise.hpp finds, to the bit.
#include "core/analysis/characterise.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace driftlab {

/// How many channels a recording with columns of these names has, 1 where the names do not say: known before it is
/// opened.
[[nodiscard]] std::size_t expected_channels(const RecordingSpec& spec, const ColumnNames& names);

/// The channels of recordings, one after the other.
class CampaignChannels {
 public:
  /// `expected[i]`: how many channels recording i is expected to have, 1 at least. References must outlive this object.
  CampaignChannels(RecordingSource& recordings, const CharacteriseOptions& options,
                   const std::vector<std::size_t>& expected);

  [[nodiscard]] std::size_t count() const { return places_.size(); }

  /// Channel `number` < count(); with the first of a recording also what is said of the recording, with the last one
  /// also what channels it has beyond those expected. A recording stays open until a channel of another is asked for.
  /// Errors, located: those of PreparedRecording.
  [[nodiscard]] Result<CharacterisedRecording> characterise(std::size_t number, const RunControl& control);

  /// Adds what `characterise` gave for the next number.
  void add(CharacterisedRecording part);
  /// Those added.
  [[nodiscard]] std::vector<CharacterisedRecording>& found() { return found_; }

 private:
  struct Place {
    std::size_t recording = 0;
    std::size_t channel = 0;
    bool last = false;
  };

  RecordingSource& recordings_;
  const CharacteriseOptions& options_;
  std::vector<Place> places_;
  std::optional<PreparedRecording> opened_;
  std::size_t opened_index_ = 0;
  std::vector<CharacterisedRecording> found_;
  std::size_t added_ = 0;
};

}  // namespace driftlab
