#pragma once
/// How driftlab reports failure.
///
/// Three kinds are kept apart. A broken precondition is a bug and asserts. A bad input or a failed resource is a
/// `Result` that holds an `Error`: one closed code, one sentence for a person, and the fields that locate it. A poor
/// numerical outcome (a fit that did not converge, a parameter that cannot be identified) is *data* and travels inside
/// the result type itself. No exception crosses a module boundary.
#include <tl/expected.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab {

/// Closed set of reasons for which an input or a resource can fail. The server maps each to one problem type.
enum class ErrorCode {
  InvalidArgument,       ///< a setting or parameter is outside its range, or contradicts another
  UnknownUnit,           ///< a unit symbol that driftlab does not know
  UnknownQuantity,       ///< a quantity name that is not in the study specification
  UnknownCondition,      ///< a dynamic-condition kind that is not in the study specification
  UnitMismatch,          ///< a unit that does not measure the quantity it is given for (deg/s for specific force)
  UnknownColumn,         ///< metadata name a column that the file does not have
  DuplicateColumn,       ///< two columns of one file share a name, or two columns claim one channel
  EmptyInput,            ///< no bytes at all
  NoSamples,             ///< a header and nothing under it
  TooFewSamples,         ///< fewer samples than the analysis needs
  RaggedRow,             ///< a row with more or fewer fields than the header
  NotANumber,            ///< text where a number belongs
  NonFinite,             ///< NaN or an infinity in a column
  OutOfRange,            ///< a number that a double cannot hold
  NonMonotonicTime,      ///< a time column that steps backwards
  InconsistentSampling,  ///< stated rate and time column contradict each other, or neither is there
  Truncated,             ///< the data end before the header says they do
  ShapeMismatch,         ///< a header whose shape disagrees with the bytes that follow
  UnsupportedFormat,     ///< bytes that are no recording format driftlab reads
  UnsupportedType,       ///< a known format holding an element type or layout that driftlab does not read
  CorruptCompression,    ///< a compressed stream that does not decompress
  DecompressionLimit,    ///< a compressed stream that expands beyond its budget
  LimitExceeded,         ///< a stated limit (line length, columns, samples) is exceeded
  ParseError,            ///< a document (JSON, query string, option) that does not parse
  Io,                    ///< the operating system refused to read or write
  DiskFull,              ///< no space left where data are kept
  NotFound,              ///< a named object does not exist
  Conflict,              ///< the object exists with other content
  Cancelled,             ///< the caller asked to stop
  Internal,              ///< an invariant did not hold; please report
};

/// The code as it appears in documents: snake_case of the enumerator.
[[nodiscard]] std::string_view name_of(ErrorCode code);

/// Every code once, in declaration order; tests and documentation walk it.
[[nodiscard]] const std::vector<ErrorCode>& all_error_codes();

/// One located detail of an error, for example {"row", "17"} or {"column", "gz"} or {"parameter", "rate_hz"}.
struct ErrorField {
  std::string name;
  std::string value;
  friend bool operator==(const ErrorField&, const ErrorField&) = default;
};

/// Why something failed. `message` is one plain sentence that a lab engineer understands.
struct Error {
  ErrorCode code = ErrorCode::Internal;
  std::string message;
  std::vector<ErrorField> fields = {};

  /// The same error with one more located detail.
  [[nodiscard]] Error with(std::string name, std::string value) && {
    fields.push_back({std::move(name), std::move(value)});
    return std::move(*this);
  }
};

template <class T>
using Result = tl::expected<T, Error>;

using Status = Result<void>;

/// Shorthand for returning a failure from a function that returns a `Result`.
[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string message,
                                                std::vector<ErrorField> fields = {}) {
  return tl::unexpected<Error>(Error{code, std::move(message), std::move(fields)});
}

[[nodiscard]] inline tl::unexpected<Error> fail(Error error) { return tl::unexpected<Error>(std::move(error)); }

}  // namespace driftlab
