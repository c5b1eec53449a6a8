#include "clients/cli/analysis.hpp"

#include <array>
#include <cstdio>

namespace driftlab::cli {
namespace {

/// A number of the document with four digits, or a dash.
std::string shown(const Json& value) {
  std::array<char, 32> text{'-'};
  if (value.is_number()) {
    (void)std::snprintf(text.data(), text.size(), "%.4g", value.get<double>());
  }
  return text.data();
}

std::string cell(const std::string& text) { return std::string(text.size() < 12 ? 12 - text.size() : 1, ' ') + text; }

std::string heading(const char* title, const Json& channel, const char* at, const char* value,
                    const std::string& unit) {
  return std::string(title) + " of " + channel["channel"].get<std::string>() + "\n" + cell(at) + cell(value) +
         "  95 % interval [" + unit + "]\n";
}

/// One line per entry of parallel arrays.
std::string rows(const Json& at, const Json& value, const Json& interval) {
  std::string text;
  for (std::size_t i = 0; i < at.size(); ++i) {
    text += cell(shown(at[i])) + cell(shown(value[i])) + "  " + shown(interval[i][0]) + " .. " + shown(interval[i][1]) +
            "\n";
  }
  return text;
}

std::string curve(const Json& channel, const char* member, const char* title) {
  if (!channel.contains(member)) {
    return "";
  }
  const Json& values = channel[member];
  return heading(title, channel, "tau [s]", "deviation", channel["unit"].get<std::string>()) +
         rows(values["tau_s"], values["deviation"], values["ci95"]) + "\n";
}

std::string spectrum(const Json& channel) {
  if (!channel.contains("psd")) {
    return "";
  }
  const Json& psd = channel["psd"];
  const auto unit = channel["unit"].get<std::string>();
  std::string text = heading("Power spectral density", channel, "f [Hz]", "density", "(" + unit + ")^2/Hz") +
                     rows(psd["frequency_hz"], psd["density"], psd["ci95"]);
  for (const Json& line : psd["lines"]) {
    text += "Line at " + shown(line["frequency_hz"]) + " Hz: amplitude " + shown(line["amplitude"]) + " " + unit +
            ", " + shown(line["excess"]) + " times the power of the noise around it\n";
  }
  return text + "\n";
}

}  // namespace

std::string further_to_text(const Json& document) {
  std::string text;
  for (const Json& recording : document["recordings"]) {
    for (const Json& channel : recording["channels"]) {
      text += curve(channel, "allan_fine", "Allan deviation");
      text +=
          curve(channel, "total", "Total deviation") + curve(channel, "theo1", "Theo1 deviation") + spectrum(channel);
    }
  }
  return text;
}

}  // namespace driftlab::cli
