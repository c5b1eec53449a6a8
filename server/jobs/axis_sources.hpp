#pragma once
/// The latest stored results of a sensor axis as the campaign's arithmetic takes them.
#include "core/campaign/sensor_sources.hpp"
#include "server/store/store.hpp"

#include <vector>

namespace driftlab::server {

/// In the order of `latest`, which is the same however and whenever the recordings came: what is computed from several
/// of them is then the same to the bit. Error: Internal, for a document that driftlab has not written.
[[nodiscard]] Result<std::vector<TableSource>> sources_of(const AxisResults& axis);

}  // namespace driftlab::server
