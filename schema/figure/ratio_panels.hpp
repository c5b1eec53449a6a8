#pragma once
/// Ratios over averaging time, in small panels side by side, and a badge: what a page shows beside its sentences, as
/// SVG without scripts or outside references. Data in, nothing known of where they come from.
#include <array>
#include <string>
#include <vector>

namespace driftlab::figure {

/// Logarithms of ratios; 0: no change.
struct RatioPoint {
  double tau_s = 0.0;
  double ln_ratio = 0.0;
  double low = 0.0;  ///< of the band
  double high = 0.0;
  double margin = 0.0;
  bool crossed = false;  ///< drawn as a cross, not as a dot
};

struct RatioPanel {
  std::string name;
  std::vector<RatioPoint> points = {};        ///< by averaging time; nothing is drawn of fewer than two
  std::array<std::string, 2> end_words = {};  ///< the shortest averaging time and the longest, as people write them
};

struct RatioPanels {
  std::string title = {};
  std::string caption = {};
  double scope_s = 0.0;  ///< shaded up to here; the axis of ratios is chosen for what lies there
  std::vector<RatioPanel> panels = {};
};

/// Up to three panels in a line.
[[nodiscard]] std::string to_svg(const RatioPanels& figure);

/// Two words side by side on a strip 20 px high; `colour` is that of the right one, as `#rrggbb`.
[[nodiscard]] std::string badge_svg(const std::string& left, const std::string& right, const std::string& colour);

}  // namespace driftlab::figure
