#include "core/analysis/told_characterisation.hpp"

#include "core/variance/deviation.hpp"

#include <utility>

namespace driftlab {
namespace {

std::optional<ToldCurve> told_curve(const std::optional<LongTauCurve>& variances, double factor) {
  if (!variances) {
    return std::nullopt;
  }
  const DeviationCurve curve = deviations_of(*variances);
  ToldCurve told{curve.tau_s, {}, {}, {}};
  for (std::size_t i = 0; i < curve.tau_s.size(); ++i) {
    told.value.push_back(curve.deviation[i] * factor);
    told.low.push_back(curve.ci95[i].low * factor);
    told.high.push_back(curve.ci95[i].high * factor);
  }
  return told;
}

std::optional<ToldSpectrum> told_spectrum(const std::optional<PowerSpectrum>& spectrum, double factor) {
  if (!spectrum) {
    return std::nullopt;
  }
  ToldSpectrum told;
  told.density.at = spectrum->frequency_hz;
  const double square_factor = factor * factor;
  for (std::size_t i = 0; i < spectrum->density.size(); ++i) {
    told.density.value.push_back(spectrum->density[i] * factor * factor);
    told.density.low.push_back(spectrum->ci95[i].low * square_factor);
    told.density.high.push_back(spectrum->ci95[i].high * square_factor);
  }
  for (const SpectrumLine& line : spectrum->lines) {
    told.lines.push_back({line.frequency_hz, line.amplitude * factor, line.excess});
  }
  return told;
}

Verdict verdict_of(const CharacterisedChannel& channel, const ReportedChannel& told) {
  return verdict_of(told, evidence_of(channel.result.contamination, told.haar.scale.size()));
}

ToldChannel told_channel(const CharacterisedChannel& channel) {
  const ChannelCharacterisation& result = channel.result;
  const ReportedChannel told = reported(channel.column, channel.role, result);
  const double factor = 1.0 / channel.role.unit.value_or(Unit{}).factor;
  return {channel.column,
          told.unit,
          verdict_of(channel, told),
          told_curve(result.further.allan, factor),
          told_curve(result.further.total, factor),
          told_curve(result.further.theo1, factor),
          told_spectrum(result.further.psd, factor)};
}

}  // namespace

GravestChannel gravest_channel(const CharacterisedRecording& recording) {
  std::vector<Verdict> verdicts;
  for (const CharacterisedChannel& channel : recording.channels) {
    verdicts.push_back(verdict_of(channel, reported(channel.column, channel.role, channel.result)));
  }
  const std::size_t gravest = gravest_of(verdicts).value_or(0);
  return {recording.channels[gravest].column, std::move(verdicts[gravest])};
}

std::vector<ToldRecording> told_of(const std::vector<CharacterisedRecording>& recordings) {
  std::vector<ToldRecording> told;
  for (const CharacterisedRecording& recording : recordings) {
    ToldRecording& one = told.emplace_back();
    one.id = recording.spec.id;
    for (const CharacterisedChannel& channel : recording.channels) {
      one.channels.push_back(told_channel(channel));
    }
  }
  return told;
}

}  // namespace driftlab
