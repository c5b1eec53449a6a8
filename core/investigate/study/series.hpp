#pragma once
/// Numbers over a grid, or over a part of one, in as little memory as they need.
///
/// A recording of a day holds millions of samples of every channel, and most of what is said of them follows from the
/// file by one operation a sample: SI instead of the file's unit, less the reference, less the bias. A `Series` keeps
/// what it follows from and works a number out when it is asked for:
///   value(i) = (first(i) - second(i)) - shift,
/// where `first` and `second` are each a column of the file in SI, one number throughout, or numbers of their own. The
/// results are those of the same operations done beforehand, to the bit. Copies share what they hold.
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
  /// Numbers of its own.
  // NOLINTNEXTLINE(google-explicit-constructor): a vector is a series, and stands where one is asked for
  Series(std::vector<double> values);
  [[nodiscard]] static Series constant(double value, std::size_t count);
  /// A column of a file in SI; `rows` are the caller's memory and stay it.
  [[nodiscard]] static Series column(std::span<const double> rows, const Unit& unit);
  /// Numbers as they are, in the caller's memory.
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

  /// Place by place less another of the same size.
  [[nodiscard]] Series minus(const Series& other) const;
  [[nodiscard]] Series minus(double value) const;
  /// The places [from, from + count).
  [[nodiscard]] Series part(std::size_t from, std::size_t count) const;
  /// Every `every`-th place from `phase` on.
  [[nodiscard]] Series thinned(std::size_t every, std::size_t phase) const;
  /// All of them at once, 8 bytes each.
  [[nodiscard]] std::vector<double> values() const;

 private:
  struct Term {
    std::shared_ptr<const std::vector<double>> own;  ///< keeps `data` alive; null: the caller's memory, or none
    const double* data = nullptr;                    ///< null: `value` throughout
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

/// Walks over a series, which must outlive it; numbers come by value.
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

/// Which places of a grid hold a sample. Copies share what they hold; where every place does, there is nothing to hold.
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
