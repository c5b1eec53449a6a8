/// Reads what a regression run is asked.
#include "core/read/text_shape.hpp"
#include "core/signal/angle.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/regression.hpp"

#include <algorithm>
#include <array>

namespace driftlab {
namespace {

void regression_read_percents(const Json& document, const std::string& pointer, std::array<double, 3>& into,
                              Faults& faults) {
  if (!document.is_array() || document.size() != 3) {
    faults.add(pointer, ErrorCode::InvalidArgument, "Three numbers in per cent are needed.");
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!document[i].is_number()) {
      faults.add(pointer + "/" + std::to_string(i), ErrorCode::ParseError, "A number in per cent is needed.");
      return;
    }
    into[i] = document[i].get<double>();
  }
}

void regression_read_margin(const Json& document, const std::string& pointer, regression::Settings& settings,
                            Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  if (const Json* const percents = reader.member("gyroscope")) {
    regression_read_percents(*percents, reader.pointer("gyroscope"), settings.gyroscope.percent, faults);
  }
  if (const Json* const percents = reader.member("accelerometer")) {
    regression_read_percents(*percents, reader.pointer("accelerometer"), settings.accelerometer.percent, faults);
  }
  settings.margin_sigma_percent = reader.real("sigma").value_or(settings.margin_sigma_percent);
  settings.margin_slow_percent = reader.real("slow").value_or(settings.margin_slow_percent);
  if (const Json* const bias = reader.member("bias")) {
    ObjectReader margins(*bias, reader.pointer("bias"), faults);
    settings.bias.gyroscope = kDegree * margins.real("gyroscope").value_or(0.0);
    settings.bias.accelerometer = kRegressionMg * margins.real("accelerometer").value_or(0.0);
    margins.reject_unknown();
    if (settings.bias.gyroscope < 0.0 || settings.bias.accelerometer < 0.0) {
      faults.add(reader.pointer("bias"), ErrorCode::InvalidArgument, "A margin must not be negative.");
    }
  }
  if (const Json* const scale = reader.member("scale_factor")) {
    ObjectReader margins(*scale, reader.pointer("scale_factor"), faults);
    settings.scale_factor.gyroscope = kRegressionPpm * margins.real("gyroscope").value_or(0.0);
    settings.scale_factor.accelerometer = kRegressionPpm * margins.real("accelerometer").value_or(0.0);
    margins.reject_unknown();
    if (settings.scale_factor.gyroscope < 0.0 || settings.scale_factor.accelerometer < 0.0) {
      faults.add(reader.pointer("scale_factor"), ErrorCode::InvalidArgument, "A margin must not be negative.");
    }
  }
  reader.reject_unknown();
}

void regression_read_tau0(const Json& document, const std::string& pointer, regression::Settings& settings,
                          Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  for (const auto& [name, tau0] :
       {std::pair{"gyroscope", &settings.tau0_gyroscope}, std::pair{"accelerometer", &settings.tau0_accelerometer}}) {
    if (const Json* const percents = reader.member(name)) {
      std::array<double, 3> values{100.0 * tau0->device, 100.0 * tau0->axis, 100.0 * tau0->scale};
      regression_read_percents(*percents, reader.pointer(name), values, faults);
      *tau0 = {values[0] / 100.0, values[1] / 100.0, values[2] / 100.0};
    }
  }
  reader.reject_unknown();
}

void regression_read_limits(const Json& document, const std::string& pointer, regression::EventLimits& limits,
                            Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  for (const LimitMember& member : limit_members()) {
    if (const auto value = reader.real(member.name)) {
      limits.*member.limit = member.unit * *value;
    }
  }
  if (const auto sessions = reader.integer("findings")) {
    limits.findings = static_cast<std::size_t>(within(*sessions, 0, 1000000));
  }
  reader.reject_unknown();
}

WrittenRecording regression_read_recording(const Json& document, const std::string& pointer, Faults& faults) {
  WrittenRecording written;
  written.pointer = pointer;
  if (!document.is_object()) {
    faults.add(pointer, ErrorCode::ParseError, "A recording is an object.");
    return written;
  }
  Json own = Json::object();  // what is of the run; the rest is of the recording
  Json rest = Json::object();
  for (const auto& [name, value] : document.items()) {
    const bool of_run =
        name == "result" || name == "recording" || name == "session" || name == "recorded_at" || is_stated_fact(name);
    (of_run ? own : rest)[name] = value;
  }
  ObjectReader reader(own, pointer, faults);
  written.result = reader.text("result").value_or("");
  written.recording = reader.text("recording").value_or("");
  written.session = reader.text("session").value_or("");
  written.recorded_at = reader.text("recorded_at").value_or("");
  written.stated = stated_facts_from_json(reader, faults);
  if (rest.contains("file") && rest["file"].is_string()) {
    written.file = rest["file"].get<std::string>();
  }
  if (!rest.contains("condition")) {
    rest["condition"] = Json{{"kind", "static"}};
  } else if (rest["condition"].is_string()) {
    const auto condition = parse_condition(rest["condition"].get<std::string>());
    if (!condition) {
      faults.add(pointer + "/condition", condition.error());
      return written;
    }
    rest["condition"] = to_json(*condition);
  }
  written.spec = recording_spec_from_json(rest, pointer, faults);
  const int named =
      (written.file.empty() ? 0 : 1) + (written.result.empty() ? 0 : 1) + (written.recording.empty() ? 0 : 1);
  if (named != 1) {
    faults.add(pointer, ErrorCode::InvalidArgument,
               "A recording names one of file, result (what `driftlab characterise --json` wrote) and recording (an id "
               "of the server).");
  }
  return written;
}

WrittenArm regression_read_arm(const Json& document, const std::string& pointer, Faults& faults) {
  WrittenArm arm;
  if (document.is_string()) {
    arm.special = document.get<std::string>();
    if (arm.special != "anchor" && arm.special != "last_pass") {
      faults.add(pointer, ErrorCode::InvalidArgument, "An arm is an object, \"anchor\" or \"last_pass\".");
    }
    return arm;
  }
  ObjectReader reader(document, pointer, faults);
  if (const Json* const labels = reader.member("labels")) {
    arm.label = label_text(*labels);
    if (arm.label.empty()) {
      faults.add(reader.pointer("labels"), ErrorCode::ParseError,
                 "Labels are an object of texts, for example {\"firmware\": \"1.5.0\"}.");
    }
  }
  if (const Json* const recordings = reader.member("recordings")) {
    if (!recordings->is_array()) {
      faults.add(reader.pointer("recordings"), ErrorCode::ParseError, "The recordings must be an array.");
    } else if (recordings->empty()) {
      faults.add(reader.pointer("recordings"), ErrorCode::InvalidArgument,
                 "Name a recording, or leave the list out where labels say which.");
    } else {
      for (std::size_t i = 0; i < recordings->size(); ++i) {
        arm.recordings.push_back(regression_read_recording(
            (*recordings)[i], reader.pointer("recordings") + "/" + std::to_string(i), faults));
      }
    }
  }
  reader.reject_unknown();
  return arm;
}

void regression_read_excluded(const Json& document, std::vector<regression::Exclusion>& into, Faults& faults) {
  if (!document.is_array()) {
    faults.add("/excluded", ErrorCode::ParseError, "The excluded recordings must be an array.");
    return;
  }
  for (std::size_t i = 0; i < document.size(); ++i) {
    ObjectReader reader(document[i], "/excluded/" + std::to_string(i), faults);
    const std::string recording = reader.required_text("recording");
    const std::string reason = reader.required_text("reason");
    if (reason.empty()) {
      faults.add(reader.pointer("reason"), ErrorCode::InvalidArgument, "Leaving a recording out needs a reason.");
    }
    reader.reject_unknown();
    into.push_back({recording, reason});
  }
}

/// `Z`, `+hh:mm` or `-hh:mm` at the end, without which a time is a local one.
bool names_its_zone(std::string_view time) {
  constexpr std::size_t kOffset = 6;
  const std::string_view end = time.size() > kOffset ? time.substr(time.size() - kOffset) : time;
  return time.ends_with('Z') || (end.size() == kOffset && (end[0] == '+' || end[0] == '-') && end[3] == ':');
}

}  // namespace

