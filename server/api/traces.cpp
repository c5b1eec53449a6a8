// A recording's samples as a screen can show them.
#include "core/read/column_file.hpp"
#include "core/read/trace_pyramid.hpp"
#include "core/signal/decimated_trace.hpp"
#include "core/signal/number.hpp"
#include "schema/json/recording_spec.hpp"
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

/// A parameter as a number; `otherwise` where it is not given.
Result<double> real_parameter(const Request& request, std::string_view name, double otherwise) {
  const auto text = request.parameter(name);
  if (!text) {
    return otherwise;
  }
  const auto value = parse_double(*text);
  if (!value || !std::isfinite(*value)) {
    return fail(ErrorCode::InvalidArgument, "The parameter " + std::string(name) + " is a number of seconds.",
                {{"parameter", std::string(name)}});
  }
  return *value;
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

struct Stretch {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// The rows between two times of a file of `rows`.
Stretch stretch_of(double t0, double t1, double rate_hz, std::size_t rows) {
  const auto row_at = [&](double t) {
    return static_cast<std::size_t>(std::clamp(std::floor(t * rate_hz), 0.0, static_cast<double>(rows)));
  };
  const std::size_t first = std::min(row_at(t0), rows - 1);
  return {first, std::max<std::size_t>(1, row_at(t1) - std::min(row_at(t1), first))};
}

struct Trace {
  std::vector<TraceBucket> buckets;  ///< `first` counts from the first of the file
  std::size_t samples_per_bucket = 1;
};

/// From the pyramid where there is one and it spares time, else from the samples.
Trace trace_of(const std::filesystem::path& path, const ColumnFile& columns, std::size_t column, const Stretch& stretch,
               std::size_t points) {
  const std::size_t count = std::min(stretch.count, columns.rows() - stretch.first);
  if (const std::size_t length = pyramid_stretch(count, points); length > 0) {
    if (const auto pyramid = TracePyramid::open(pyramid_path(path), columns)) {
      return {pyramid->trace(columns, column, stretch.first, count, points), length};
    }
  }
  Trace trace{decimated_trace(columns.column(column).subspan(stretch.first, count), points),
              std::max<std::size_t>(1, (count + points - 1) / points)};
  for (TraceBucket& bucket : trace.buckets) {
    bucket.first += stretch.first;
  }
  return trace;
}

/// Where samples are missing, to the stretch that they are missing from: [[from, to], ...] in seconds.
Json missing_in(const Trace& trace, std::size_t end, double rate_hz) {
  Json missing = Json::array();
  bool open = false;
  for (std::size_t i = 0; i < trace.buckets.size(); ++i) {
    const TraceBucket& bucket = trace.buckets[i];
    const std::size_t next = i + 1 < trace.buckets.size() ? trace.buckets[i + 1].first : end;
    const bool lacks = bucket.present < next - bucket.first;
    if (lacks && !open) {
      missing.push_back(Json::array({number(static_cast<double>(bucket.first) / rate_hz), nullptr}));
    }
    if (lacks) {
      missing.back()[1] = number(static_cast<double>(next) / rate_hz);
    }
    open = lacks;
  }
  return missing;
}

/// The survey of a column; null where it is no sensor.
Json survey_of(const Json& quality, const std::string& channel) {
  for (const Json& one : quality.value("channels", Json::array())) {
    if (one.value("column", "") == channel) {
      return one;
    }
  }
  return nullptr;
}

/// A list of {"kind", "t0", "t1"}.
class Flags {
 public:
  void add(const char* kind, double t0, double t1) {
    if (t1 > t0) {
      list_.push_back(Json{{"kind", kind}, {"t0", number(t0)}, {"t1", number(t1)}});
    }
  }
  void add_gap(double t0, double t1, const Json& missing) {
    add("gap", t0, t1);
    list_.back()["missing"] = missing;
  }
  [[nodiscard]] Json take() { return std::move(list_); }

 private:
  Json list_ = Json::array();
};

/// Where the trace reaches a value at which samples pile up: stretches of it, joined where they touch.
void flag_saturated(const Trace& trace, const Json& rails, std::size_t end, double rate_hz, Flags& flags) {
  const auto is_at = [&](std::size_t rail, double value) {
    return rails.is_array() && rails.at(rail).is_number() && rails.at(rail).get<double>() == value;
  };
  const auto at = [&](std::size_t i) {
    return static_cast<double>(i < trace.buckets.size() ? trace.buckets[i].first : end) / rate_hz;
  };
  double from = 0.0;
  bool open = false;
  for (std::size_t i = 0; i <= trace.buckets.size(); ++i) {
    const bool there = i < trace.buckets.size() && trace.buckets[i].present > 0 &&
                       (is_at(0, trace.buckets[i].low) || is_at(1, trace.buckets[i].high));
    if (there && !open) {
      from = at(i);
    } else if (!there && open) {
      flags.add("saturated", from, at(i));
    }
    open = there;
  }
}

/// What a reader must not take for the sensor's noise: trimmed ends, gaps, numbers that are no measurements, a stretch
/// in which the sensor gives one value only, and full scale. `end`: the row behind the trace.
Json flags_of(const Recording& recording, const RecordingSpec& spec, const std::string& channel, const Trace& trace,
              std::size_t end, double duration_s, double rate_hz) {
  Flags flags;
  flags.add("trim", 0.0, std::min(spec.trim.start_s, duration_s));
  flags.add("trim", std::max(0.0, duration_s - spec.trim.end_s), duration_s);
  const Json quality = stored(recording.quality_json);
  for (const Json& gap : quality.value("longest_gaps", Json::array())) {
    const double row = gap.at("row").get<double>() - 1.0;
    flags.add_gap((row - 1.0) / rate_hz, row / rate_hz, gap.at("missing"));
  }
  const Json survey = survey_of(quality, channel);
  if (survey.is_object()) {
    if (survey.value("frozen", 0) > 0 && survey["frozen_from"].is_number()) {
      const double first = (survey["frozen_from"].get<double>() - 1.0) / rate_hz;
      flags.add("frozen", first, first + survey["frozen"].get<double>() / rate_hz);
    }
    for (const Json& wrong : survey.value("implausible_at", Json::array())) {
      const double first = (wrong.at("row").get<double>() - 1.0) / rate_hz;
      flags.add("flagged", first, first + wrong.at("samples").get<double>() / rate_hz);
    }
    flag_saturated(trace, survey.value("rails", Json(nullptr)), end, rate_hz, flags);
  }
  return flags.take();
}

/// Three float32, little-endian, of each stretch: seconds since the first one begins, least and greatest value; NaN
/// where it has no sample.
Response binary_trace(const Trace& trace, double rate_hz, const std::optional<std::string>& unit) {
  Response response;
  response.content_type = "application/octet-stream";
  const std::size_t first = trace.buckets.empty() ? 0 : trace.buckets.front().first;
  response.body.reserve(trace.buckets.size() * 3 * sizeof(float));
  const auto put = [&](double value) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    for (unsigned shift = 0; shift < 32; shift += 8) {
      response.body.push_back(static_cast<char>(bits >> shift & 0xFFU));
    }
  };
  for (const TraceBucket& bucket : trace.buckets) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    put(static_cast<double>(bucket.first - first) / rate_hz);
    put(bucket.present > 0 ? bucket.low : none);
    put(bucket.present > 0 ? bucket.high : none);
  }
  response.headers.emplace_back("Trace-Start", to_text(number(static_cast<double>(first) / rate_hz)));
  response.headers.emplace_back("Trace-Samples-Per-Bucket", std::to_string(trace.samples_per_bucket));
  if (unit) {
    response.headers.emplace_back("Trace-Unit", *unit);
  }
  return response;
}

