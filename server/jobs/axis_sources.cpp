#include "server/jobs/axis_sources.hpp"

#include "schema/json/reported_channel.hpp"

namespace driftlab::server {

Result<std::vector<TableSource>> sources_of(const AxisResults& axis) {
  std::vector<TableSource> sources;
  for (const ChannelResult& result : axis.latest) {
    auto channel = parse_json(result.document_json).and_then(reported_channel_from_json);
    if (!channel) {
      return fail(channel.error());
    }
    sources.push_back({result.recording_id, result.condition, std::move(*channel), result.id});
  }
  return sources;
}

}  // namespace driftlab::server
