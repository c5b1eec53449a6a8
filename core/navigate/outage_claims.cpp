#include "core/navigate/outage_claims.hpp"

#include <charconv>
#include <cmath>

namespace driftlab {
namespace {

/// A number with a fixed count of decimals.
std::string decimal(double value, int decimals) {
  char buffer[64];
  const auto [stop, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals);
  return error == std::errc{} ? std::string(buffer, stop) : std::string("?");
}

std::string percent(const Estimate& relative) {
  std::string text = decimal(100.0 * relative.value, 1);
  text.append(" % [").append(decimal(100.0 * relative.ci95.low, 1)).append(", ");
  return text.append(decimal(100.0 * relative.ci95.high, 1)).append("]");
}

std::string sentence(const PairedDifference& pair) {
  std::string text = pair.filter;
  text.append(" against ").append(pair.against).append(": ").append(percent(pair.relative)).append(", ");
  text.append(decimal(pair.difference_m.value, 2)).append(" m [").append(decimal(pair.difference_m.ci95.low, 2));
  return text.append(", ").append(decimal(pair.difference_m.ci95.high, 2)).append("].");
}

Claim better(std::string claim, const PairedDifference& pair) {
  return {std::move(claim), pair.difference_m.ci95.high < 0.0, sentence(pair)};
}

Claim size(std::string claim, const PairedDifference& pair, double relative) {
  return {std::move(claim), pair.relative.ci95.contains(relative), sentence(pair)};
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
  Claim cause{"The gain of M_dyn(GMWM) comes from following the dynamics.", false, ""};
  const double switched = parts->switching.difference_m.value;
  const double whole = parts->total.difference_m.value;
  cause.supported = parts->switching.difference_m.ci95.high < 0.0 && switched < 0.5 * whole;
  cause.because.append("Of ").append(decimal(whole, 2)).append(" m, low-frequency process noise brings ");
  cause.because.append(decimal(parts->low_frequency_noise.difference_m.value, 2)).append(" m, Gauss-Markov states ");
  cause.because.append(decimal(parts->gauss_markov_states.difference_m.value, 2)).append(" m and switching ");
  cause.because.append(decimal(switched, 2)).append(" m [").append(decimal(parts->switching.difference_m.ci95.low, 2));
  cause.because.append(", ").append(decimal(parts->switching.difference_m.ci95.high, 2)).append("].");
  claims.push_back(std::move(cause));
  return claims;
}

}  // namespace driftlab
