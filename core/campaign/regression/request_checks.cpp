#include "core/campaign/regression/request_checks.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace driftlab::regression {
namespace {

/// The same samples twice are no second session, and candidate and baseline at once show that nothing changed.
Status check_copies(const Request& request) {
  std::vector<const ComparedRecording*> all;
  for (const Recordings* arm : {&request.baseline, &request.candidate}) {
    for (const ComparedRecording& recording : arm->recordings) {
      all.push_back(&recording);
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto& a = all[i]->channels;
      const auto& b = all[j]->channels;
      const bool copies = !a.empty() && a.size() == b.size() &&
                          std::equal(a.begin(), a.end(), b.begin(), [](const auto& one, const auto& other) {
                            return one.result.haar.variance == other.result.haar.variance;
                          });
      if (copies) {
        return fail(ErrorCode::InvalidArgument,
                    "The recordings " + all[j]->id + " and " + all[i]->id + " hold the same samples.",
                    {{"recording", all[i]->id}});
      }
    }
  }
  return {};
}

}  // namespace

Status check_arms(const Request& request) {
  for (const auto& [arm, name] : {std::pair{&request.baseline, "baseline"}, {&request.candidate, "candidate"}}) {
    if (arm->recordings.empty()) {
      return fail(ErrorCode::InvalidArgument, std::string("The ") + name + " has no recordings.", {{"arm", name}});
    }
  }
  std::set<std::string> base;
  for (const ComparedRecording& recording : request.baseline.recordings) {
    base.insert(recording.id);
  }
  for (const ComparedRecording& recording : request.candidate.recordings) {
    if (base.contains(recording.id)) {
      return fail(ErrorCode::InvalidArgument, "The recording " + recording.id + " is in both arms.",
                  {{"recording", recording.id}});
    }
  }
  return check_copies(request);
}

}  // namespace driftlab::regression
