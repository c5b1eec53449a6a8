/// Prints the table of tests/data/FORMATS.md: every file under a folder of recordings, as driftlab takes or refuses it.
///
///   cmake --build --preset release --target formats_table
///   build/release/bin/formats_table ../shared/data > tests/data/FORMATS.md
///
/// Columns are understood by their names alone. A file without a time column is given 100 Hz and marked; each channel
/// is characterised (at most its first 100000 samples, white noise only), and counted if that succeeds.
#include "core/fit/characterise.hpp"
#include "core/read/column_file.hpp"
#include "core/read/format.hpp"
#include "core/signal/number.hpp"
#include "core/signal/recording_view.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace driftlab;
namespace fs = std::filesystem;

constexpr std::size_t kMostSamples = 100'000;

/// Text that stays within its cell.
std::string cell(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    safe += c == '|' ? '/' : c;
  }
  return safe.size() > 420 ? safe.substr(0, 400) + " ..." : safe;
}

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) {
    text += (text.empty() ? "" : " ") + sentence;
  }
  return text;
}

Result<RecordingView> view(const ColumnFile& columns, std::optional<double> rate_hz) {
  RecordingSpec spec;
  spec.rate_hz = rate_hz;
  return view_recording(spec, columns.names(), columns.rows(), [&](std::size_t i) { return columns.column(i); });
}

bool needs_rate(const Error& error) {
  return error.code == ErrorCode::InconsistentSampling && !error.fields.empty() && error.fields[0].value == "rate_hz";
}

/// The rate that a time column without a unit shows.
std::optional<double> measured_rate(const Error& error) {
  for (const ErrorField& field : error.fields) {
    if (field.name == "measured_hz") {
      return parse_double(field.value);
    }
  }
  return std::nullopt;
}

/// One row of the table.
std::string row(const fs::path& file, const std::string& name, const fs::path& scratch) {
  const auto decoded = decode_file(file, scratch);
  if (!decoded) {
    return "| " + name + " | refused | | " + cell(decoded.error().message) + " |";
  }
  const auto columns = ColumnFile::open(scratch);
  if (!columns) {
    return "| " + name + " | refused | | " + cell(columns.error().message) + " |";
  }
  const std::string form = std::string(decoded->format) + ", " + std::to_string(decoded->rows) + " x " +
                           std::to_string(decoded->names.size());
  auto seen = view(*columns, std::nullopt);
  const bool rate_given = !seen && needs_rate(seen.error());
  double rate_hz = 100.0;
  if (rate_given) {
    seen = view(*columns, rate_hz);
    if (const auto measured = seen ? std::nullopt : measured_rate(seen.error())) {
      rate_hz = *measured;
      seen = view(*columns, rate_hz);
    }
  }
  if (!seen) {
    return "| " + name + " | refused | " + form + " | " + cell(seen.error().message) + " |";
  }
  std::size_t characterised = 0;
  std::string first_fault;
  for (const ChannelView& channel : seen->channels) {
    CharacteriseOptions options;
    options.models = {"WN"};
    const auto values = channel.values.first(std::min(channel.values.size(), kMostSamples));
    std::vector<Gap> gaps = channel.gaps;
    std::erase_if(gaps, [&](const Gap& gap) { return gap.row >= values.size(); });
    const auto result = characterise_channel({values, seen->window.time.dt_s, 1.0, gaps}, options);
    characterised += result ? 1 : 0;
    if (!result && first_fault.empty()) {
      first_fault = "Column '" + channel.column + "': " + result.error().message;
    }
  }
  std::vector<std::string> said = decoded->notes;
  if (rate_given) {
    said.push_back("It states no rate: " + to_text(rate_hz) + " Hz is given here.");
  }
  for (const std::string& note : seen->window.quality.notes) {
    if (note.find("is not stated; its unit is 1") == std::string::npos) {
      said.push_back(note);
    }
  }
  if (!first_fault.empty()) {
    said.push_back(first_fault);
  }
  return "| " + name + " | " + std::to_string(characterised) + " of " + std::to_string(seen->channels.size()) +
         " channels | " + form + " | " + cell(joined(said)) + " |";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 || !fs::is_directory(argv[1])) {
    std::cerr << "usage: formats_table FOLDER\n";
    return 2;
  }
  const fs::path folder(argv[1]);
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && !name.ends_with(".md") && !name.ends_with(".json")) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::cout
      << "# Real recordings, as driftlab takes or refuses them\n\n"
         "Made by `build/release/bin/formats_table ../shared/data > tests/data/FORMATS.md` (target `formats_table`).\n"
         "Columns are understood by their names alone; those without a meaning are channels in unit 1.\n\n"
         "| file | outcome | read as | what is said |\n|---|---|---|---|\n";
  std::string scratch = (fs::temp_directory_path() / "driftlab-formats-XXXXXX").string();
  const fs::path directory = ::mkdtemp(scratch.data());
  for (const fs::path& file : files) {
    std::cout << row(file, fs::relative(file, folder).string(), directory / "columns") << "\n" << std::flush;
    std::error_code ignored;
    fs::remove(directory / "columns", ignored);
  }
  fs::remove_all(directory);
  return 0;
}
