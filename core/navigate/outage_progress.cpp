#include "core/navigate/outage_progress.hpp"

#include "core/signal/number.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/with_count.hpp"

#include <utility>

namespace driftlab {
namespace {

constexpr std::string_view kBeginning = "outages, mean after ";
constexpr std::string_view kNext = ", ";

/// What stands before `end`, which is taken off `text` with it; nothing where `end` does not follow.
std::optional<std::string_view> taken(std::string_view& text, std::string_view end) {
  const std::size_t at = text.find(end);
  if (at == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view before = text.substr(0, at);
  text.remove_prefix(at + end.size());
  return before;
}

std::optional<double> taken_number(std::string_view& text, std::string_view end) {
  const auto said = taken(text, end);
  return said ? parse_double(*said) : std::nullopt;
}

/// "M_stat(AV) 12 m [10, 14]" off the beginning of `text`: the number begins behind the last space before " m [".
std::optional<OutagesSoFar::Filter> taken_filter(std::string_view& text) {
  const std::string_view named = taken(text, " m [").value_or(std::string_view());
  const std::size_t space = named.rfind(' ');
  if (space == std::string_view::npos || space == 0) {
    return std::nullopt;
  }
  const auto value = parse_double(named.substr(space + 1));
  const auto low = taken_number(text, ", ");
  const auto high = taken_number(text, "]");
  if (!value || !low || !high) {
    return std::nullopt;
  }
  return OutagesSoFar::Filter{std::string(named.substr(0, space)), {*value, {*low, *high}}};
}

}  // namespace

std::string stage_of(const OutagesSoFar& known) {
  std::string stage = std::string(kBeginning) + with_count(known.runs, "run") + ":";
  for (std::size_t f = 0; f < known.filters.size(); ++f) {
    const auto& [name, error] = known.filters[f];
    const auto [low, high] = error.ci95;
    stage.append(f == 0 ? " " : kNext);
    stage += name + " " + significant(error.value, low, high) + " m [" + significant(low, low, high) + ", " +
             significant(high, low, high) + "]";
  }
  return stage;
}

std::optional<OutagesSoFar> outages_so_far(std::string_view stage) {
  if (!stage.starts_with(kBeginning)) {
    return std::nullopt;
  }
  stage.remove_prefix(kBeginning.size());
  const auto runs = taken_number(stage, " ");
  if (!runs || !(*runs >= 1.0) || !taken(stage, ": ")) {
    return std::nullopt;
  }
  OutagesSoFar known{static_cast<std::size_t>(*runs), {}};
  for (;;) {
    auto filter = taken_filter(stage);
    if (!filter) {
      return std::nullopt;
    }
    known.filters.push_back(std::move(*filter));
    if (stage.empty()) {
      return known;
    }
    if (!stage.starts_with(kNext)) {
      return std::nullopt;
    }
    stage.remove_prefix(kNext.size());
  }
}

}  // namespace driftlab
