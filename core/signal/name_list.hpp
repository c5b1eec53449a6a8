#pragma once
/// A list of names in a sentence, however many there are.
#include <cstddef>
#include <string>

namespace driftlab {

/// "a, b and 12 more": the first `most` names as they were added, and how many follow.
class NameList {
 public:
  explicit NameList(std::size_t most) : most_(most) {}

  void add(const std::string& name) {
    if (count_++ < most_) {
      text_.append(text_.empty() ? "" : ", ").append(name);
    }
  }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] std::string text() const {
    return count_ <= most_ ? text_ : text_ + " and " + std::to_string(count_ - most_) + " more";
  }

 private:
  std::size_t most_;
  std::string text_;
  std::size_t count_ = 0;
};

}  // namespace driftlab
