#include "core/read/trace_pyramid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kLeaf = 256;                    ///< samples of a node of level 0
constexpr std::size_t kFactor = 16;                   ///< nodes of a level in one of the next
constexpr std::size_t kHeld = std::size_t{1} << 19U;  ///< samples in memory at once, whole nodes of level 0
constexpr std::size_t kFields = 4;
constexpr std::array<const char*, kFields> kNames{".low", ".high", ".sum", ".present"};

struct Node {
  double low = 0.0;
  double high = 0.0;
  double sum = 0.0;
  double present = 0.0;  ///< a count, exact below 2^53

  void add(const Node& other) {
    if (other.present > 0.0) {
      low = present > 0.0 ? std::min(low, other.low) : other.low;
      high = present > 0.0 ? std::max(high, other.high) : other.high;
      sum += other.sum;
      present += other.present;
    }
  }
  void add(std::span<const double> samples) {
    for (const double x : samples) {
      if (std::isfinite(x)) {
        add(Node{x, x, x, 1.0});
      }
    }
  }
};

std::size_t parts(std::size_t count, std::size_t length) { return (count + length - 1) / length; }

/// The number of nodes of each level of a column of `rows` samples.
std::vector<std::size_t> level_sizes(std::size_t rows) {
  std::vector<std::size_t> sizes{parts(rows, kLeaf)};
  while (sizes.back() > kFactor) {
    sizes.push_back(parts(sizes.back(), kFactor));
  }
  return sizes;
}

std::size_t node_count(std::size_t rows) {
  std::size_t count = 0;
  for (const std::size_t size : level_sizes(rows)) {
    count += size;
  }
  return count;
}

ColumnNames names_of(std::size_t columns) {
  ColumnNames names;
  for (std::size_t i = 0; i < columns; ++i) {
    for (const char* const field : kNames) {
      names.push_back(std::to_string(i) + field);
    }
  }
  return names;
}

/// All levels of one column, the finest first. Pages of the file are given back as they were read.
std::vector<Node> nodes_of(const ColumnFile& columns, std::size_t column) {
  const std::span<const double> samples = columns.column(column);
  std::vector<Node> nodes;
  nodes.reserve(node_count(samples.size()));
  for (std::size_t begin = 0; begin < samples.size(); begin += kHeld) {
    const std::span<const double> held = samples.subspan(begin, std::min(kHeld, samples.size() - begin));
    for (std::size_t first = 0; first < held.size(); first += kLeaf) {
      nodes.emplace_back().add(held.subspan(first, std::min(kLeaf, held.size() - first)));
    }
    columns.release(held);
  }
  std::size_t below = 0;
  const auto sizes = level_sizes(samples.size());
  for (std::size_t level = 1; level < sizes.size(); ++level) {
    const std::size_t end = nodes.size();
    for (std::size_t first = below; first < end; first += kFactor) {
      Node node;
      for (std::size_t i = first; i < std::min(first + kFactor, end); ++i) {
        node.add(nodes[i]);
      }
      nodes.push_back(node);
    }
    below = end;
  }
  return nodes;
}

double field_of(const Node& node, std::size_t field) {
  const std::array<double, kFields> fields{node.low, node.high, node.sum, node.present};
  return fields[field];
}

/// One column's samples and nodes.
class Column {
 public:
  Column(std::span<const double> samples, const ColumnFile& nodes, std::size_t index)
      : samples_(samples), sizes_(level_sizes(samples.size())) {
    for (std::size_t field = 0; field < kFields; ++field) {
      fields_[field] = nodes.column(kFields * index + field);
    }
  }

  /// Samples [first, end), from the largest nodes that lie inside and single samples at the ends.
  [[nodiscard]] Node over(std::size_t first, std::size_t end) const {
    Node all;
    while (first < end) {
      const auto [level, length] = largest_at(first, end);
      if (length == 1) {
        const std::size_t stop = std::min(end, (first / kLeaf + 1) * kLeaf);
        all.add(samples_.subspan(first, stop - first));
        first = stop;
      } else {
        all.add(node(level, first / length));
        first += length;
      }
    }
    return all;
  }

 private:
  struct Fitting {
    std::size_t level = 0;
    std::size_t length = 1;  ///< samples; 1: no node begins here and ends in time
  };
  [[nodiscard]] Fitting largest_at(std::size_t first, std::size_t end) const {
    Fitting fitting;
    std::size_t length = kLeaf;
    for (std::size_t level = 0; level < sizes_.size() && first % length == 0 && first + length <= end; ++level) {
      fitting = {level, length};
      length *= kFactor;
    }
    return fitting;
  }
  [[nodiscard]] Node node(std::size_t level, std::size_t index) const {
    for (std::size_t i = 0; i < level; ++i) {
      index += sizes_[i];
    }
    return {fields_[0][index], fields_[1][index], fields_[2][index], fields_[3][index]};
  }

  std::span<const double> samples_;
  std::vector<std::size_t> sizes_;
  std::array<std::span<const double>, kFields> fields_;
};

}  // namespace

std::size_t pyramid_stretch(std::size_t count, std::size_t most) {
  if (count < kPyramidRows || most < 2) {
    return 0;
  }
  const std::size_t length = parts(count, most - 1);  // the first and the last stretch may be parts of one
  return length < kLeaf ? 0 : parts(length, kLeaf) * kLeaf;
}

Status write_trace_pyramid(const ColumnFile& columns, const std::filesystem::path& path) {
  auto writer = ColumnFileWriter::create(path, names_of(columns.names().size()));
  if (!writer) {
    return fail(writer.error());
  }
  for (std::size_t i = 0; i < columns.names().size(); ++i) {
    const std::vector<Node> nodes = nodes_of(columns, i);
    std::vector<double> values(nodes.size());
    for (std::size_t field = 0; field < kFields; ++field) {
      std::transform(nodes.begin(), nodes.end(), values.begin(),
                     [&](const Node& node) { return field_of(node, field); });
      if (auto written = writer->append_column(kFields * i + field, values); !written) {
        return written;
      }
    }
  }
  return writer->finish().map([](std::size_t) {});
}

Result<TracePyramid> TracePyramid::open(const std::filesystem::path& path, const ColumnFile& columns) {
  auto nodes = ColumnFile::open(path);
  if (!nodes) {
    return fail(nodes.error());
  }
  if (nodes->names() != names_of(columns.names().size()) || nodes->rows() != node_count(columns.rows())) {
    return fail(ErrorCode::ShapeMismatch, "The pyramid '" + path.filename().string() + "' is not that of its columns.");
  }
  return TracePyramid(std::move(*nodes));
}

std::vector<TraceBucket> TracePyramid::trace(const ColumnFile& columns, std::size_t column, std::size_t first,
                                             std::size_t count, std::size_t most) const {
  const Column nodes(columns.column(column), nodes_, column);
  const std::size_t length = std::max(kLeaf, pyramid_stretch(count, most));
  const std::size_t end = first + count;
  std::vector<TraceBucket> buckets;
  for (std::size_t begin = first; begin < end;) {
    const std::size_t stop = std::min(end, (begin / length + 1) * length);
    const Node node = nodes.over(begin, stop);
    buckets.push_back({begin, static_cast<std::size_t>(node.present), node.low, node.high,
                       node.present > 0.0 ? node.sum / node.present : 0.0});
    begin = stop;
  }
  return buckets;
}

}  // namespace driftlab