Json trace_document(const Trace& trace, double rate_hz) {
  Json time = Json::array();
  Json low = Json::array();
  Json high = Json::array();
  Json mean = Json::array();
  for (const TraceBucket& bucket : trace.buckets) {
    time.push_back(number(static_cast<double>(bucket.first) / rate_hz));
    low.push_back(bucket.present > 0 ? number(bucket.low) : Json(nullptr));
    high.push_back(bucket.present > 0 ? number(bucket.high) : Json(nullptr));
    mean.push_back(bucket.present > 0 ? number(bucket.mean) : Json(nullptr));
  }
  return Json{{"samples_per_bucket", trace.samples_per_bucket},
              {"time_s", std::move(time)},
              {"min", std::move(low)},
              {"max", std::move(high)},
              {"mean", std::move(mean)}};
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
  const double rate_hz = rate_of(*recording).value_or(1.0);
  const auto t0 = real_parameter(request, "t0", 0.0);
  const auto t1 = real_parameter(request, "t1", static_cast<double>(columns->rows()) / rate_hz);
  const auto points = points_of(request);
  if (!t0 || !t1 || !points) {
    return fail(!t0 ? t0.error() : !t1 ? t1.error() : points.error());
  }
  if (!(*t1 > *t0) || columns->rows() == 0) {
    return fail(ErrorCode::InvalidArgument, "The end t1 lies after the beginning t0.", {{"parameter", "t1"}});
  }
  const std::size_t rows = columns->rows();
  const double duration_s = static_cast<double>(rows) / rate_hz;
  const Stretch stretch = stretch_of(*t0, *t1, rate_hz, rows);
  const Trace trace = trace_of(context.blobs.columns_path(recording->blob_sha256), *columns, column, stretch, *points);
  const std::optional<ColumnRole>& role = (*roles)[column];
  const auto unit = role && role->unit ? std::optional<std::string>(role->unit->symbol) : std::nullopt;
  Response response;
  if (*type == "application/octet-stream") {
    response = binary_trace(trace, rate_hz, unit);
  } else {
    const std::size_t end = std::min(stretch.first + stretch.count, rows);
    Json document = trace_document(trace, rate_hz);
    document["missing"] = missing_in(trace, end, rate_hz);
    document["flags"] = flags_of(*recording, spec, channel, trace, end, duration_s, rate_hz);
    document["unit"] = unit ? Json(*unit) : Json(nullptr);
    document["duration_s"] = number(duration_s);
    document["rate_hz"] = number(rate_hz);
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
