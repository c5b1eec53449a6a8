#include "schema/json/told_characterisation.hpp"

#include "schema/json/stored_channel.hpp"
#include "schema/json/stored_member.hpp"

#include <limits>
#include <utility>

namespace driftlab {
namespace {

constexpr double kNotTold = std::numeric_limits<double>::quiet_NaN();

double told_number(const Json& value) { return value.is_number() ? value.get<double>() : kNotTold; }

ToldCurve told_curve(const Json& curve, const char* at, const char* value) {
  ToldCurve told;
  for (const Json& one : curve.at(at)) {
    told.at.push_back(told_number(one));
  }
  const Json& values = curve.at(value);
  const Json& intervals = curve.at("ci95");
  for (std::size_t i = 0; i < told.at.size(); ++i) {
    told.value.push_back(told_number(values.at(i)));
    told.low.push_back(told_number(intervals.at(i).at(0)));
    told.high.push_back(told_number(intervals.at(i).at(1)));
  }
  return told;
}

std::optional<ToldCurve> told_deviation(const Json& channel, const char* member) {
  const auto found = channel.find(member);
  return found == channel.end() ? std::nullopt : std::optional(told_curve(*found, "tau_s", "deviation"));
}

std::optional<ToldSpectrum> told_spectrum(const Json& channel) {
  const auto found = channel.find("psd");
  if (found == channel.end()) {
    return std::nullopt;
  }
  ToldSpectrum told{told_curve(*found, "frequency_hz", "density"), {}};
  for (const Json& line : found->at("lines")) {
    told.lines.push_back({finite_member(line, "frequency_hz", kNotTold), finite_member(line, "amplitude", kNotTold),
                          finite_member(line, "excess", kNotTold)});
  }
  return told;
}

ToldChannel told_channel(const Json& channel) {
  ToldChannel told;
  told.channel = channel.at("channel").get<std::string>();
  told.unit = channel.at("unit").get<std::string>();
  if (const auto stored = stored_channel_from_json(channel)) {
    told.verdict = verdict_of(*stored);
  }
  told.allan = told_deviation(channel, "allan_fine");
  told.total = told_deviation(channel, "total");
  told.theo1 = told_deviation(channel, "theo1");
  told.psd = told_spectrum(channel);
  return told;
}

}  // namespace

Result<std::vector<ToldRecording>> told_from_json(const Json& document) {
  try {
    std::vector<ToldRecording> told;
    for (const Json& recording : document.at("recordings")) {
      ToldRecording& one = told.emplace_back();
      one.id = recording.at("id").get<std::string>();
      for (const Json& channel : recording.at("channels")) {
        one.channels.push_back(told_channel(channel));
      }
    }
    return told;
  } catch (const Json::exception& fault) {
    return fail(ErrorCode::Internal, "A characterisation cannot be read: " + std::string(fault.what()) + ".");
  }
}

}  // namespace driftlab
