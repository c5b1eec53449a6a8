/// The log of a VMU931: one row per sensor and instant, `Attribute,Time stamp,x,y,z`. The attribute names the sensor by
/// its first letter (accelerometer [g], gyroscope [deg/s], magnetometer [uT]); stamps are whole milliseconds, many of
/// them twice at 1 kHz.
#include "core/read/decimal.hpp"
#include "core/read/dialect.hpp"
#include "core/read/formats.hpp"
#include "core/read/phone_export.hpp"
#include "core/read/text_shape.hpp"
#include "core/signal/text.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab::formats {
namespace {

constexpr std::string_view kHeader = "attribute,timestamp,x,y,z";
constexpr std::size_t kLongestLine = 256;

struct Attribute {
  char letter;
  std::string_view name;
  std::string_view unit;
};

constexpr std::array kAttributes{
    Attribute{'g', "Gyroscope", "deg/s"},
    Attribute{'a', "Accelerometer", "g"},
    Attribute{'m', "Magnetometer", "uT"},
};

bool is_header(std::string_view line) {
  std::string squashed;
  for (const char c : line) {
    if (c != ' ' && c != '"' && c != '\r') {
      squashed += lower_case(c);
    }
  }
  return squashed == kHeader;
}

int sniff(std::string_view head) {
  return is_header(head.substr(0, std::min(head.find('\n'), kLongestLine))) ? 100 : 0;
}

class RowReader {
 public:
  RowReader() : tables_(kAttributes.size()) {
    for (std::size_t i = 0; i < kAttributes.size(); ++i) {
      tables_[i].name = kAttributes[i].name;
      tables_[i].names.emplace_back("time (s)");
      for (const char axis : {'x', 'y', 'z'}) {
        tables_[i].names.push_back(std::string(1, axis) + " (" + std::string(kAttributes[i].unit) + ")");
      }
      tables_[i].columns.resize(4);
    }
  }

  Status take(std::string_view line, std::size_t& budget) {
    ++line_;
    line = text::trim(line);
    if (line.empty() || line_ == 1) {
      return {};
    }
    const std::vector<std::string> cells = text::split_cells(line, ',');
    const std::string row = std::to_string(line_);
    if (cells.size() != 5 || cells[0].empty()) {
      return fail(ErrorCode::RaggedRow, "Line " + row + " has not the five cells of the header.", {{"row", row}});
    }
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string& cell = cells[i + 1];
      if (decimal::parse(cell.c_str(), values[i]) != cell.c_str() + cell.size() || !std::isfinite(values[i])) {
        return fail(ErrorCode::NotANumber, "Line " + row + ": " + text::excerpt(cell) + " is not a number.",
                    {{"row", row}});
      }
    }
    const char letter = static_cast<char>(cells[0][0] | 0x20);
    for (std::size_t i = 0; i < kAttributes.size(); ++i) {
      if (kAttributes[i].letter == letter) {
        return append(tables_[i], values, budget);
      }
    }
    ++others_;
    return {};
  }

  [[nodiscard]] std::size_t others() const { return others_; }
  /// The sensors that have samples.
  [[nodiscard]] std::vector<MemoryTable> tables() && {
    std::erase_if(tables_, [](const MemoryTable& table) { return table.rows() == 0; });
    return std::move(tables_);
  }

 private:
  static Status append(MemoryTable& table, const std::array<double, 4>& values, std::size_t& budget) {
    if (budget < sizeof values) {
      return fail(ErrorCode::LimitExceeded, "The file holds more samples than can be put together.");
    }
    budget -= sizeof values;
    table.columns[0].push_back(values[0] * 1e-3);
    for (std::size_t i = 1; i < values.size(); ++i) {
      table.columns[i].push_back(values[i]);
    }
    return {};
  }

  std::vector<MemoryTable> tables_;
  std::uint64_t line_ = 0;
  std::size_t others_ = 0;
};

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  RowReader rows;
  std::size_t budget = limits.max_tables_bytes;
  while (true) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto view = source.view(kLongestLine);
    if (!view) {
      return fail(view.error());
    }
    if (view->empty()) {
      break;
    }
    const std::size_t end = std::min(view->find('\n'), view->size());
    if (end >= kLongestLine) {
      return fail(ErrorCode::LimitExceeded, "A line is longer than " + std::to_string(kLongestLine) + " bytes.");
    }
    if (auto status = rows.take(view->substr(0, end), budget); !status) {
      return status;
    }
    source.consume(std::min(end + 1, view->size()));
  }
  if (rows.others() > 0) {
    sink.note(
        with_count(rows.others(), "row of other attributes is left out.", "rows of other attributes are left out."));
  }
  return deliver_phone_export(std::move(rows).tables(), limits, sink);
}

}  // namespace

const Format kVmu931{"vmu931", "log of a VMU931", sniff, decode};

}  // namespace driftlab::formats
