/// The job kind `regress`: stored results of recordings before and after a change in, one verdict out
/// (core/analysis/regress.hpp).
///
/// `inputs`: `device`, `baseline`, `candidate`, `history` and `excluded` of a regression request, whose recordings are
/// those of the server (`{"recording": "rec_..."}`). An arm with labels alone is all recordings of the device that have
/// them; the baseline may be "anchor" or "last_pass"; without a `history` it is the releases of earlier runs.
/// `parameters`: its `settings`. The results are pinned when the job is asked for; recordings without one are refused.
/// Looks are counted over the jobs of this kind that have the same device and candidate label: a run over the same
/// recordings is the same look.
#include "core/analysis/regress.hpp"

#include "core/campaign/regression/kept_settings.hpp"
#include "schema/json/regression.hpp"
#include "schema/text/regression.hpp"
#include "server/jobs/compared_recordings.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/jobs/pinned_arms.hpp"

#include <functional>
#include <optional>
#include <set>
#include <utility>

namespace driftlab::server {
namespace {

/// What people and pipelines read beside the document. The page shows the figure at an address that is filled in when
/// the page is asked for.
std::vector<Artefact> artefacts_of(const RegressReport& report) {
  return {{"text", regression_to_text(report)},          {"markdown", regression_to_markdown(report, "FIGURE")},
          {"junit", regression_to_junit(report, false)}, {"junit_open_skipped", regression_to_junit(report, true)},
          {"figure", regression_to_svg(report)},         {"badge", regression_to_badge(report)}};
}

/// What the anchor keeps of the settings, for a run whose baseline is the anchor. The first baseline of a device
/// becomes it, with the settings of its run.
Result<std::optional<regression::Settings>> kept_for(const std::string& baseline, const regression::Settings& own,
                                                     const RegressionMemory& memory) {
  const auto anchor = memory.anchor();
  if (!anchor) {
    return fail(anchor.error());
  }
  if (baseline.empty() || (!anchor->empty() && *anchor != baseline)) {
    return std::optional<regression::Settings>();
  }
  return anchor->empty() ? std::optional(own) : memory.kept_settings();
}

/// The recordings of both arms and of the history.
void for_each_pinned(const Json& inputs, const std::function<void(const Json&)>& take) {
  const auto each = [&](const Json& arm) {
    for (const Json& recording : arm["recordings"]) {
      take(recording);
    }
  };
  each(inputs["baseline"]);
  each(inputs["candidate"]);
  for (const Json& release : inputs["history"]) {
    each(release);
  }
}

class Regress final : public JobKind {
 public:
  [[nodiscard]] std::string_view name() const override { return kRegressKind; }
  [[nodiscard]] int version() const override { return kRegressionVersion; }

  [[nodiscard]] Result<Json> canonical_request(const Json& inputs, const Json& parameters,
                                               JobContext& context) const override {
    Faults faults;
    WrittenRegression written = regression_from_json(inputs, faults);
    regression_settings_from_json(parameters, "/parameters", written, faults);
    auto device = context.store.device(written.device);
    if (!device) {
      if (device.error().code != ErrorCode::NotFound) {
        return fail(device.error());
      }
      faults.add("/inputs/device", device.error());
      return fail(faults.error());
    }
    auto results = results_by_recording(context.store, device->id);
    auto causes = identified_causes(context.store, device->id);
    auto memory = RegressionMemory::of(context.store, *device);
    if (!results || !causes || !memory) {
      return fail(!results ? results.error() : !causes ? causes.error() : memory.error());
    }
    const DeviceResults known{std::move(*results), std::move(*causes)};
    auto canonical = pinned_inputs(written, *device, *memory, known, context.store, faults);
    if (!canonical) {
      return fail(canonical.error());
    }
    if (!faults.none()) {
      return fail(faults.error());
    }
    const auto read = kept_for(written.baseline.label, written.settings, *memory);
    if (!read) {
      return fail(read.error());
    }
    const std::optional<regression::Settings>& kept = *read;
    if (kept) {
      written.settings = regression::with_kept(*kept, written.settings, written.stated);
    }
    const bool counted = !written.candidate.label.empty();
    const std::size_t look =
        counted ? memory->history().look(written.candidate.label, regressed_ids((*canonical)["candidate"])) : 1;
    if (const auto share = look_share({look, written.looks, counted}); !share) {
      return fail(share.error());
    }
    Json settings = driftlab::to_json(written.settings, written.looks);
    return Json{{"kind", name()},
                {"inputs", std::move(*canonical)},
                {"parameters", std::move(settings)},
                {"look", {{"number", look}, {"counted", counted}}},
                {"kept", kept ? kept_settings_json(*kept) : Json(nullptr)},
                {"stated", written.stated}};
  }

