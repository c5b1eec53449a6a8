#include "core/investigate/study/series.hpp"

#include <algorithm>
#include <utility>

namespace driftlab::investigate {
namespace {

/// Places of a grid of `count` that are left of every `every`-th from `phase` on.
std::size_t left_of(std::size_t count, std::size_t every, std::size_t phase) {
  return count > phase ? (count - phase + every - 1) / every : 0;
}

}  // namespace

Series::Series(std::vector<double> values) : count_(values.size()) {
  first_.own = std::make_shared<const std::vector<double>>(std::move(values));
  first_.data = first_.own->data();
}

Series Series::constant(double value, std::size_t count) {
  Series series;
  series.count_ = count;
  series.first_.value = value;
  return series;
}

Series Series::view(std::span<const double> values) {
  Series series;
  series.count_ = values.size();
  series.first_.data = values.data();
  return series;
}

Series Series::column(std::span<const double> rows, const Unit& unit) {
  Series series = view(rows);
  series.first_.converts = true;
  series.first_.factor = unit.factor;
  series.first_.offset = unit.offset;
  return series;
}

Series Series::minus(const Series& other) const {
  Series result = is_plain() ? *this : Series(values());
  result.second_ = other.is_plain() ? other.first_ : Series(other.values()).first_;
  result.subtracts_ = true;
  return result;
}

Series Series::minus(double value) const {
  Series result = shifted_ ? Series(values()) : *this;
  result.shift_ = value;
  result.shifted_ = true;
  return result;
}

Series Series::part(std::size_t from, std::size_t count) const {
  Series result = *this;
  result.count_ = count;
  for (Term* const term : {&result.first_, &result.second_}) {
    term->data = term->data == nullptr ? nullptr : term->data + from;
  }
  return result;
}

Series Series::thinned(std::size_t every, std::size_t phase) const {
  std::vector<double> kept(left_of(count_, every, phase));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    kept[i] = (*this)[phase + i * every];
  }
  return kept;
}

std::vector<double> Series::values() const {
  std::vector<double> all(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    all[i] = (*this)[i];
  }
  return all;
}

Presence::Presence(std::vector<unsigned char> places)
    : count_(places.size()), places_(std::make_shared<const std::vector<unsigned char>>(std::move(places))) {}

std::size_t Presence::absent() const {
  return places_ == nullptr ? 0 : static_cast<std::size_t>(std::count(places_->begin(), places_->end(), 0));
}

Presence Presence::thinned(std::size_t every, std::size_t phase) const {
  if (places_ == nullptr) {
    return Presence(left_of(count_, every, phase));
  }
  std::vector<unsigned char> kept(left_of(count_, every, phase));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    kept[i] = (*places_)[phase + i * every];
  }
  return Presence(std::move(kept));
}

std::vector<unsigned char> Presence::places() const {
  return places_ == nullptr ? std::vector<unsigned char>(count_, 1) : *places_;
}

}  // namespace driftlab::investigate
