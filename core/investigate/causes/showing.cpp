#include "core/investigate/causes/showing.hpp"

#include <cmath>

namespace driftlab::investigate {

double Stage::white_sd() const { return density / std::sqrt(dt_s()); }

}  // namespace driftlab::investigate
