#include "server/jobs/told_glance.hpp"

#include "core/campaign/glance.hpp"
#include "schema/json/reported_channel.hpp"
#include "schema/json/stored_member.hpp"

#include <utility>

namespace driftlab::server {

Result<ToldGlance> told_glance(const Json& channel) {
  const auto fits = channel.find("fits");
  if (fits == channel.end() || !fits->is_array() || fits->empty()) {
    return ToldGlance{};
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
  return ToldGlance{Json{{"model", read->fit.model},
                         {"N", driftlab::to_json(glance.density)},
                         {"fits", glance.fits ? Json(*glance.fits) : Json(nullptr)},
                         {"level", driftlab::name_of(glance.level)},
                         {"reason", text_or_null(glance.reason)}},
                    glance.level};
}

}  // namespace driftlab::server
