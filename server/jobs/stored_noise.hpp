#pragma once
/// The noise of a device in the numbers that other programs ask for (core/export/imu_noise.hpp), from stored results.
#include "core/export/imu_noise.hpp"
#include "server/store/store.hpp"

#include <string>

namespace driftlab::server {

/// `device`: id or name. Cost: two joint fits with their profiles for each axis, a fraction of a second in all.
/// Errors: NotFound (device; nothing characterised of it); those of the store.
[[nodiscard]] Result<ImuNoise> stored_noise(Store& store, const std::string& device);

}  // namespace driftlab::server
