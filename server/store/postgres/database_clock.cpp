#include "server/store/postgres/database_clock.hpp"

#include <cmath>

namespace driftlab::server {

double DatabaseClock::doubt_us(const Reading& reading, Steady moment) {
  constexpr double kParting = 50e-6;
  const double age_us = std::chrono::duration<double, std::micro>(moment - reading.moment).count();
  return reading.within_us + kParting * std::fabs(age_us);
}

UtcMicros DatabaseClock::told_by(const Reading& reading, Steady moment) {
  return reading.time + std::chrono::duration_cast<std::chrono::microseconds>(moment - reading.moment).count();
}

UtcMicros DatabaseClock::at(Steady moment) const {
  const std::scoped_lock lock(mutex_);
  return best_ ? told_by(*best_, moment) : SystemClock().now();
}

void DatabaseClock::note(Steady asked, UtcMicros time, Steady answered) {
  const Steady middle = asked + (answered - asked) / 2;
  const Reading fresh{middle, time, std::chrono::duration<double, std::micro>(answered - asked).count() / 2.0};
  const std::scoped_lock lock(mutex_);
  if (best_) {
    const double doubt = doubt_us(*best_, middle);
    const double apart = std::fabs(static_cast<double>(time - told_by(*best_, middle)));
    if (fresh.within_us > doubt && apart <= fresh.within_us + doubt) {
      return;
    }
  }
  best_ = fresh;
}

}  // namespace driftlab::server
