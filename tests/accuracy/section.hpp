#pragma once
/// One section of tests/ACCURACY.md: printed, and written to $DRIFTLAB_ACCURACY_DIR/<name>.md where that is set.
/// $DRIFTLAB_ACCURACY_SHARE (default 1) scales the repetitions, to look before a long run.
#include "core/process/model.hpp"

#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace driftlab::accuracy {

// NOLINTBEGIN(concurrency-mt-unsafe): tests read their environment before they start anything
inline std::size_t repetitions(std::size_t full) {
  const char* const text = std::getenv("DRIFTLAB_ACCURACY_SHARE");
  const double share = text != nullptr ? std::strtod(text, nullptr) : 1.0;
  const auto scaled = static_cast<std::size_t>(static_cast<double>(full) * share);
  return scaled < 10 ? 10 : scaled;
}

class Section {
 public:
  explicit Section(const std::string& name) {
    if (const char* const folder = std::getenv("DRIFTLAB_ACCURACY_DIR"); folder != nullptr) {
      file_ = std::fopen((std::string(folder) + "/" + name + ".md").c_str(), "w");
    }
  }
  // NOLINTEND(concurrency-mt-unsafe)
  Section(const Section&) = delete;
  Section& operator=(const Section&) = delete;
  ~Section() {
    if (file_ != nullptr) {
      (void)std::fclose(file_);
    }
  }

  [[gnu::format(printf, 2, 3)]] void print(const char* format, ...) {
    for (std::FILE* const out : {stdout, file_}) {
      if (out != nullptr) {
        std::va_list arguments;
        va_start(arguments, format);
        (void)std::vfprintf(out, format, arguments);
        va_end(arguments);
        (void)std::fflush(out);
      }
    }
  }

 private:
  std::FILE* file_ = nullptr;
};

inline Model model_of(const std::vector<std::pair<const char*, std::vector<double>>>& parts) {
  Model model;
  for (const auto& [name, values] : parts) {
    model.push_back(*make_process(name, values));
  }
  return model;
}

}  // namespace driftlab::accuracy
