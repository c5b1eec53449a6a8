#pragma once
/// A value as bytes and back, to the last bit: how a result goes from one process to another of the same program.
///
/// The bytes are the value's members in order: numbers as the machine holds them, lengths before what they count, a
/// kind of process by its name. Members are found by Boost.PFR: what is a plain aggregate of such values needs no code
/// of its own here. The shape of a type says how it is made of numbers, so that bytes of another program's type can be
/// told from one's own.
#include "core/fit/characterisation.hpp"

#include <boost/pfr.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace driftlab {

/// Collects bytes.
class SnapshotWriter {
 public:
  template <class T>
  void put(const T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
      bytes_.append(raw.begin(), raw.end());
    } else {
      boost::pfr::for_each_field(value, [this](const auto& member) { this->put(member); });
    }
  }
  void put(const std::string& text) {
    put(text.size());
    bytes_.append(text);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put(values.size());
    for (const auto& value : values) {
      put(value);
    }
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) {
      put(*value);
    }
  }
  template <class Key, class T>
  void put(const std::map<Key, T>& values) {
    put(values.size());
    for (const auto& [key, value] : values) {
      put(key);
      put(value);
    }
  }
  void put(const FittedProcess& process);

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads them again. Where they are too few or make no sense, `sound` turns false and values are left as they are.
class SnapshotReader {
 public:
  explicit SnapshotReader(std::string_view bytes) : left_(bytes) {}

  template <class T>
  void get(T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      const std::string_view taken = take(sizeof(T));
      std::array<char, sizeof(T)> raw{};
      std::copy(taken.begin(), taken.end(), raw.begin());
      if constexpr (std::is_same_v<T, bool>) {
        value = raw[0] != 0;
      } else if (!taken.empty()) {
        value = std::bit_cast<T>(raw);
      }
    } else {
      boost::pfr::for_each_field(value, [this](auto& member) { this->get(member); });
    }
  }
  void get(std::string& text) { text = std::string(take(length())); }
  template <class T>
  void get(std::vector<T>& values) {
    values.resize(length());
    for (T& value : values) {
      get(value);
    }
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool there = false;
    get(there);
    value.reset();
    if (there) {
      get(value.emplace());
    }
  }
  template <class Key, class T>
  void get(std::map<Key, T>& values) {
    values.clear();
    for (std::size_t i = length(); i > 0 && sound_; --i) {
      Key key;
      get(key);
      get(values[key]);
    }
  }
  void get(FittedProcess& process);

  /// Whether everything was there, and nothing is left.
  [[nodiscard]] bool complete() const { return sound_ && left_.empty(); }

 private:
  /// A number of members, each of which takes a byte at least: never more than there are bytes.
  [[nodiscard]] std::size_t length();
  [[nodiscard]] std::string_view take(std::size_t count);

  std::string_view left_;
  bool sound_ = true;
};

/// How a value of a type is made of numbers: texts of types with unlike members are unlike.
class SnapshotShape {
 public:
  template <class T>
  [[nodiscard]] static std::string of() {
    SnapshotShape shape;
    shape.add(T{});
    return shape.text_;
  }

 private:
  template <class T>
  void add(const T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      text_.append(std::is_floating_point_v<T> ? "f" : "i").append(std::to_string(sizeof(T)));
    } else {
      text_.append("{");
      boost::pfr::for_each_field(value, [this](const auto& member) { this->add(member); });
      text_.append("}");
    }
  }
  void add(const std::string& /*text*/) { text_.append("s"); }
  template <class T>
  void add(const std::vector<T>& /*values*/) {
    text_.append("[");
    add(T{});
    text_.append("]");
  }
  template <class T>
  void add(const std::optional<T>& /*value*/) {
    text_.append("?");
    add(T{});
  }
  template <class Key, class T>
  void add(const std::map<Key, T>& /*values*/) {
    text_.append("m");
    add(Key{});
    add(T{});
  }
  void add(const FittedProcess& /*process*/) { text_.append("P"); }

  std::string text_;
};

}  // namespace driftlab