std::string label_text(const Json& labels) {
  std::string text;
  if (!labels.is_object()) {
    return text;
  }
  std::vector<std::string> names;
  for (const auto& [name, value] : labels.items()) {
    if (!value.is_string()) {
      return "";
    }
    names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ",") + name + "=" + labels[name].get<std::string>();
  }
  return text;
}

Result<double> seconds_of(const std::string& time) {
  std::string written = time;
  if (written.size() > 10) {
    written[10] = written[10] == 't' ? 'T' : written[10];
    written.back() = written.back() == 'z' ? 'Z' : written.back();
  }
  const auto seconds = names_its_zone(written) ? text::seconds_of_date(written) : std::nullopt;
  if (!seconds) {
    return fail(ErrorCode::InvalidArgument,
                "A time is written as RFC 3339 has it, for example 2026-11-22T10:00:00Z; '" + time + "' is not.",
                {{"parameter", "recorded_at"}});
  }
  return *seconds;
}

void regression_settings_from_json(const Json& document, const std::string& pointer, WrittenRegression& into,
                                   Faults& faults) {
  regression::Settings& settings = into.settings;
  ObjectReader reader(document, pointer, faults);
  if (document.is_object()) {
    for (const auto& [name, value] : document.items()) {
      into.stated.insert(name);
    }
  }
  settings.test.set_level(reader.real("alpha").value_or(settings.test.alpha));
  settings.test.through_s = reader.real("through_s").value_or(settings.test.through_s);
  settings.test.design_power = reader.real("design_power").value_or(settings.test.design_power);
  settings.test.prior_df = reader.real("prior_df").value_or(settings.test.prior_df);
  settings.test.session_df =
      static_cast<int>(within(reader.integer("session_df").value_or(settings.test.session_df), 0, 1000000));
  settings.min_edf = reader.real("min_edf").value_or(settings.min_edf);
  if (const auto seed = reader.integer("seed"); seed && *seed >= 0) {
    settings.test.seed = static_cast<std::uint64_t>(*seed);
  }
  if (const Json* const margin = reader.member("margin")) {
    regression_read_margin(*margin, reader.pointer("margin"), settings, faults);
  }
  if (const Json* const tau0 = reader.member("tau0")) {
    regression_read_tau0(*tau0, reader.pointer("tau0"), settings, faults);
  }
  if (const Json* const limits = reader.member("event_limits")) {
    regression_read_limits(*limits, reader.pointer("event_limits"), settings.limits, faults);
  }
  if (const auto fail_on = reader.text("fail_on")) {
    settings.test.fail_on_worse = *fail_on == "worse";
    if (*fail_on != "worse" && *fail_on != "beyond_margin") {
      faults.add(reader.pointer("fail_on"), ErrorCode::InvalidArgument, "fail_on is beyond_margin or worse.");
    }
  }
  if (const Json* const two_sided = reader.member("two_sided")) {
    settings.test.two_sided = two_sided->is_boolean() && two_sided->get<bool>();
  }
  if (const auto looks = reader.integer("looks")) {
    into.looks = *looks == 1 ? 1 : 3;
    if (*looks != 1 && *looks != 3) {
      faults.add(reader.pointer("looks"), ErrorCode::InvalidArgument, "looks is 1 or 3.");
    }
  }
  if (const auto inconclusive = reader.text("inconclusive")) {
    into.inconclusive = *inconclusive == "pass"   ? Inconclusive::Pass
                        : *inconclusive == "fail" ? Inconclusive::Fail
                                                  : Inconclusive::Inconclusive;
    if (*inconclusive != "pass" && *inconclusive != "fail" && *inconclusive != "inconclusive") {
      faults.add(reader.pointer("inconclusive"), ErrorCode::InvalidArgument,
                 "inconclusive is inconclusive, pass or fail.");
    }
  }
  reader.reject_unknown();
}

