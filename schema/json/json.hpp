#pragma once
/// JSON at the doors of driftlab: strict reading, honest writing.
///
/// Reading refuses what parsers disagree about: nesting deeper than 64, duplicate members, text that is not UTF-8,
/// anything after the document; and an object of more than 10,000 members, which no document of driftlab has. It takes
/// time in proportion to the text. Writing never emits NaN or infinity: `number` turns them into null, and the document
/// says why beside it. Members keep the order in which they were written.
#include "core/signal/estimate.hpp"
#include "core/signal/result.hpp"

#include <nlohmann/json.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Compiled once, in json.cpp.
extern template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace driftlab {

using Json = nlohmann::ordered_json;

inline constexpr int kMaxJsonDepth = 64;
inline constexpr std::size_t kMaxJsonMembers = 10'000;  ///< of one object
inline constexpr std::size_t kMaxReportedFaults = 100;  ///< of one document; the rest is counted

/// The document in `text`. Errors: ParseError, with field "byte" where the parser knows it.
[[nodiscard]] Result<Json> parse_json(std::string_view text);

/// The document with members sorted by name and no white space: equal documents give equal text, whatever the order
/// in which their members were written.
[[nodiscard]] std::string canonical_text(const Json& document);

/// Compact text of a document that may hold anything; invalid UTF-8 is replaced, never thrown.
[[nodiscard]] std::string to_text(const Json& document);

/// A finite number, or null.
[[nodiscard]] Json number(double value);

/// An SI value in units of `unit` (SI), with the fewest digits that are read, times `unit`, as that value: who wrote
/// 44.03 deg/sqrt(h) gets 44.03 back. Where no number is read as the value to the last bit it is the next that is, so
/// that a document that is read and written again says the same for ever. Null where it is not finite.
[[nodiscard]] Json number_in(double si, double unit);

/// A list of numbers times `factor`, each as `number` gives it.
[[nodiscard]] Json numbers(std::span<const double> values, double factor = 1.0);

/// {"value", "unit", "ci95"} with everything multiplied by `per_si`; an open end of the interval is null.
[[nodiscard]] Json quantity(const Estimate& estimate, double per_si, std::string_view unit);

/// [low, high] times `factor`; an open end is null.
[[nodiscard]] Json interval(const Interval& interval, double factor = 1.0);

/// A whole number of a document brought between `least` and `most`: what lies outside is a fault that is told
/// elsewhere, and its value must only fit its type until then.
[[nodiscard]] std::int64_t within(std::int64_t value, std::int64_t least, std::int64_t most);

/// One fault of a document, located by JSON pointer (RFC 6901).
struct Fault {
  std::string pointer;
  ErrorCode code = ErrorCode::InvalidArgument;
  std::string detail;
};

/// Collects every fault of a document instead of stopping at the first.
class Faults {
 public:
  void add(std::string pointer, ErrorCode code, std::string detail);
  void add(std::string pointer, const Error& error) { add(std::move(pointer), error.code, error.message); }
  [[nodiscard]] bool none() const { return faults_.empty(); }
  /// One error for all: the code of the first fault, a sentence, and a field named by pointer for each.
  [[nodiscard]] Error error() const;

 private:
  std::vector<Fault> faults_;
  std::size_t left_out_ = 0;  ///< beyond kMaxReportedFaults
};

/// Reads one JSON object member by member and reports members that are missing, mistyped or unknown.
class ObjectReader {
 public:
  /// `object` must outlive the reader. Not an object: a fault, and every read gives nothing.
  ObjectReader(const Json& object, std::string pointer, Faults& faults);

  /// A member, or nullptr. Marks it as known.
  [[nodiscard]] const Json* member(std::string_view name);
  /// Typed optional members: absent gives nothing; present with another type is a fault.
  [[nodiscard]] std::optional<std::string> text(std::string_view name);
  [[nodiscard]] std::optional<double> real(std::string_view name);
  [[nodiscard]] std::optional<std::int64_t> integer(std::string_view name);
  /// The same, where absence is a fault too.
  [[nodiscard]] std::string required_text(std::string_view name);
  /// The pointer of a member of this object.
  [[nodiscard]] std::string pointer(std::string_view name) const;
  /// Reports as unknown every member that was not asked for before. Call last.
  void reject_unknown();

 private:
  const Json* object_;
  std::string pointer_;
  Faults& faults_;
  std::vector<std::string> known_;
};

}  // namespace driftlab
