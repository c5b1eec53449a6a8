#pragma once
/// One value per sample of a grid, or of a part of one, computed when it is read instead of stored.
///
/// A recording of a day has millions of samples in every channel, and the search needs them in SI, less the reference,
/// and less the bias. Stored, each of these would take 8 bytes a sample. A `Series` keeps the operands and computes a
/// value when it is asked for:
///   value(i) = (first(i) - second(i)) - shift,
/// where `first` and `second` are each a column of the file in SI, a constant, or stored values. Values are equal to
/// the bit to those of the same operations done beforehand. Copies of a series share its stored values.
#include "core/signal/unit.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace driftlab::investigate {

class Series {
 public:
  class Iterator;

  Series() = default;
  /// Stored values.
  // NOLINTNEXTLINE(google-explicit-constructor): a vector is a series, and stands where one is asked for
  Series(std::vector<double> values);
  [[nodiscard]] static Series constant(double value, std::size_t count);
  /// A column of a file, converted to SI as it is read. `rows` are not copied and must outlive the series.
  [[nodiscard]] static Series column(std::span<const double> rows, const Unit& unit);
  /// Values that are not copied and must outlive the series.
  [[nodiscard]] static Series view(std::span<const double> values);

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] double operator[](std::size_t i) const {
    double value = first_.at(i);
    if (subtracts_) {
      value -= second_.at(i);
    }
    return shifted_ ? value - shift_ : value;
  }
  [[nodiscard]] Iterator begin() const;
  [[nodiscard]] Iterator end() const;

  /// This series less another of the same size, value by value.
  [[nodiscard]] Series minus(const Series& other) const;
  [[nodiscard]] Series minus(double value) const;
  /// The values [from, from + count).
  [[nodiscard]] Series part(std::size_t from, std::size_t count) const;
  /// Every `every`-th value from `phase` on.
  [[nodiscard]] Series thinned(std::size_t every, std::size_t phase) const;
  /// A copy of all values, 8 bytes each.
  [[nodiscard]] std::vector<double> values() const;

 private:
  struct Term {
    std::shared_ptr<const std::vector<double>> own;  ///< keeps `data` alive; null where it is the caller's or null
    const double* data = nullptr;                    ///< null: every value is `value`
    double value = 0.0;
    bool converts = false;  ///< data * factor + offset
    double factor = 1.0, offset = 0.0;

    [[nodiscard]] double at(std::size_t i) const {
      if (data == nullptr) {
        return value;
      }
      return converts ? data[i] * factor + offset : data[i];
    }
  };

  [[nodiscard]] bool is_plain() const { return !subtracts_ && !shifted_; }

  std::size_t count_ = 0;
  Term first_, second_;
  double shift_ = 0.0;
  bool subtracts_ = false;
  bool shifted_ = false;
};

/// Iterates over a series, which must outlive it; dereferencing computes the value.
class Series::Iterator {
 public:
  using value_type = double;
  using difference_type = std::ptrdiff_t;

  Iterator(const Series& series, std::size_t at) : series_(&series), at_(at) {}
  double operator*() const { return (*series_)[at_]; }
  Iterator& operator++() {
    ++at_;
    return *this;
  }
  Iterator operator++(int) {
    const Iterator before = *this;
    ++at_;
    return before;
  }
  friend bool operator==(const Iterator& a, const Iterator& b) { return a.at_ == b.at_; }

 private:
  const Series* series_;
  std::size_t at_;
};

inline Series::Iterator Series::begin() const { return {*this, 0}; }
inline Series::Iterator Series::end() const { return {*this, count_}; }

/// Which places of a grid have a sample. Copies share the flags; if every place has one, no flags are stored.
class Presence {
 public:
  Presence() = default;
  /// A sample at each of `count` places.
  explicit Presence(std::size_t count) : count_(count) {}
  /// A sample where `places` is not 0.
  explicit Presence(std::vector<unsigned char> places);

  [[nodiscard]] std::size_t size() const { return count_; }
  /// 1: a sample; 0: none.
  [[nodiscard]] unsigned char operator[](std::size_t i) const { return places_ == nullptr ? 1 : (*places_)[i]; }
  /// How many places hold none.
  [[nodiscard]] std::size_t absent() const;
  [[nodiscard]] Presence thinned(std::size_t every, std::size_t phase) const;
  [[nodiscard]] std::vector<unsigned char> places() const;

 private:
  std::size_t count_ = 0;
  std::shared_ptr<const std::vector<unsigned char>> places_;
};

}  // namespace driftlab::investigate
