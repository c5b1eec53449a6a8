#include "server/jobs/told_glance.hpp"

#include "core/campaign/glance.hpp"
#include "schema/json/reported_channel.hpp"
#include "schema/json/stored_member.hpp"

namespace driftlab::server {

Result<Glance> told_glance(const Json& channel) {
  const auto fits = channel.find("fits");
  if (fits == channel.end() || !fits->is_array() || fits->empty()) {
    return Glance{};
  }
  Json best = fits->front();
  const auto coefficients = channel.find("allan_parameters");
  if (coefficients != channel.end() && coefficients->contains("N")) {
    best["density"] = (*coefficients)["N"];
  }
  const auto read = stored_fit_from_json(best);
  if (!read) {
    return fail(read.error());
  }
  const AxisGlance glance = glance_of(read->fit, read->density);
  const Json document{{"model", read->fit.model},
                      {"N", driftlab::to_json(glance.density)},
                      {"fits", glance.fits ? Json(*glance.fits) : Json(nullptr)},
                      {"level", driftlab::name_of(glance.level)},
                      {"reason", text_or_null(glance.reason)}};
  return Glance{to_text(document), static_cast<int>(glance.level)};
}

}  // namespace driftlab::server
