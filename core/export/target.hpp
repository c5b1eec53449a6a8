#pragma once
/// A program that wants noise parameters in its own file: which of them, in which units, by which convention.
///
/// To add one: a file in core/export/targets/ that defines one function returning an `ExportTarget`, after the model of
/// kalibr.cpp (one number for each sensor), kf_gins.cpp (one for each axis, Gauss-Markov) or px4.cpp (numbers that hold
/// for a step of the estimator), and its line in registry.cpp. The suite of tests/unit/export then asks for what its
/// numbers mean, written as the recursion that the program runs, and holds both together.
///
/// What is stated of a program's convention is fact read from its documentation or source, named in `source`; nothing
/// of its text is used.
#include "core/export/imu_noise.hpp"
#include "core/signal/angle.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// How the file writes names, numbers and comments (schema/text/export.hpp).
enum class ExportSyntax {
  Yaml,         ///< groups by indentation; every number with a decimal point, as readers of YAML 1.1 and OpenCV want it
  Cpp,          ///< `params.name = gtsam::Vector3(x, y, z).asDiagonal();`
  Matlab,       ///< `name = [x y z];`
  PythonDict,   ///< `'name': np.array([x, y, z]),`
  PythonNames,  ///< `NAME = x`
  Xml,          ///< groups as elements
  ParameterRows,   ///< vehicle, component, name, value, type: what QGroundControl loads
  ParameterPairs,  ///< name,value: what Mission Planner and MAVProxy load
};

/// The bias that the program models.
enum class BiasModel { None, Walk, Markov };

/// One name of the file with its figures.
struct ExportEntry {
  std::string key;                        ///< as the program spells it; groups before it, separated by '/'
  std::vector<NoiseFigure> figures = {};  ///< in the program's unit; several make a list
  bool list = false;                      ///< write a list, of one figure too
  std::string text = {};                  ///< in place of figures: a word or text that the file needs
  std::string unit = {};
  std::string what = {};  ///< in words

  /// Every figure has a value (an entry of text always has).
  [[nodiscard]] bool complete() const;
};

struct ExportTarget {
  std::string_view name;        ///< `kalibr`
  std::string_view title;       ///< for people
  std::string_view file;        ///< name of the file by custom
  std::string_view convention;  ///< what its numbers mean, a sentence
  std::string_view source;      ///< where that is stated
  ExportSyntax syntax = ExportSyntax::Yaml;
  BiasModel bias = BiasModel::Walk;
  std::string_view first_line = {};  ///< that must stand before everything else
  std::string_view prologue = {};    ///< lines before the entries
  std::string_view epilogue = {};    ///< and after them
  std::vector<ExportEntry> (*entries)(const ImuNoise& imu) = nullptr;
};

/// Every target, in the order in which they are listed.
[[nodiscard]] std::span<const ExportTarget> export_targets();

/// Error: InvalidArgument, naming the known ones.
[[nodiscard]] Result<const ExportTarget*> find_export_target(std::string_view name);

/// The figure of a sensor for programs that have one number for all its axes: the largest that is identified, for a
/// filter that is told too little noise trusts what it should not; where none is, the least upper limit. Its remark
/// names the axis.
[[nodiscard]] NoiseFigure largest(const SensorNoise& sensor, NoiseFigure AxisNoise::* member);

/// The figures about x, y and z. An axis that is not in the recording, or whose figure is a limit where others are
/// identified, gets the largest of the others, and its remark says so. A correlation time is always that of the axis
/// whose bias_sd stands beside it: 2 bias_sd^2 / T is how fast a bias moves, and of two axes it is that of neither.
[[nodiscard]] std::vector<NoiseFigure> by_axis(const SensorNoise& sensor, NoiseFigure AxisNoise::* member);

/// `figures`, each times `factor`.
[[nodiscard]] std::vector<NoiseFigure> scaled(std::vector<NoiseFigure> figures, double factor);

/// deg/h in one rad/s, and deg/sqrt(h) in one rad/s/sqrt(Hz); m/s/sqrt(h) in one m/s^2/sqrt(Hz).
inline constexpr double kDegreesPerHour = 3600.0 / kDegree;
inline constexpr double kDegreesPerRootHour = 60.0 / kDegree;
inline constexpr double kMetresPerSecondPerRootHour = 60.0;

}  // namespace driftlab
