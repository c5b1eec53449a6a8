#pragma once
/// What people read of a characterisation beside its parameter tables: the sentence of each channel
/// (core/campaign/verdict.hpp) and the curves that were asked for, in the channel's own unit.
///
/// Made here of what was characterised in this process, or read from a document (schema/json/told_characterisation.hpp)
/// that another process wrote; schema/text prints it (schema/text/characterisation.hpp).
#include "core/analysis/characterise.hpp"
#include "core/campaign/verdict.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// Values with 95 % intervals against averaging time or frequency; not finite where there is none. Lists of one length.
struct ToldCurve {
  std::vector<double> at;  ///< [s] or [Hz]
  std::vector<double> value;
  std::vector<double> low;
  std::vector<double> high;
};

/// A spectral line; a figure that there is not is not finite.
struct ToldLine {
  double frequency_hz = 0.0;
  double amplitude = 0.0;  ///< of the sinusoid [channel unit]
  double excess = 0.0;     ///< power over that of the noise around it
};

struct ToldSpectrum {
  ToldCurve density;  ///< [channel unit^2/Hz] against [Hz]
  std::vector<ToldLine> lines;
};

struct ToldChannel {
  std::string channel;             ///< the file's column
  std::string unit;                ///< symbol of the channel's own unit
  std::optional<Verdict> verdict;  ///< nothing where a document of another program has none
  std::optional<ToldCurve> allan;  ///< deviation at the averaging times asked for [channel unit]
  std::optional<ToldCurve> total;  ///< total deviation
  std::optional<ToldCurve> theo1;
  std::optional<ToldSpectrum> psd;
};

struct ToldRecording {
  std::string id;
  std::vector<ToldChannel> channels;
};

/// The channel that a person should look at first: the first of those of the worst level. Precondition: there is one.
[[nodiscard]] GravestChannel gravest_channel(const CharacterisedRecording& recording);

/// In the order of the recordings and of their channels.
[[nodiscard]] std::vector<ToldRecording> told_of(const std::vector<CharacterisedRecording>& recordings);

}  // namespace driftlab
