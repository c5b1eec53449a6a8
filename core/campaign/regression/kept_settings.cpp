#include "core/campaign/regression/kept_settings.hpp"

#include "core/signal/number.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace driftlab::regression {
namespace {

using Text = std::pair<std::string, std::string>;

std::string percents_text(const Margins& margins) {
  std::string text;
  for (const double percent : margins.percent) {
    text += (text.empty() ? "" : ", ") + short_text(percent);
  }
  return text + " %";
}

/// The kept settings by name, as people read them.
std::vector<Text> texts_of(const Settings& settings) {
  const TestSettings& test = settings.test;
  return {{"alpha", short_text(test.alpha)},
          {"through_s", short_text(test.through_s) + " s"},
          {"design_power", short_text(test.design_power)},
          {"margin.gyroscope", percents_text(settings.gyroscope)},
          {"margin.accelerometer", percents_text(settings.accelerometer)},
          {"margin.sigma", short_text(settings.margin_sigma_percent) + " %"},
          {"margin.slow", short_text(settings.margin_slow_percent) + " %"},
          {"margin.bias",
           short_text(settings.bias.gyroscope) + " rad/s, " + short_text(settings.bias.accelerometer) + " m/s^2"},
          {"margin.scale_factor", short_text(1e6 * settings.scale_factor.gyroscope) + ", " +
                                      short_text(1e6 * settings.scale_factor.accelerometer) + " ppm"}};
}

}  // namespace

bool is_kept_setting(std::string_view name) {
  static constexpr std::array<std::string_view, 4> kKept = {"alpha", "margin", "through_s", "design_power"};
  return std::find(kKept.begin(), kKept.end(), name) != kKept.end();
}

Settings with_kept(const Settings& kept, Settings settings, const std::set<std::string>& stated) {
  if (!stated.contains("alpha")) {
    settings.test.alpha = kept.test.alpha;
    settings.test.event_alpha = kept.test.event_alpha;
  }
  if (!stated.contains("through_s")) {
    settings.test.through_s = kept.test.through_s;
  }
  if (!stated.contains("design_power")) {
    settings.test.design_power = kept.test.design_power;
  }
  if (!stated.contains("margin")) {
    settings.gyroscope = kept.gyroscope;
    settings.accelerometer = kept.accelerometer;
    settings.margin_sigma_percent = kept.margin_sigma_percent;
    settings.margin_slow_percent = kept.margin_slow_percent;
    settings.bias = kept.bias;
    settings.scale_factor = kept.scale_factor;
  }
  return settings;
}

std::vector<ChangedSetting> changed_settings(const Settings& kept, const Settings& now) {
  const std::vector<Text> before = texts_of(kept);
  const std::vector<Text> after = texts_of(now);
  std::vector<ChangedSetting> changes;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].second != after[i].second) {
      changes.push_back({before[i].first, before[i].second, after[i].second});
    }
  }
  return changes;
}

std::string changed_sentence(const std::vector<ChangedSetting>& changes) {
  std::string list;
  for (const ChangedSetting& change : changes) {
    list += (list.empty() ? "" : "; ") + change.name + " " + change.now + " (kept: " + change.kept + ")";
  }
  return list.empty() ? list : "Settings differ from those kept with the anchor: " + list + ".";
}

}  // namespace driftlab::regression
