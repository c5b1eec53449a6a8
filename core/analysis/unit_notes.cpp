#include "core/analysis/unit_notes.hpp"

#include "core/datasheet/plausible_units.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

constexpr std::size_t kMostSamples = 200000;

/// The readings of a channel in its longest run.
std::span<const double> longest_run(const RecordingView& view, const ColumnFile& columns, const ChannelView& channel) {
  const auto name = std::find(columns.names().begin(), columns.names().end(), channel.column);
  if (name == columns.names().end()) {
    return {};
  }
  const auto index = static_cast<std::size_t>(name - columns.names().begin());
  const bool copied = index < view.distinct.size() && !view.distinct[index].empty();
  if (!view.distinct.empty() && !copied) {
    return {};
  }
  const std::span<const double> all = copied ? std::span<const double>(view.distinct[index]) : columns.column(index);
  const RowRun run = channel.stretch.longest();
  return run.first + run.count > all.size() ? std::span<const double>()
                                            : all.subspan(run.first, std::min(run.count, kMostSamples));
}

}  // namespace

void add_unit_notes(RecordingView& view, const ColumnFile& columns, const RecordingSpec& spec,
                    std::span<const std::string> hardware) {
  if (!spec.calibration.empty()) {
    return;
  }
  std::vector<ObservedChannel> observed;
  for (const ChannelView& channel : view.channels) {
    const Quantity quantity = channel.role.quantity;
    if (channel.role.unit && (quantity == Quantity::AngularRate || quantity == Quantity::SpecificForce)) {
      observed.push_back(
          {channel.column, quantity, channel.role.axis, *channel.role.unit, longest_run(view, columns, channel)});
    }
  }
  const bool at_rest = spec.condition.kind == ConditionKind::Static;
  for (std::string& note : unit_notes(observed, view.window.time.dt_s, at_rest, hardware)) {
    view.window.quality.notes.push_back(std::move(note));
  }
  if (view.distinct.empty()) {
    for (const ObservedChannel& channel : observed) {
      columns.release(channel.samples);
    }
  }
}

}  // namespace driftlab
