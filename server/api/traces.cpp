// A recording's samples as a screen can show them.
#include "core/analysis/draw_trace.hpp"
#include "core/signal/number.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/recording_survey.hpp"
#include "schema/json/recording_trace.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/problem.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

namespace driftlab::server {
namespace {

constexpr int kPoints = 1200;
constexpr int kMostPoints = 20000;

/// A parameter as a number, where it is given.
Result<std::optional<double>> real_parameter(const Request& request, std::string_view name) {
  const auto text = request.parameter(name);
  if (!text) {
    return std::nullopt;
  }
  const auto value = parse_double(*text);
  if (!value || !std::isfinite(*value)) {
    return fail(ErrorCode::InvalidArgument, "The parameter " + std::string(name) + " is a number of seconds.",
                {{"parameter", std::string(name)}});
  }
  return value;
}

Result<std::size_t> points_of(const Request& request) {
  const auto text = request.parameter("points");
  int points = kPoints;
  if (text) {
    const auto [stop, error] = std::from_chars(text->data(), text->data() + text->size(), points);
    if (error != std::errc{} || stop != text->data() + text->size() || points < 1 || points > kMostPoints) {
      return fail(ErrorCode::InvalidArgument, "The points are a whole number from 1 to 20000.",
                  {{"parameter", "points"}});
    }
  }
  return static_cast<std::size_t>(points);
}

/// Three float32, little-endian, of each stretch: seconds since the first one begins, least and greatest value; NaN
/// where it has no sample.
Response binary_trace(const RecordingTrace& trace, const std::optional<std::string>& unit) {
  Response response;
  response.content_type = "application/octet-stream";
  const double start_s = trace.time_s.empty() ? 0.0 : trace.time_s.front();
  response.body.reserve(trace.buckets.size() * 3 * sizeof(float));
  const auto put = [&](double value) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    for (unsigned shift = 0; shift < 32; shift += 8) {
      response.body.push_back(static_cast<char>(bits >> shift & 0xFFU));
    }
  };
  for (std::size_t i = 0; i < trace.buckets.size(); ++i) {
    const TraceBucket& bucket = trace.buckets[i];
    const double none = std::numeric_limits<double>::quiet_NaN();
    put(trace.time_s[i] - start_s);
    put(bucket.present > 0 ? bucket.low : none);
    put(bucket.present > 0 ? bucket.high : none);
  }
  response.headers.emplace_back("Trace-Start", to_text(number(start_s)));
  response.headers.emplace_back("Trace-Samples-Per-Bucket", std::to_string(trace.samples_per_bucket));
  if (unit) {
    response.headers.emplace_back("Trace-Unit", *unit);
  }
  return response;
}

Result<Response> get_trace(ApiContext& context, const Request& request) {
  const auto type = negotiate(request.header("accept"), {"application/json", "application/octet-stream"});
  if (!type) {
    return problem_response(HttpFault::NotAcceptable, "Offered are application/json and application/octet-stream.");
  }
  auto recording = context.store.recording(request.parameters[0]);
  if (!recording) {
    return fail(recording.error());
  }
  Faults faults;
  const RecordingSpec spec = recording_spec_from_json(stored(recording->metadata_json), "", faults);
  if (!faults.none()) {
    return fail(faults.error());
  }
  if (auto sound = context.expect_sound_columns ? context.expect_sound_columns(recording->blob_sha256) : Status{};
      !sound) {
    return fail(sound.error());
  }
  auto columns = ColumnFile::open(context.blobs.columns_path(recording->blob_sha256));
  if (!columns) {
    return fail(columns.error());
  }
  const auto& names = columns->names();
  const std::string channel(request.parameter("channel").value_or(""));
  const auto named = std::find(names.begin(), names.end(), channel);
  if (named == names.end()) {
    return fail(ErrorCode::InvalidArgument, "Name a column of the recording: ?channel=…", {{"parameter", "channel"}});
  }
  const auto roles = assign_roles(spec, names);
  if (!roles) {
    return fail(roles.error());
  }
  const auto column = static_cast<std::size_t>(named - names.begin());
  const auto t0 = real_parameter(request, "t0");
  const auto t1 = real_parameter(request, "t1");
  const auto points = points_of(request);
  if (!t0 || !t1 || !points) {
    return fail(!t0 ? t0.error() : !t1 ? t1.error() : points.error());
  }
  const auto trace = draw_trace(*columns, pyramid_path(context.blobs.columns_path(recording->blob_sha256)),
                                {column, rate_of(*recording).value_or(1.0), *t0, *t1, *points, spec.trim,
                                 surveyed_channel_from_json(stored(recording->quality_json), channel)});
  if (!trace) {
    return fail(trace.error());
  }
  const std::optional<ColumnRole>& role = (*roles)[column];
  const auto unit = role && role->unit ? std::optional<std::string>(role->unit->symbol) : std::nullopt;
  Response response;
  if (*type == "application/octet-stream") {
    response = binary_trace(*trace, unit);
  } else {
    Json document = to_json(*trace);
    document["unit"] = unit ? Json(*unit) : Json(nullptr);
    response = json_response(200, document);
  }
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

}  // namespace

void add_trace_routes(Router& router, ApiContext& context) {
  router.add({"GET",
              "/v1/recordings/{id}/trace",
              "getTrace",
              {"channel", "t0", "t1", "points"},
              Handler([&](const Request& request) { return get_trace(context, request); })});
}

}  // namespace driftlab::server
