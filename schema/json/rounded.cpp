#include "schema/json/rounded.hpp"

#include <cmath>

namespace driftlab {

Json rounded(double value, int decimals) {
  double scale = 1.0;
  for (int i = 0; i < decimals; ++i) {
    scale *= 10.0;
  }
  return number(std::round(value * scale) / scale);
}

}  // namespace driftlab
