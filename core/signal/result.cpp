#include "core/signal/result.hpp"

namespace driftlab {

std::string_view name_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::InvalidArgument:
      return "invalid_argument";
    case ErrorCode::UnknownUnit:
      return "unknown_unit";
    case ErrorCode::UnknownQuantity:
      return "unknown_quantity";
    case ErrorCode::UnknownCondition:
      return "unknown_condition";
    case ErrorCode::UnitMismatch:
      return "unit_mismatch";
    case ErrorCode::UnknownColumn:
      return "unknown_column";
    case ErrorCode::DuplicateColumn:
      return "duplicate_column";
    case ErrorCode::EmptyInput:
      return "empty_input";
    case ErrorCode::NoSamples:
      return "no_samples";
    case ErrorCode::TooFewSamples:
      return "too_few_samples";
    case ErrorCode::RaggedRow:
      return "ragged_row";
    case ErrorCode::NotANumber:
      return "not_a_number";
    case ErrorCode::NonFinite:
      return "non_finite";
    case ErrorCode::OutOfRange:
      return "out_of_range";
    case ErrorCode::NonMonotonicTime:
      return "non_monotonic_time";
    case ErrorCode::InconsistentSampling:
      return "inconsistent_sampling";
    case ErrorCode::Truncated:
      return "truncated";
    case ErrorCode::ShapeMismatch:
      return "shape_mismatch";
    case ErrorCode::UnsupportedFormat:
      return "unsupported_format";
    case ErrorCode::UnsupportedType:
      return "unsupported_type";
    case ErrorCode::CorruptCompression:
      return "corrupt_compression";
    case ErrorCode::DecompressionLimit:
      return "decompression_limit";
    case ErrorCode::LimitExceeded:
      return "limit_exceeded";
    case ErrorCode::ParseError:
      return "parse_error";
    case ErrorCode::Io:
      return "io";
    case ErrorCode::DiskFull:
      return "disk_full";
    case ErrorCode::NotFound:
      return "not_found";
    case ErrorCode::Conflict:
      return "conflict";
    case ErrorCode::Cancelled:
      return "cancelled";
    case ErrorCode::Internal:
      return "internal";
  }
  return "internal";
}

const std::vector<ErrorCode>& all_error_codes() {
  static const std::vector<ErrorCode> codes = [] {
    std::vector<ErrorCode> all;
    for (int i = 0; i <= static_cast<int>(ErrorCode::Internal); ++i) {
      all.push_back(static_cast<ErrorCode>(i));
    }
    return all;
  }();
  return codes;
}

}  // namespace driftlab
