#include "schema/text/export.hpp"

#include "core/fit/characterise.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace driftlab {
namespace {

/// Six digits and always a decimal point: readers of YAML 1.1 take 1e-5 for a word, OpenCV takes 200 for an integer.
std::string export_number(double value) {
  std::array<char, 32> buffer{};
  (void)std::snprintf(buffer.data(), buffer.size(), "%.6g", value);
  std::string text = buffer.data();
  if (text.find('.') == std::string::npos) {
    const std::size_t exponent = text.find('e');
    text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
  }
  return text;
}

struct SyntaxWords {
  const char* comment;
  const char* comment_end;
};

SyntaxWords words_of(ExportSyntax syntax) {
  switch (syntax) {
    case ExportSyntax::Cpp:
      return {"// ", ""};
    case ExportSyntax::Matlab:
      return {"% ", ""};
    case ExportSyntax::Xml:
      return {"<!-- ", " -->"};
    case ExportSyntax::Yaml:
    case ExportSyntax::PythonDict:
    case ExportSyntax::PythonNames:
    case ExportSyntax::ParameterRows:
    case ExportSyntax::ParameterPairs:
      break;
  }
  return {"# ", ""};
}

/// A comment of any length on lines of at most 120 characters.
std::string export_comment(ExportSyntax syntax, const std::string& indent, std::string sentence) {
  if (syntax == ExportSyntax::Xml) {
    for (std::size_t at = sentence.find("--"); at != std::string::npos; at = sentence.find("--", at)) {
      sentence.replace(at, 2, "- -");
    }
  }
  std::replace(sentence.begin(), sentence.end(), '\n', ' ');
  const SyntaxWords words = words_of(syntax);
  constexpr std::size_t kWidth = 112;
  std::string text;
  while (!sentence.empty()) {
    std::size_t end = sentence.size();
    if (end > kWidth) {
      end = sentence.rfind(' ', kWidth);
      end = end == std::string::npos || end == 0 ? sentence.find(' ') : end;
      end = std::min(end, sentence.size());
    }
    text += indent + words.comment + sentence.substr(0, end) + words.comment_end + "\n";
    sentence.erase(0, std::min(end + 1, sentence.size()));
  }
  return text;
}

std::string interval_text(const NoiseFigure& figure) {
  const std::string words = "95 % interval ";
  if (figure.low && figure.high) {
    return words + export_number(*figure.low) + " .. " + export_number(*figure.high);
  }
  if (figure.low) {
    return words + "above " + export_number(*figure.low);
  }
  return figure.high ? words + "below " + export_number(*figure.high) : std::string();
}

/// What is known of the figures, of several each behind its axis.
std::string knowledge(const ExportEntry& entry) {
  const std::size_t count = entry.figures.size();
  constexpr std::array<const char*, 3> kAxes{"x: ", "y: ", "z: "};
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    const NoiseFigure& figure = entry.figures[i];
    const std::string interval = interval_text(figure);
    const std::string words = interval + (interval.empty() || figure.remark.empty() ? "" : "; ") + figure.remark;
    if (!words.empty()) {
      const std::size_t axis = count == 9 ? i / 4 : std::min<std::size_t>(i, 2);
      text += (text.empty() ? "" : ". ") + std::string(count > 1 ? kAxes[axis] : "") + words;
    }
  }
  return text.empty() || text.back() == '.' ? text : text + ".";
}

std::string head_of(const ExportEntry& entry) {
  std::string text = entry.what;
  if (!entry.unit.empty()) {
    text += (text.empty() ? "[" : " [") + entry.unit + "]";
  }
  const std::string known = knowledge(entry);
  return text + (known.empty() || text.empty() ? "" : ": ") + known;
}

struct SplitKey {
  std::vector<std::string> groups;
  std::string name;
};

/// The groups before a name; a quoted attribute of a group may hold a slash nowhere.
SplitKey split_key(const std::string& key) {
  SplitKey split;
  std::size_t from = 0;
  for (std::size_t at = key.find('/'); at != std::string::npos; at = key.find('/', from)) {
    split.groups.push_back(key.substr(from, at - from));
    from = at + 1;
  }
  split.name = key.substr(from);
  return split;
}

std::string first_word(const std::string& text) { return text.substr(0, text.find(' ')); }

std::string indent_of(std::size_t depth) { return std::string(2 * depth, ' '); }

std::string joined(const ExportEntry& entry, const char* separator) {
  if (!entry.text.empty()) {
    return entry.text;
  }
  std::string text;
  for (const NoiseFigure& figure : entry.figures) {
    text += (text.empty() ? "" : separator) + export_number(figure.value.value_or(0.0));
  }
  return text;
}

/// The line of an entry whose figures are all there.
std::string line_of(ExportSyntax syntax, const std::string& name, const ExportEntry& entry) {
  const bool list = entry.list && entry.text.empty();
  switch (syntax) {
    case ExportSyntax::Yaml:
      return name + ": " + (list ? "[" + joined(entry, ", ") + "]" : joined(entry, ", "));
    case ExportSyntax::Cpp:
      return "  params." + name + " = gtsam::Vector3(" + joined(entry, ", ") + ").asDiagonal();";
    case ExportSyntax::Matlab:
      return name + " = " + (list ? "[" + joined(entry, " ") + "]" : joined(entry, " ")) + ";";
    case ExportSyntax::PythonDict:
      return "    '" + name + "': " + (list ? "np.array([" + joined(entry, ", ") + "])" : joined(entry, ", ")) + ",";
    case ExportSyntax::PythonNames:
      return name + " = " + joined(entry, ", ");
    case ExportSyntax::Xml:
      return "<" + name + ">" + joined(entry, " ") + "</" + name + ">";
    case ExportSyntax::ParameterRows:
      return "1\t1\t" + name + "\t" + joined(entry, " ") + "\t9";
    case ExportSyntax::ParameterPairs:
      break;
  }
  return name + "," + joined(entry, " ");
}

