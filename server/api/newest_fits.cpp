#include "server/api/newest_fits.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

/// A recording has this many fits at most: nine candidates of every axis of an inertial unit are 54.
constexpr int kMostFits = 2000;

}  // namespace

Result<std::vector<Fit>> newest_fits(Store& store, const std::string& recording_id) {
  FitFilter filter;
  filter.recording_id = recording_id;
  filter.latest_only = true;
  auto fits = store.fits(filter, Page{"", kMostFits});
  if (!fits || fits->empty()) {
    return fits;
  }
  const std::string newest = std::max_element(fits->begin(), fits->end(), [](const Fit& a, const Fit& b) {
                               return a.created_at < b.created_at;
                             })->job_id;
  std::erase_if(*fits, [&](const Fit& fit) { return fit.job_id != newest; });
  return fits;
}

Error not_characterised(const std::string& recording_id) {
  return {ErrorCode::NotFound, "The recording " + recording_id + " has not been characterised.", {}};
}

Error no_channel(const std::string& recording_id, const std::string& name) {
  return {ErrorCode::NotFound,
          "The recording " + recording_id + " has no channel '" + name + "' in its result.",
          {{"parameter", "channel"}}};
}

}  // namespace driftlab::server
