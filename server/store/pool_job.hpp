#pragma once
/// The job that pools the latest results of one sensor axis (server/jobs/pool.cpp), as the store queues it.
#include "server/store/store.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

inline constexpr std::string_view kPoolKind = "pool";
/// Grows whenever the same results could give other figures.
inline constexpr int kPoolVersion = 1;

/// The job of exactly these channel results, in whatever order they are named: its request is canonical, so that an
/// equal set is one job. Names and ids are those that the store keeps; none of them needs escaping in JSON.
[[nodiscard]] NewJob pool_job(const SensorAxis& axis, std::vector<std::string> members);

}  // namespace driftlab::server
