#include "core/navigate/drive/document.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace driftlab::drive {
namespace {

constexpr double kLeastFixes = 20.0;  ///< [s] between two outages of one run
constexpr double kLongestArm = 30.0;  ///< [m]
constexpr std::array<std::pair<Vehicle, std::string_view>, 6> kVehicles{{{Vehicle::Road, "road"},
                                                                         {Vehicle::Rail, "rail"},
                                                                         {Vehicle::Rover, "rover"},
                                                                         {Vehicle::Air, "air"},
                                                                         {Vehicle::Foot, "foot"},
                                                                         {Vehicle::Boat, "boat"}}};
constexpr std::array<std::pair<TimeScale, std::string_view>, 5> kScales{{{TimeScale::Gps, "gps"},
                                                                         {TimeScale::Utc, "utc"},
                                                                         {TimeScale::Unix, "unix"},
                                                                         {TimeScale::Boot, "boot"},
                                                                         {TimeScale::Row, "row"}}};

tl::unexpected<Error> wrong(std::string member, std::string sentence) {
  return fail(ErrorCode::InvalidArgument, std::move(sentence), {{"parameter", std::move(member)}});
}

Status check_arm(const Vector3& arm, const char* member) {
  if (!arm.allFinite() || arm.norm() > kLongestArm) {
    return wrong(member, "A lever arm of " + std::to_string(static_cast<long>(std::min(arm.norm(), 1e9))) +
                             " m is longer than any vehicle driftlab knows; arms are given in metres.");
  }
  return {};
}

}  // namespace

std::string_view name_of(Vehicle vehicle) { return kVehicles[static_cast<std::size_t>(vehicle)].second; }

std::optional<Vehicle> parse_vehicle(std::string_view name) {
  for (const auto& [vehicle, text] : kVehicles) {
    if (text == name) {
      return vehicle;
    }
  }
  return std::nullopt;
}

bool moves_along_its_nose(Vehicle vehicle) {
  return vehicle == Vehicle::Road || vehicle == Vehicle::Rail || vehicle == Vehicle::Rover;
}

std::string_view name_of(TimeScale scale) { return kScales[static_cast<std::size_t>(scale)].second; }

std::optional<TimeScale> parse_time_scale(std::string_view name) {
  for (const auto& [scale, text] : kScales) {
    if (text == name) {
      return scale;
    }
  }
  return std::nullopt;
}

Status check(const Document& document) {
  for (const auto& [arm, member] : {std::pair{document.gnss.lever_arm_m, "gnss.lever_arm_m"},
                                    std::pair{document.reference.lever_arm_m, "reference.lever_arm_m"}}) {
    if (auto status = check_arm(arm, member); !status) {
      return status;
    }
  }
  if (document.odometer) {
    if (auto status = check_arm(document.odometer->lever_arm_m, "odometer.lever_arm_m"); !status) {
      return status;
    }
  }
  const OutagePlan& plan = document.outages;
  if (plan.duration_s.empty() || plan.duration_s.size() > 16) {
    return wrong("outages.duration_s", "Between 1 and 16 durations of outages are given.");
  }
  if (plan.at_s.empty() && plan.every_s.size() != plan.duration_s.size()) {
    return wrong("outages.every_s", "Every duration of an outage has a period of its own in every_s.");
  }
  for (std::size_t i = 0; i < plan.duration_s.size(); ++i) {
    if (!(plan.duration_s[i] > 0.0 && plan.duration_s[i] <= 3600.0)) {
      return wrong("outages.duration_s", "An outage lasts more than 0 and at most 3600 s.");
    }
    if (plan.at_s.empty() && !(plan.every_s[i] >= plan.duration_s[i] + kLeastFixes && plan.every_s[i] <= 1e5)) {
      return wrong("outages.every_s", "A period leaves at least 20 s of fixes after its outage.");
    }
  }
  if (plan.phases < 1 || plan.phases > 64) {
    return wrong("outages.phases", "There are 1 to 64 phases.");
  }
  if (!(plan.settle_s >= 0.0 && plan.settle_s <= 1e5)) {
    return wrong("outages.settle_s", "The time to settle is not negative.");
  }
  return {};
}

}  // namespace driftlab::drive
