#include "schema/text/characterisation.hpp"

#include "schema/text/printed.hpp"

#include <cmath>

namespace driftlab {
namespace {

std::string mark_of(VerdictLevel level) {
  return level == VerdictLevel::Fine ? "✓" : level == VerdictLevel::Wrong ? "✗" : "△";
}

/// Four digits, or a dash.
std::string four_digits(double value) { return std::isfinite(value) ? printed("%.4g", value) : "-"; }

std::string wide_cell(const std::string& text) {
  return std::string(text.size() < 12 ? 12 - text.size() : 1, ' ') + text;
}

std::string curve_heading(const char* title, const ToldChannel& channel, const char* at, const char* value,
                          const std::string& unit) {
  return std::string(title) + " of " + channel.channel + "\n" + wide_cell(at) + wide_cell(value) + "  95 % interval [" +
         unit + "]\n";
}

std::string curve_rows(const ToldCurve& curve) {
  std::string text;
  for (std::size_t i = 0; i < curve.at.size(); ++i) {
    text += wide_cell(four_digits(curve.at[i])) + wide_cell(four_digits(curve.value[i])) + "  " +
            four_digits(curve.low[i]) + " .. " + four_digits(curve.high[i]) + "\n";
  }
  return text;
}

std::string deviation_text(const char* title, const ToldChannel& channel, const std::optional<ToldCurve>& curve) {
  return curve ? curve_heading(title, channel, "tau [s]", "deviation", channel.unit) + curve_rows(*curve) + "\n" : "";
}

std::string spectrum_text(const ToldChannel& channel) {
  if (!channel.psd) {
    return "";
  }
  std::string text =
      curve_heading("Power spectral density", channel, "f [Hz]", "density", "(" + channel.unit + ")^2/Hz") +
      curve_rows(channel.psd->density);
  for (const ToldLine& line : channel.psd->lines) {
    text += "Line at " + four_digits(line.frequency_hz) + " Hz: amplitude " + four_digits(line.amplitude) + " " +
            channel.unit + ", " + four_digits(line.excess) + " times the power of the noise around it\n";
  }
  return text + "\n";
}

}  // namespace

std::string verdicts_to_text(const std::vector<ToldRecording>& recordings) {
  std::string text;
  for (const ToldRecording& recording : recordings) {
    for (const ToldChannel& channel : recording.channels) {
      if (channel.verdict) {
        text += mark_of(channel.verdict->level) + " " + (recordings.size() > 1 ? recording.id + ", " : "") +
                channel.channel + ": " + channel.verdict->sentence + "\n";
      }
    }
  }
  return text;
}

std::string further_to_text(const std::vector<ToldRecording>& recordings) {
  std::string text;
  for (const ToldRecording& recording : recordings) {
    for (const ToldChannel& channel : recording.channels) {
      text += deviation_text("Allan deviation", channel, channel.allan) +
              deviation_text("Total deviation", channel, channel.total) +
              deviation_text("Theo1 deviation", channel, channel.theo1) + spectrum_text(channel);
    }
  }
  return text;
}

}  // namespace driftlab
