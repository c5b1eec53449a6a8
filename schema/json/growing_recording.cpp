#include "schema/json/growing_recording.hpp"

namespace driftlab {

Json growing_recording_to_json(const GrowingRecording& look, const Unit& unit) {
  Json tau = Json::array();
  Json deviation = Json::array();
  Json ci95 = Json::array();
  for (std::size_t i = 0; i < look.tau_s.size(); ++i) {
    tau.push_back(number(look.tau_s[i]));
    deviation.push_back(number(look.deviation[i]));
    ci95.push_back(interval(look.ci95[i]));
  }
  const ParameterUnit lab = lab_unit(unit.dimension, 1);
  return Json{
      {"samples", look.samples},
      {"seconds", number(look.seconds)},
      {"rate_hz", look.rate_hz ? number(*look.rate_hz) : Json(nullptr)},
      {"gaps", look.gaps},
      {"unit", unit.symbol},
      {"allan", Json{{"tau_s", std::move(tau)}, {"deviation", std::move(deviation)}, {"ci95", std::move(ci95)}}},
      {"N", look.n ? quantity(*look.n, unit.factor * lab.per_si, lab.symbol) : Json(nullptr)},
      {"N_reason", look.n ? Json(nullptr) : Json(look.n_reason)},
      {"next", look.tau_s.empty() ? Json(nullptr)
                                  : Json{{"tau_s", number(look.next_tau_s)}, {"in_s", number(look.next_in_s)}}}};
}

}  // namespace driftlab
