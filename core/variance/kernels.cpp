#include "core/variance/kernels.hpp"

#include <cstring>

// NOLINTBEGIN(cppcoreguidelines-init-variables): vector types
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define DRIFTLAB_HAS_VERSIONS 1
#else
#define DRIFTLAB_HAS_VERSIONS 0
#endif

namespace driftlab {
namespace {

namespace portable {
constexpr std::size_t kWidth = 2;
#include "core/variance/kernels_body.inc"
}  // namespace portable

#if DRIFTLAB_HAS_VERSIONS
#pragma GCC push_options
#pragma GCC target("avx2")
namespace avx2 {
constexpr std::size_t kWidth = 4;
#include "core/variance/kernels_body.inc"
}  // namespace avx2
#pragma GCC pop_options
#endif
// NOLINTEND(cppcoreguidelines-init-variables)

const Kernels& choose() {
#if DRIFTLAB_HAS_VERSIONS
  if (__builtin_cpu_supports("avx2")) {
    return avx2::kKernels;
  }
#endif
  return portable::kKernels;
}

}  // namespace

const Kernels& kernels() {
  static const Kernels& chosen = choose();
  return chosen;
}

const Kernels& portable_kernels() { return portable::kKernels; }

}  // namespace driftlab
