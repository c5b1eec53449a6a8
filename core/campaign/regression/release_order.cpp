#include "core/campaign/regression/release_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab::regression {

ReleaseOrder order_of(const Request& request, const ComparedSessions& sessions) {
  struct Release {
    double key;
    std::size_t sessions;
  };
  std::vector<const Recordings*> arms{&request.baseline, &request.candidate};
  const std::size_t before = std::min(request.before_baseline.value_or(request.history.size()), request.history.size());
  const auto last = static_cast<double>(request.history.size());
  std::vector<Release> releases{{static_cast<double>(before) - 0.5, sessions.baseline.sessions.size()},
                                {last, sessions.candidate.sessions.size()}};
  for (std::size_t i = 0; i < request.history.size(); ++i) {
    arms.push_back(&request.history[i]);
    releases.push_back({static_cast<double>(i), sessions.history[i].sessions.size()});
  }
  std::vector<double> began;
  for (const Recordings* arm : arms) {
    double first = std::numeric_limits<double>::infinity();
    for (const ComparedRecording& recording : arm->recordings) {
      first = std::min(first, recording.began_s.value_or(-std::numeric_limits<double>::infinity()));
    }
    began.push_back(first);
  }
  const bool timed = std::all_of(began.begin(), began.end(), [](double time) { return std::isfinite(time); });
  std::vector<double> keys;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    releases[i].key = timed ? began[i] : releases[i].key;
    keys.push_back(releases[i].key);
  }
  std::sort(keys.begin(), keys.end());
  const auto rank = [&](double key) {
    return static_cast<double>(std::lower_bound(keys.begin(), keys.end(), key) - keys.begin());
  };
  ReleaseOrder order;
  for (const Release& release : releases) {
    order.position.insert(order.position.end(), release.sessions, rank(release.key));
  }
  order.anchor = rank(releases[0].key);
  order.candidate = rank(releases[1].key);
  return order;
}

}  // namespace driftlab::regression
