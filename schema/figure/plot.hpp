#pragma once
/// What a figure draws: curves with their intervals on one pair of axes, and the notes a reader takes off it. Data in,
/// nothing known of where they come from. The pages of the daemon draw the same (clients/dashboard/src/figure/spec.ts);
/// tests/browser/figures.test.mjs holds the marks of both together.
#include <optional>
#include <string>
#include <vector>

namespace driftlab::figure {

/// Colours of the light palette as `#rrggbb` or `#rrggbbaa`; one meaning everywhere: ink measured, blue model,
/// vermilion robust.
namespace palette {
inline constexpr const char* kInk = "#16191d";
inline constexpr const char* kInk2 = "#4a5056";
inline constexpr const char* kInk3 = "#666c73";
inline constexpr const char* kRule = "#82878d";
inline constexpr const char* kHair = "#e2e2dc";
inline constexpr const char* kSurface = "#ffffff";
inline constexpr const char* kModel = "#0067a8";
inline constexpr const char* kRobust = "#c04a00";
inline constexpr const char* kBand = "#16191d1f";
inline constexpr const char* kModelBand = "#0067a826";
inline constexpr const char* kRobustBand = "#c04a0026";
}  // namespace palette

enum class Mark { None, Dot, Open, Diamond };

/// One curve; the lists are as long as `x`, or empty. Points without a value are not drawn.
struct Series {
  std::string name;
  std::string detail = {};  ///< second line of its key
  std::vector<double> x = {};
  std::vector<std::optional<double>> y = {};
  std::vector<std::optional<double>> low = {};   ///< of the 95 % interval
  std::vector<std::optional<double>> high = {};  ///< likewise
  Mark mark = Mark::None;
  bool line = false;
  std::string colour = palette::kInk;
  std::string band = {};  ///< fill between low and high; empty: none
  double width = 1.3;
  std::vector<double> dash = {};
  bool key = true;
};

enum class ScaleKind { Log, Linear };

struct Axis {
  ScaleKind scale = ScaleKind::Log;
  std::string name = {};  ///< with its unit
  std::optional<std::pair<double, double>> domain = {};
  std::vector<double> ticks = {};
  bool bare = false;  ///< without ticks: where something lies along it says nothing
};

struct Note {
  double x = 0.0;
  double y = 0.0;
  std::string text;
  std::string sub = {};
  std::string colour = palette::kInk;
  bool rule = false;  ///< a line at this height over the right part; else a ring with a dotted line down to the axis
};

struct Guide {
  double slope = 0.0;
  std::string text;
};

/// A value for each pair of x and y, as a colour: vermilion above 0, blue below, full from 1 and from -1 on. Cells
/// reach half way to their neighbours, by the logarithm on a logarithmic axis.
struct Cells {
  std::vector<double> x = {};       ///< middles, rising
  std::vector<double> y = {};       ///< likewise
  std::vector<double> values = {};  ///< column by column; NaN: nothing is drawn
};

struct Plot {
  Axis x = {};
  Axis y = {};
  std::vector<Series> series = {};  ///< the first lies on top
  Cells cells = {};                 ///< below everything
  std::vector<Note> notes = {};
  std::vector<Guide> guides = {};
  /// One length for a decade of both logarithmic axes, so that a slope of -1/2 looks like one; for a unit of linear
  /// ones.
  bool equal_units = false;
  double height = 220.0;  ///< of the drawing area [px]; not for equal units
  std::vector<double> rules = {};
  bool hide_x = false;  ///< shares the axis of the plot below
};

/// A column of plots that share their x axis.
struct Figure {
  std::string title = {};
  std::string sentence = {};  ///< what it says, for whoever does not see it
  std::string source = {};    ///< the line under it
  std::vector<Plot> plots = {};
};

}  // namespace driftlab::figure