  /// Measured (tests/RELIABILITY.md): what is held of the result of each channel, and the draws over all of them.
  [[nodiscard]] JobCost cost(const Json& request, JobContext& /*context*/) const override {
    constexpr std::int64_t kBytesPerResult = std::int64_t{128} << 10;
    constexpr double kSecondsOfDraws = 0.5;
    constexpr double kSecondsPerResult = 0.005;
    std::size_t results = 0;
    for_each_pinned(request["inputs"], [&](const Json& recording) { results += recording["results"].size(); });
    return {JobCost{}.memory_bytes + kBytesPerResult * static_cast<std::int64_t>(results),
            kSecondsOfDraws + kSecondsPerResult * static_cast<double>(results)};
  }

  [[nodiscard]] Result<JobResults> run(const Json& request, JobContext& context,
                                       const RunControl& control) const override {
    const Json& inputs = request["inputs"];
    std::set<std::string> pinned;
    for_each_pinned(inputs, [&](const Json& recording) { pinned.insert(recording["recording"].get<std::string>()); });
    auto results = results_by_recording(context.store, inputs["device"].get<std::string>(), control.stop, pinned);
    if (!results) {
      return fail(results.error());
    }
    Faults faults;
    WrittenRegression written;
    regression_settings_from_json(request["parameters"], "/parameters", written, faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
    RegressRequest wanted;
    wanted.look = {request["look"]["number"].get<std::size_t>(), written.looks, request["look"]["counted"].get<bool>()};
    wanted.stated = request.value("stated", std::set<std::string>());
    if (const Json kept = request.value("kept", Json()); kept.is_object()) {
      WrittenRegression read;
      regression_settings_from_json(kept, "/kept", read, faults);
      wanted.kept = read.settings;
    }
    regression::Request& comparison = wanted.comparison;
    comparison.device = inputs["device_name"].get<std::string>();
    comparison.settings = written.settings;
    for (const Json& exclusion : inputs["excluded"]) {
      comparison.excluded.push_back(
          {exclusion["recording"].get<std::string>(), exclusion["reason"].get<std::string>()});
    }
    for (const auto& [name, arm] :
         {std::pair{"baseline", &comparison.baseline}, std::pair{"candidate", &comparison.candidate}}) {
      auto recordings = compared_recordings(context.store, inputs[name], *results, control.stop);
      if (!recordings) {
        return fail(recordings.error());
      }
      *arm = std::move(*recordings);
    }
    for (const Json& release : inputs["history"]) {
      auto recordings = compared_recordings(context.store, release, *results, control.stop);
      if (!recordings) {
        return fail(recordings.error());
      }
      comparison.history.push_back(std::move(*recordings));
    }
    if (inputs.contains("previous")) {
      comparison.before_baseline = inputs["before_baseline"].get<std::size_t>();
      wanted.previous = comparison.history[inputs["previous"].get<std::size_t>()];
    }
    const auto report = regress(wanted, control);
    if (!report) {
      return fail(report.error());
    }
    JobResults made;
    made.document_json = to_text(driftlab::to_json(*report));
    made.artefacts = artefacts_of(*report);
    made.verdicts.push_back({.level = report->report.summary.level, .verdict = report->report.summary.verdict});
    return made;
  }
};

}  // namespace

std::unique_ptr<JobKind> make_regress_kind() { return std::make_unique<Regress>(); }

}  // namespace driftlab::server
