#include "schema/json/channel_look.hpp"

#include "schema/json/rounded.hpp"

namespace driftlab {
namespace {

Json head_of(const ChannelLook& look) {
  return Json{{"unit", look.unit().symbol},
              {"dt_s", number(look.dt_s())},
              {"samples", look.samples()},
              {"first_s", number(look.first_s())}};
}

}  // namespace

Json spectrum_to_json(const ChannelLook& look, const BinnedSpectrum& spectrum) {
  Json document = head_of(look);
  Json ci95 = Json::array();
  for (const Interval& ends : spectrum.ci95) {
    ci95.push_back(interval(ends));
  }
  document["f_hz"] = numbers(spectrum.frequency_hz);
  document["density"] = numbers(spectrum.density);
  document["ci95"] = std::move(ci95);
  document["max"] = numbers(spectrum.greatest);
  document["segments"] = spectrum.segments;
  document["segment_samples"] = spectrum.segment_samples;
  document["window"] = "five sine tapers";
  return document;
}

Json histogram_to_json(const ChannelLook& look, const std::optional<RobustHistogram>& histogram) {
  Json document = head_of(look);
  if (!histogram) {
    document["median"] = nullptr;
    document["sigma"] = nullptr;
    document["reason"] = "More than half of the values are equal: they have no robust width.";
    return document;
  }
  document["median"] = number(histogram->median);
  document["sigma"] = number(histogram->sigma);
  document["edges"] = numbers(histogram->edges);
  document["counts"] = histogram->counts;
  document["gaussian"] = numbers(histogram->gaussian);
  document["below"] = histogram->below;
  document["above"] = histogram->above;
  document["apart"] = Json::array();
  for (const ApartPlace& place : look.apart()) {
    document["apart"].push_back({{"t0", number(place.t0_s)},
                                 {"t1", number(place.t1_s)},
                                 {"samples", place.samples},
                                 {"deviations", number(place.deviations)}});
  }
  return document;
}

Json spectrogram_to_json(const ChannelLook& look, const ChannelLook::Ratio& ratio) {
  Json document = head_of(look);
  const Spectrogram& found = ratio.spectrogram;
  document["expected"] = ratio.of_model ? "model" : "median";
  document["time_s"] = numbers(found.time_s);
  document["f_hz"] = numbers(found.frequency_hz);
  document["log10_ratio"] = rounded_rows(ratio.log10(), found.frequency_hz.size(), 3);
  document["window_samples"] = found.window_samples;
  return document;
}

}  // namespace driftlab
