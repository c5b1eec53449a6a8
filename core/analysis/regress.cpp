#include "core/analysis/regress.hpp"

#include <array>
#include <cmath>

namespace driftlab {
namespace {

Status check_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) {
    return {};
  }
  return fail(ErrorCode::InvalidArgument, std::string("The setting ") + name + " is outside its range.",
              {{"parameter", name}});
}

Status check_settings(const regression::Settings& settings) {
  const regression::TestSettings& test = settings.test;
  struct Range {
    const char* name;
    double value;
    double low;
    double high;
  };
  std::vector<Range> ranges{{"alpha", test.alpha, 0.001, 0.3},
                            {"prior_df", test.prior_df, 0.5, 100.0},
                            {"session_df", static_cast<double>(test.session_df), 3.0, 1000.0},
                            {"through_s", test.through_s, 1e-6, 1e6},
                            {"design_power", test.design_power, 0.1, 0.99},
                            {"min_edf", settings.min_edf, 3.0, 1000.0},
                            {"margin", settings.margin_sigma_percent, 0.1, 1000.0},
                            {"margin", settings.margin_slow_percent, 0.1, 1000.0}};
  for (const regression::Margins* margins : {&settings.gyroscope, &settings.accelerometer}) {
    for (const double percent : margins->percent) {
      ranges.push_back({"margin", percent, 0.1, 1000.0});
    }
  }
  for (const regression::Tau0* tau0 : {&settings.tau0_gyroscope, &settings.tau0_accelerometer}) {
    for (const double sd : {tau0->device, tau0->axis, tau0->scale}) {
      ranges.push_back({"tau0", sd, 1e-5, 1.0});
    }
  }
  const regression::EventLimits& limits = settings.limits;
  ranges.insert(ranges.end(), {{"event_limits", limits.missing, 0.0, 1.0},
                               {"event_limits", limits.jitter, 1.0, 1000.0},
                               {"event_limits", limits.jitter_of_interval, 0.0, 10.0},
                               {"event_limits", limits.resolution, 1.0, 1000.0},
                               {"event_limits", limits.contamination, 1.0, 1000.0},
                               {"event_limits", static_cast<double>(limits.findings), 1.0, 1000.0},
                               {"event_limits", limits.rate, 0.0, 1.0},
                               {"event_limits", limits.temperature_k, 0.0, 1000.0},
                               {"event_limits", limits.repeatability, 1.0, 1000.0}});
  for (const Range& range : ranges) {
    if (auto checked = check_range(range.name, range.value, range.low, range.high); !checked) {
      return checked;
    }
  }
  return {};
}

}  // namespace

Result<double> look_share(const Look& look) {
  static constexpr std::array<double, 3> kShares = {0.6, 0.25, 0.15};
  if (look.number < 1 || (look.of != 1 && look.of != kShares.size())) {
    return fail(ErrorCode::InvalidArgument, "The setting looks must be 1 or 3.", {{"parameter", "looks"}});
  }
  if (look.number > look.of) {
    return fail(ErrorCode::Conflict,
                "This candidate label was looked at " + std::to_string(look.of) + (look.of == 1 ? " time" : " times") +
                    ", which is all that its level of 5 % allows: start a new label.",
                {{"look", std::to_string(look.number)}});
  }
  return look.of == 1 ? 1.0 : kShares[look.number - 1];
}

Result<RegressReport> regress(const RegressRequest& request, const RunControl& control) {
  if (auto checked = check_settings(request.comparison.settings); !checked) {
    return fail(checked.error());
  }
  const auto share = look_share(request.look);
  if (!share) {
    return fail(share.error());
  }
  regression::Request comparison = request.comparison;
  comparison.settings.test.look_share = *share;
  auto report = regression::run_regression(comparison, control);
  if (!report) {
    return fail(report.error());
  }
  RegressReport result{std::move(*report), request.look, std::nullopt, request.stated, request.kept};
  if (request.kept) {
    const auto changes = regression::changed_settings(*request.kept, request.comparison.settings);
    if (!changes.empty()) {
      result.report.summary.details.push_back(regression::changed_sentence(changes));
    }
  }
  if (!request.look.counted) {
    result.report.summary.details.emplace_back(
        "Looks are not counted here: the share of the first look applies. Runs repeated until they pass are no gate.");
  }
  if (request.previous) {
    regression::Request informal = comparison;
    informal.baseline = *request.previous;
    informal.history.clear();
    const auto other = regression::run_regression(informal, control.reporting({}));
    if (!other && other.error().code == ErrorCode::Cancelled) {
      return fail(other.error());
    }
    if (other) {
      result.versus_previous = PreviousVerdict{request.previous->label, other->verdict, other->summary.verdict};
    }
  }
  return result;
}

}  // namespace driftlab