/// Python cannot leave a name out that is used below: it says None, loudly.
std::string line_without(ExportSyntax syntax, const std::string& name) {
  if (syntax == ExportSyntax::PythonDict) {
    return "    '" + name + "': None,\n";
  }
  return syntax == ExportSyntax::PythonNames ? name + " = None\n" : std::string();
}

std::string missing_of(const ExportEntry& entry) {
  const auto none = std::find_if(entry.figures.begin(), entry.figures.end(),
                                 [](const NoiseFigure& figure) { return !figure.value.has_value(); });
  return none == entry.figures.end() ? std::string() : none->remark;
}

/// Opens and closes groups so that the entry stands in its own.
std::string move_to(ExportSyntax syntax, const std::vector<std::string>& wanted, std::vector<std::string>& open) {
  std::string text;
  std::size_t shared = 0;
  while (shared < open.size() && shared < wanted.size() && open[shared] == wanted[shared]) {
    ++shared;
  }
  while (open.size() > shared) {
    if (syntax == ExportSyntax::Xml) {
      text += indent_of(open.size() - 1) + "</" + first_word(open.back()) + ">\n";
    }
    open.pop_back();
  }
  while (open.size() < wanted.size()) {
    const std::string& group = wanted[open.size()];
    text += indent_of(open.size()) + (syntax == ExportSyntax::Xml ? "<" + group + ">" : group + ":") + "\n";
    open.push_back(group);
  }
  return text;
}

std::string entries_to_text(const ExportTarget& target, const std::vector<ExportEntry>& entries) {
  const ExportSyntax syntax = target.syntax;
  std::vector<std::string> open;
  std::string text;
  for (const ExportEntry& entry : entries) {
    const SplitKey key = split_key(entry.key);
    text += move_to(syntax, key.groups, open);
    const std::string indent = syntax == ExportSyntax::Cpp          ? "  "
                               : syntax == ExportSyntax::PythonDict ? "    "
                                                                    : indent_of(key.groups.size());
    if (entry.complete()) {
      text += export_comment(syntax, indent, head_of(entry));
      const bool grouped = syntax == ExportSyntax::Yaml || syntax == ExportSyntax::Xml;
      text += (grouped ? indent : "") + line_of(syntax, key.name, entry) + "\n";
    } else {
      text += export_comment(syntax, indent, key.name + " is not given. " + missing_of(entry));
      text += line_without(syntax, key.name);
    }
  }
  return text + move_to(syntax, {}, open);
}

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

std::string model_words(BiasModel bias) {
  switch (bias) {
    case BiasModel::Walk:
      return "Model: white noise and a random walk of the bias, fitted as such (WN+RW).";
    case BiasModel::Markov:
      return "Model: white noise and a first-order Gauss-Markov bias, fitted as such (WN+GM).";
    case BiasModel::None:
      break;
  }
  return "Model: white noise alone.";
}

}  // namespace

std::string export_to_text(const ExportTarget& target, const ImuNoise& imu) {
  const auto comment = [&](const std::string& sentence) { return export_comment(target.syntax, "", sentence); };
  std::string text = target.first_line.empty() ? "" : std::string(target.first_line) + "\n";
  text += comment(std::string(target.title) + ", of device " + imu.device + " (" + imu.condition + ").");
  text += comment("Made by driftlab " DRIFTLAB_VERSION ", algorithm " + std::to_string(kAlgorithmVersion) +
                  ", from recording" + (imu.recordings.size() == 1 ? " " : "s ") + list_of(imu.recordings) + ", " +
                  export_number(imu.rate_hz) + " Hz.");
  text += comment(model_words(target.bias));
  text += comment("Convention: " + std::string(target.convention));
  text += comment("Source of the convention: " + std::string(target.source));
  text += "\n";
  text += target.prologue;
  text += entries_to_text(target, target.entries(imu));
  text += target.epilogue;
  return text;
}

std::vector<std::string> export_gaps(const ExportTarget& target, const ImuNoise& imu) {
  std::vector<std::string> gaps;
  for (const ExportEntry& entry : target.entries(imu)) {
    if (!entry.complete()) {
      gaps.push_back(entry.key + " is not given. " + missing_of(entry));
    } else if (std::any_of(entry.figures.begin(), entry.figures.end(),
                           [](const NoiseFigure& figure) { return figure.limit; })) {
      gaps.push_back(entry.key + " is an upper limit: the recording does not identify it.");
    }
  }
  return gaps;
}

bool has_noise(const ImuNoise& imu) {
  const auto known = [](const SensorNoise& sensor) {
    return std::any_of(sensor.axes.begin(), sensor.axes.end(),
                       [](const AxisNoise& axis) { return axis.density.value.has_value(); });
  };
  return known(imu.gyroscope) || known(imu.accelerometer);
}

std::string export_targets_to_text() {
  std::size_t width = 0;
  for (const ExportTarget& target : export_targets()) {
    width = std::max(width, target.name.size());
  }
  std::string text;
  for (const ExportTarget& target : export_targets()) {
    text +=
        std::string(target.name) + std::string(width - target.name.size() + 2, ' ') + std::string(target.title) + "\n";
  }
  return text;
}

}  // namespace driftlab
