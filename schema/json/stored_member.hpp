#pragma once
/// Reads members of documents that any release of driftlab wrote, in which a null or missing member has a meaning.
#include "schema/json/json.hpp"

#include <cstddef>
#include <string>

namespace driftlab {

/// The member as a finite number, else `otherwise`: null stands for a value that is not finite or not known.
[[nodiscard]] double finite_member(const Json& object, const char* name, double otherwise);

/// The member as a count; 0 where it is null, absent or none.
[[nodiscard]] std::size_t count_member(const Json& object, const char* name);

/// The member as text; empty where it is null or absent.
[[nodiscard]] std::string text_member(const Json& object, const char* name);

/// null for an empty text.
[[nodiscard]] Json text_or_null(const std::string& text);

}  // namespace driftlab
