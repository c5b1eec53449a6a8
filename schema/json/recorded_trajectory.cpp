#include "schema/json/recorded_trajectory.hpp"

#include "core/signal/angle.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kMostPoses = 100000;
constexpr std::array kAngles{"roll_deg", "pitch_deg", "heading_deg"};

bool is_vector(const Json& value) {
  return value.is_array() && value.size() == 3 && value[0].is_number() && value[1].is_number() && value[2].is_number();
}

}  // namespace

RecordedTrajectory recorded_from_json(const Json& document, const std::string& pointer, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  const Json* const times = reader.member("time_s");
  const Json* const velocities = reader.member("velocity_ned_m_s");
  std::array<const Json*, 3> angles{};
  for (std::size_t k = 0; k < kAngles.size(); ++k) {
    angles[k] = reader.member(kAngles[k]);
  }
  reader.reject_unknown();
  if (times == nullptr || !times->is_array() || times->size() < 4 || times->size() > kMostPoses) {
    faults.add(pointer + "/time_s", ErrorCode::InvalidArgument, "A recorded trajectory has 4 to 100000 times.");
    return {};
  }
  const auto fits = [&](const Json* list, const char* name, const auto& good) {
    const bool right = list != nullptr && list->is_array() && list->size() == times->size() &&
                       std::all_of(list->begin(), list->end(), good);
    if (!right) {
      faults.add(pointer + "/" + name, ErrorCode::InvalidArgument, "A list as long as that of the times belongs here.");
    }
    return right;
  };
  const auto is_number = [](const Json& value) { return value.is_number(); };
  bool good = fits(times, "time_s", is_number) && fits(velocities, "velocity_ned_m_s", is_vector);
  for (std::size_t k = 0; good && k < kAngles.size(); ++k) {
    good = angles[k] == nullptr || fits(angles[k], kAngles[k], is_number);
  }
  if (!good) {
    return {};
  }
  std::vector<RecordedPose> poses(times->size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Json& v = (*velocities)[i];
    const auto angle = [&](std::size_t k) {
      return angles[k] == nullptr ? 0.0 : (*angles[k])[i].get<double>() * kDegree;
    };
    poses[i].time_s = (*times)[i].get<double>();
    poses[i].velocity_ned_m_s = {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
    poses[i].attitude = {angle(0), angle(1), angle(2)};
  }
  return {std::move(poses), {.pitch = angles[1] == nullptr, .heading = angles[2] == nullptr}};
}

Json recorded_to_json(const std::vector<RecordedPose>& poses) {
  Json times = Json::array();
  Json velocities = Json::array();
  Json roll = Json::array();
  Json pitch = Json::array();
  Json heading = Json::array();
  for (const RecordedPose& pose : poses) {
    const Vector3& v = pose.velocity_ned_m_s;
    times.push_back(number(pose.time_s));
    velocities.push_back(Json{number(v.x()), number(v.y()), number(v.z())});
    roll.push_back(number_in(pose.attitude.roll_rad, kDegree));
    pitch.push_back(number_in(pose.attitude.pitch_rad, kDegree));
    heading.push_back(number_in(pose.attitude.heading_rad, kDegree));
  }
  return Json{{"time_s", std::move(times)},
              {"velocity_ned_m_s", std::move(velocities)},
              {"roll_deg", std::move(roll)},
              {"pitch_deg", std::move(pitch)},
              {"heading_deg", std::move(heading)}};
}

}  // namespace driftlab
