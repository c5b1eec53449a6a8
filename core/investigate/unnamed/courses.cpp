#include "core/investigate/unnamed/courses.hpp"

#include "core/investigate/unnamed/profile_bins.hpp"
#include "core/investigate/unnamed/unnamed_effect.hpp"

#include <algorithm>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kTimeBins = 32;     ///< chosen, not measured, as all that follow
constexpr std::size_t kTurns = 8;         ///< of the folds within a bin of time
constexpr std::size_t kSegments = 128;    ///< of a single recording that take turns
constexpr std::size_t kMostPhases = 128;  ///< bins of a period
constexpr std::size_t kLooked = 20'000;   ///< values by which bins are placed

/// Of member r alone, without bins yet.
Courses course_of_one(const ChannelGroup& group, std::size_t r, Against against, double period_s) {
  const StudyRecording& own = *group.members[r].recording;
  Courses courses;
  courses.against = against;
  courses.members = {r};
  courses.of.resize(group.members.size());
  courses.of[r] = course_of(against, own, group.axis(), period_s).part(own.begin, own.count());
  return courses;
}

}  // namespace

std::size_t Courses::part_of(std::size_t i, std::size_t count) const {
  if (against == Against::Phase) {
    const double share = static_cast<double>(i) / static_cast<double>(count);
    return static_cast<std::size_t>(share * periods) % 2;
  }
  const std::size_t segments = against == Against::Time ? kTimeBins * kTurns : kSegments;
  return i * segments / count % 2;
}

Courses courses_of(const ChannelGroup& group, Against against) {
  Courses courses;
  courses.against = against;
  std::vector<double> looked;
  for (std::size_t r = 0; r < group.members.size(); ++r) {
    const StudyRecording& own = *group.members[r].recording;
    const Series course = course_of(against, own, group.axis());
    courses.of.push_back(course.empty() ? Series() : course.part(own.begin, own.count()));
    if (course.empty() || own.count() < kFewestOfProfile) {
      continue;
    }
    courses.members.push_back(r);
    const std::size_t step = std::max<std::size_t>(1, own.count() * group.members.size() / kLooked);
    for (std::size_t i = 0; i < own.count(); i += step) {
      looked.push_back(courses.of.back()[i]);
    }
  }
  courses.edge = edges_of(std::move(looked));
  return courses;
}

Courses time_of(const ChannelGroup& group, std::size_t r) {
  const StudyRecording& own = *group.members[r].recording;
  Courses courses = course_of_one(group, r, Against::Time, 0.0);
  for (std::size_t k = 0; k <= kTimeBins; ++k) {
    courses.edge.push_back(own.time_s(own.begin) + static_cast<double>(k) / static_cast<double>(kTimeBins) *
                                                       static_cast<double>(own.count()) * own.dt_s);
  }
  return courses;
}

Courses phases_of(const ChannelGroup& group, std::size_t r, const FoundPeriod& found) {
  const StudyRecording& own = *group.members[r].recording;
  Courses courses = course_of_one(group, r, Against::Phase, found.period_s);
  courses.period_s = found.period_s;
  courses.periods = static_cast<double>(own.count()) * own.dt_s / found.period_s;
  courses.tried = found.tried;
  const std::size_t block = std::max<std::size_t>(1, own.count() / kMostBlocks);
  const double most = found.period_s / (own.dt_s * static_cast<double>(block));
  const auto bins = std::max<std::size_t>(2, std::min({2 * found.teeth, kMostPhases, static_cast<std::size_t>(most)}));
  for (std::size_t k = 0; k <= bins; ++k) {
    courses.edge.push_back(found.period_s * static_cast<double>(k) / static_cast<double>(bins));
  }
  return courses;
}

}  // namespace driftlab::investigate
