// Whether recordings that somebody puts beside each other have one structure.
#include "core/analysis/compare_structures.hpp"
#include "schema/json/pooled_sensor.hpp"
#include "schema/json/reported_channel.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/api/newest_fits.hpp"

namespace driftlab::server {
namespace {

constexpr std::size_t kFewest = 2;
constexpr std::size_t kMost = 8;

Error not_a_list(std::string detail) { return {ErrorCode::InvalidArgument, std::move(detail), {{"parameter", "of"}}}; }

/// `rec_…:gz`, the channel in percent-encoding, so that it may hold commas; without one the recording's first.
Result<FittedRow> row_of(Store& store, std::string_view item) {
  const std::size_t colon = std::min(item.find(':'), item.size());
  const auto channel = percent_decode(item.substr(std::min(colon + 1, item.size())), false);
  if (!channel) {
    return fail(not_a_list("The channel of " + std::string(item) + " is not in percent-encoding."));
  }
  const auto recording = store.recording(std::string(item.substr(0, colon)));
  if (!recording) {
    return fail(recording.error());
  }
  const auto fits = newest_fits(store, recording->id);
  if (!fits) {
    return fail(fits.error());
  }
  if (fits->empty()) {
    return fail(not_characterised(recording->id));
  }
  const std::string& wanted = channel->empty() ? fits->front().channel : *channel;
  Json documents = Json::array();
  for (const Fit& fit : *fits) {
    if (fit.channel == wanted) {
      documents.push_back(stored(fit.document_json));
    }
  }
  if (documents.empty()) {
    return fail(no_channel(recording->id, wanted));
  }
  return FittedRow{recording->id + ":" + wanted, fits_from_json(documents)};
}

Result<Response> get_structure(ApiContext& context, const Request& request) {
  const auto of = request.parameter("of");
  std::vector<FittedRow> rows;
  std::string_view rest = of.value_or("");
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    auto row = row_of(context.store, rest.substr(0, comma));
    if (!row) {
      return fail(row.error());
    }
    rows.push_back(std::move(*row));
    if (rows.size() > kMost) {
      break;
    }
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  if (rows.size() < kFewest || rows.size() > kMost) {
    return fail(not_a_list("Name two to eight recordings, with their channels: ?of=rec_…:gz,rec_…:gz"));
  }
  return json_response(200, driftlab::to_json(compare_structures(rows)));
}

}  // namespace

void add_structure_routes(Router& router, ApiContext& context) {
  router.add(from_rows({"GET", "/v1/structures", "getStructure", {"of"}, Handler([&](const Request& request) {
                          return get_structure(context, request);
                        })}));
}

}  // namespace driftlab::server
