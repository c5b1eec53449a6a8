#pragma once
/// What a result refused, in one line that a test can compare.
#include "core/signal/result.hpp"

#include <string>

namespace driftlab {

/// `unit_mismatch column=ax unit=deg/s`: code and fields of the error, or `accepted`.
template <class T>
std::string failure(const Result<T>& result) {
  if (result) {
    return "accepted";
  }
  std::string text(name_of(result.error().code));
  for (const ErrorField& field : result.error().fields) {
    text += " " + field.name + "=" + field.value;
  }
  return text;
}

}  // namespace driftlab
