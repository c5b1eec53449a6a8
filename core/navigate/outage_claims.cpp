#include "core/navigate/outage_claims.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace driftlab {
namespace {

/// A number with a fixed count of decimals; what rounds to zero has no sign.
std::string decimal(double value, int decimals) {
  char buffer[64];
  const auto [stop, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals);
  if (error != std::errc{}) {
    return "?";
  }
  std::string text(buffer, stop);
  if (text.find_first_not_of("-0.") == std::string::npos && text.front() == '-') {
    text.erase(0, 1);
  }
  return text;
}

/// Decimals that show two digits of the larger end of an interval: `usual` for what is large enough, at most 6.
int decimals_for(const Interval& range, int usual) {
  const double size = std::fmax(std::fabs(range.low), std::fabs(range.high));
  if (!(size > 0.0 && std::isfinite(size))) {
    return usual;
  }
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(size))), usual, 6);
}

/// value unit [low, high], in `factor` of SI.
std::string shown(const Estimate& estimate, double factor, std::string_view unit, int usual) {
  const Interval range{factor * estimate.ci95.low, factor * estimate.ci95.high};
  const int decimals = decimals_for(range, usual);
  std::string text = decimal(factor * estimate.value, decimals);
  text.append(unit).append(" [").append(decimal(range.low, decimals)).append(", ");
  return text.append(decimal(range.high, decimals)).append("]");
}

bool is_gain(const PairedDifference& pair) { return pair.difference_m.ci95.high < 0.0; }
bool is_loss(const PairedDifference& pair) { return pair.difference_m.ci95.low > 0.0; }
bool of_practical_size(const PairedDifference& pair) { return std::fabs(pair.relative.value) >= kPracticalSize; }

std::string sentence(const PairedDifference& pair) {
  std::string text = pair.filter;
  text.append(" against ").append(pair.against).append(": ").append(shown(pair.relative, 100.0, " %", 1)).append(", ");
  text.append(shown(pair.difference_m, 1.0, " m", 2)).append(".");
  if ((is_gain(pair) || is_loss(pair)) && !of_practical_size(pair)) {
    text.append(" Significant, but of no practical size: below 1 %.");
  }
  return text;
}

Claim better(std::string claim, const PairedDifference& pair) {
  return {std::move(claim), is_gain(pair) && of_practical_size(pair), sentence(pair)};
}

Claim size(std::string claim, const PairedDifference& pair, double relative) {
  return {std::move(claim), pair.relative.ci95.contains(relative), sentence(pair)};
}

Claim cause_of(const Attribution& parts) {
  Claim cause{"The gain of M_dyn(GMWM) comes from following the dynamics.", false, ""};
  const double switched = parts.switching.difference_m.value;
  const double whole = parts.total.difference_m.value;
  cause.supported = is_gain(parts.total) && of_practical_size(parts.total) && is_gain(parts.switching) &&
                    of_practical_size(parts.switching) && switched < 0.5 * whole;
  cause.because.append("Of ").append(decimal(whole, 2)).append(" m, low-frequency process noise brings ");
  cause.because.append(decimal(parts.low_frequency_noise.difference_m.value, 2)).append(" m, Gauss-Markov states ");
  cause.because.append(decimal(parts.gauss_markov_states.difference_m.value, 2)).append(" m and switching ");
  cause.because.append(shown(parts.switching.difference_m, 1.0, " m", 2)).append(".");
  return cause;
}

}  // namespace

std::optional<Attribution> attribute(const OutageEvaluation& evaluation) {
  const auto total = evaluation.difference("M_dyn(GMWM)", "M_stat(AV)");
  const auto low = evaluation.difference("M_stat(Neq)+RW", "M_stat(AV)");
  const auto states = evaluation.difference("M_stat(GMWM)", "M_stat(Neq)+RW");
  const auto switching = evaluation.difference("M_dyn(GMWM)", "M_stat(GMWM)");
  const auto switching_av = evaluation.difference("M_dyn(AV)", "M_stat(AV)");
  if (!total || !low || !states || !switching || !switching_av) {
    return std::nullopt;
  }
  return Attribution{*total, *low, *states, *switching, *switching_av};
}

std::vector<Claim> judge_claims(const OutageEvaluation& evaluation) {
  const auto parts = attribute(evaluation);
  const auto step = evaluation.difference("M_dyn(GMWM)", "M_dyn(AV)");
  if (!parts || !step) {
    return {};
  }
  std::vector<Claim> claims;
  claims.push_back(
      better("Following the dynamics with Allan-variance parameters, M_dyn(AV), lowers the position error "
             "against one static model, M_stat(AV).",
             parts->switching_av));
  claims.push_back(size("That gain is 24 % (Table 6: 17.3 m to 13.1 m).", parts->switching_av, 13.107 / 17.333 - 1.0));
  claims.push_back(better("The model found by GMWM, M_dyn(GMWM), lowers the error further than M_dyn(AV).", *step));
  claims.push_back(better("M_dyn(GMWM) lowers the error against M_stat(AV).", parts->total));
  claims.push_back(size("That gain is 37 % (Table 6: 17.3 m to 10.9 m).", parts->total, 10.881 / 17.333 - 1.0));
  claims.push_back(cause_of(*parts));
  return claims;
}

}  // namespace driftlab