WrittenRegression regression_from_json(const Json& document, Faults& faults) {
  WrittenRegression written;
  ObjectReader reader(document, "", faults);
  if (const Json* const device = reader.member("device")) {
    if (device->is_string()) {
      written.device = device->get<std::string>();
    } else {
      ObjectReader named(*device, "/device", faults);
      written.device = named.required_text("id");
      named.reject_unknown();
    }
  }
  if (const Json* const baseline = reader.member("baseline")) {
    written.baseline = regression_read_arm(*baseline, "/baseline", faults);
  } else {
    written.baseline.special = "anchor";
  }
  if (const Json* const candidate = reader.member("candidate"); candidate != nullptr && candidate->is_object()) {
    written.candidate = regression_read_arm(*candidate, "/candidate", faults);
  } else {
    faults.add("/candidate", ErrorCode::InvalidArgument, "A regression run needs a candidate.");
  }
  if (const Json* const history = reader.member("history"); history != nullptr && history->is_array()) {
    for (std::size_t i = 0; i < history->size(); ++i) {
      written.history.push_back(regression_read_arm((*history)[i], "/history/" + std::to_string(i), faults));
    }
  }
  if (const Json* const excluded = reader.member("excluded")) {
    regression_read_excluded(*excluded, written.excluded, faults);
  }
  if (const Json* const settings = reader.member("settings")) {
    regression_settings_from_json(*settings, "/settings", written, faults);
  }
  reader.reject_unknown();
  return written;
}

}  // namespace driftlab
