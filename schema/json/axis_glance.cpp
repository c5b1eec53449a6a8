#include "schema/json/axis_glance.hpp"

#include "core/campaign/glance.hpp"
#include "schema/json/reported_channel.hpp"
#include "schema/json/stored_member.hpp"

#include <utility>

namespace driftlab {

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
                         {"N", to_json(glance.density)},
                         {"fits", glance.fits ? Json(*glance.fits) : Json(nullptr)},
                         {"level", name_of(glance.level)},
                         {"reason", text_or_null(glance.reason)}},
                    glance.level};
}

}  // namespace driftlab
