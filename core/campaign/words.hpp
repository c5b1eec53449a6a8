#pragma once
/// Small words of the sentences that results say.
#include <cstddef>
#include <string>
#include <vector>

namespace driftlab {

/// "no", "one" ... "twelve", then digits.
[[nodiscard]] std::string counted(std::size_t n);

/// With a capital letter in front.
[[nodiscard]] std::string capital(std::string text);

/// "a, b and c".
[[nodiscard]] std::string joined(const std::vector<std::string>& parts);

}  // namespace driftlab
