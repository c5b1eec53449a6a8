#pragma once
/// The little of XML that answers of S3 need: the texts of elements whose names are known. No attributes, no DTD, no
/// entities but the five of XML and numbers.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server::s3 {

/// What stands inside each element of that name, at any depth, as it is written. Elements of one name do not nest.
[[nodiscard]] std::vector<std::string_view> elements(std::string_view document, std::string_view name);

/// The text of the first element of that name, with `&amp;` and its like resolved; nothing where there is none.
[[nodiscard]] std::optional<std::string> element_text(std::string_view document, std::string_view name);

}  // namespace driftlab::server::s3
