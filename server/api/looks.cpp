// One channel of a recording as a person looks at it: spectrum, histogram, spectrogram.
#include "core/analysis/stored_channel.hpp"
#include "schema/json/channel_look.hpp"
#include "schema/json/reported_channel.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/jobs/job_cost.hpp"
#include "server/jobs/stored_recordings.hpp"

#include <charconv>

namespace driftlab::server {
namespace {

/// A parameter as a whole number from `least` to `most`; `otherwise` where it is not given.
Result<std::size_t> whole(const Request& request, std::string_view name, std::size_t least, std::size_t most,
                          std::size_t otherwise) {
  const auto text = request.parameter(name);
  if (!text) {
    return otherwise;
  }
  std::size_t value = 0;
  const auto [stop, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc{} || stop != text->data() + text->size() || value < least || value > most) {
    return fail(ErrorCode::InvalidArgument,
                "The parameter " + std::string(name) + " is a whole number from " + std::to_string(least) + " to " +
                    std::to_string(most) + ".",
                {{"parameter", std::string(name)}});
  }
  return value;
}

/// Whether a look at that recording takes no more memory than one may: its rows are read and put into order whole.
Status admit_look(ApiContext& context, const Request& request) {
  constexpr std::int64_t kBytesPerRow = 24;
  const std::int64_t most = request.budgets->look_bytes;
  const Json recordings = Json::array({Json{{"id", request.parameters[0]}}});
  for (const RecordingSize& size : sizes_of(recordings, context.store)) {
    if (size.rows > most / kBytesPerRow) {
      return fail(ErrorCode::LimitExceeded,
                  "The recording has " + std::to_string(size.rows) + " rows, and a look at one of its channels takes " +
                      std::to_string(kBytesPerRow) + " bytes of each " + naming_budget("look_bytes", most) + ".",
                  {{"limit", std::to_string(most / kBytesPerRow)}});
    }
  }
  return {};
}

Result<ChannelLook> look_of(ApiContext& context, const Request& request) {
  const auto channel = request.parameter("channel");
  if (!channel) {
    return fail(ErrorCode::InvalidArgument, "Name a column of the recording: ?channel=…", {{"parameter", "channel"}});
  }
  if (auto admitted = admit_look(context, request); !admitted) {
    return fail(admitted.error());
  }
  StoredRecordings source(context.store, context.blobs, {{request.parameters[0], std::nullopt, ""}},
                          context.expect_sound_columns);
  return ChannelLook::open(source, *channel);
}

Result<Response> get_spectrum(ApiContext& context, const Request& request) {
  const auto points = whole(request, "points", 10, 2000, 200);
  if (!points) {
    return fail(points.error());
  }
  const std::string_view scale = request.parameter("scale").value_or("log");
  if (scale != "log" && scale != "linear") {
    return fail(ErrorCode::InvalidArgument, "The scale is log or linear.", {{"parameter", "scale"}});
  }
  const auto look = look_of(context, request);
  if (!look) {
    return fail(look.error());
  }
  const auto spectrum = look->spectrum(scale == "log" ? FrequencyScale::Log : FrequencyScale::Linear, *points);
  return spectrum ? Result<Response>(json_response(200, spectrum_to_json(*look, *spectrum))) : fail(spectrum.error());
}

Result<Response> get_histogram(ApiContext& context, const Request& request) {
  const auto bins = whole(request, "bins", 8, 512, 64);
  if (!bins) {
    return fail(bins.error());
  }
  const auto look = look_of(context, request);
  return look ? Result<Response>(json_response(200, histogram_to_json(*look, look->histogram(*bins))))
              : fail(look.error());
}

/// The model that the parameter `fit` names, of a fit of that very channel.
Result<std::optional<driftlab::Model>> model_asked(ApiContext& context, const Request& request,
                                                   const ChannelLook& look) {
  const auto id = request.parameter("fit");
  if (!id) {
    return std::optional<driftlab::Model>();
  }
  const auto fit = context.store.fit(*id);
  if (!fit) {
    return fail(fit.error());
  }
  if (fit->recording_id != request.parameters[0] || fit->channel != request.parameter("channel").value_or("")) {
    return fail(ErrorCode::InvalidArgument, "The fit " + fit->id + " is one of another channel.",
                {{"parameter", "fit"}});
  }
  const auto told = stored_fit_from_json(stored(fit->document_json));
  if (!told) {
    return fail(told.error());
  }
  auto model = model_of(told->fit, look.unit().dimension);
  if (!model) {
    return fail(ErrorCode::InvalidArgument, "The fit " + fit->id + " leaves a parameter open: it implies no density.",
                {{"parameter", "fit"}});
  }
  return model;
}

Result<Response> get_spectrogram(ApiContext& context, const Request& request) {
  const auto times = whole(request, "times", 1, 512, 160);
  const auto bands = whole(request, "bands", 1, 128, 48);
  if (!times || !bands) {
    return fail(!times ? times.error() : bands.error());
  }
  const auto look = look_of(context, request);
  if (!look) {
    return fail(look.error());
  }
  const auto asked = model_asked(context, request, *look);
  if (!asked) {
    return fail(asked.error());
  }
  const auto& model = *asked;
  const auto ratio = look->ratio(model ? &*model : nullptr, *times, *bands);
  return ratio ? Result<Response>(json_response(200, spectrogram_to_json(*look, *ratio))) : fail(ratio.error());
}

}  // namespace

void add_look_routes(Router& router, ApiContext& context) {
  router.add(in_lane(Lane::Slow, {"GET",
                                  "/v1/recordings/{id}/spectrum",
                                  "getSpectrum",
                                  {"channel", "scale", "points"},
                                  Handler([&](const Request& request) { return get_spectrum(context, request); })}));
  router.add(in_lane(Lane::Slow, {"GET",
                                  "/v1/recordings/{id}/histogram",
                                  "getHistogram",
                                  {"channel", "bins"},
                                  Handler([&](const Request& request) { return get_histogram(context, request); })}));
  router.add(in_lane(Lane::Slow, {"GET",
                                  "/v1/recordings/{id}/spectrogram",
                                  "getSpectrogram",
                                  {"channel", "times", "bands", "fit"},
                                  Handler([&](const Request& request) { return get_spectrogram(context, request); })}));
}

}  // namespace driftlab::server
