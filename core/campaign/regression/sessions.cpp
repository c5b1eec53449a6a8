#include "core/campaign/regression/sessions.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

namespace driftlab::regression {
namespace {

constexpr double kSamePowerUp = 600.0;

/// A time as people read it.
struct Moment {
  std::string day;    ///< `22 Nov`
  std::string clock;  ///< `10:00`
};

Moment moment_of(double seconds) {
  static constexpr std::array<const char*, 12> kMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                          "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const auto minutes = std::chrono::sys_time<std::chrono::minutes>(
      std::chrono::minutes(static_cast<std::int64_t>(std::floor(seconds / 60.0))));
  const auto days = std::chrono::floor<std::chrono::days>(minutes);
  const std::chrono::year_month_day date(days);
  const std::chrono::hh_mm_ss<std::chrono::minutes> of_day(minutes - days);
  const auto two = [](auto number) { return (number < 10 ? "0" : "") + std::to_string(number); };
  return {std::to_string(static_cast<unsigned>(date.day())) + " " + kMonths[static_cast<unsigned>(date.month()) - 1],
          two(of_day.hours().count()) + ":" + two(of_day.minutes().count())};
}

struct Timed {
  double began_s = 0.0;
  const ComparedRecording* recording = nullptr;
};

/// `22 Nov, 10:00-10:50`, `22 Nov, 23:50 to 23 Nov, 00:20`, in UTC: from the first sample to the last one.
std::string span_of(const PowerUp& session) {
  double first_s = std::numeric_limits<double>::infinity();
  double last_s = -first_s;
  for (const ComparedRecording* recording : session.recordings) {
    const double began_s = recording->began_s.value_or(0.0);
    first_s = std::min(first_s, began_s);
    last_s = std::max(last_s, began_s + recording->duration_s);
  }
  const Moment first = moment_of(first_s);
  const Moment last = moment_of(last_s);
  return first.day == last.day ? first.day + ", " + first.clock + "-" + last.clock
                               : first.day + ", " + first.clock + " to " + last.day + ", " + last.clock;
}

/// Recordings without a session but with a time, cut where more than ten minutes lie between two of them.
void group_by_time(std::vector<Timed> timed, PowerUps& found) {
  std::sort(timed.begin(), timed.end(), [](const Timed& a, const Timed& b) {
    return std::pair(a.began_s, a.recording->id) < std::pair(b.began_s, b.recording->id);
  });
  double end_s = 0.0;
  std::vector<PowerUp> sessions;
  for (const auto& [began_s, recording] : timed) {
    if (sessions.empty() || began_s > end_s + kSamePowerUp) {
      sessions.push_back({recording->id, {}});
      end_s = began_s;
    }
    sessions.back().recordings.push_back(recording);
    end_s = std::max(end_s, began_s + recording->duration_s);
  }
  for (PowerUp& session : sessions) {
    if (const std::size_t count = session.recordings.size(); count > 1) {
      found.notes.push_back(std::to_string(count) + " recordings are one session (" + span_of(session) +
                            ") and count once.");
    }
    found.sessions.push_back(std::move(session));
  }
}

}  // namespace

PowerUps group_sessions(const Recordings& arm) {
  PowerUps found;
  std::map<std::string, PowerUp> stated;
  std::vector<Timed> timed;
  std::size_t untold = 0;
  for (const ComparedRecording& recording : arm.recordings) {
    if (!recording.session.empty()) {
      stated[recording.session].name = recording.session;
      stated[recording.session].recordings.push_back(&recording);
    } else if (recording.began_s) {
      timed.push_back({*recording.began_s, &recording});
    } else {
      ++untold;
      found.sessions.push_back({recording.id, {&recording}});
    }
  }
  for (auto& [name, session] : stated) {
    found.sessions.push_back(std::move(session));
  }
  group_by_time(std::move(timed), found);
  if (untold > 1) {
    found.notes.push_back("Neither session nor time is stated for " + std::to_string(untold) +
                          " recordings of an arm: each counts as a session, which parts of one power-up are not.");
  }
  const auto by_id = [](const ComparedRecording* a, const ComparedRecording* b) { return a->id < b->id; };
  for (PowerUp& session : found.sessions) {
    std::sort(session.recordings.begin(), session.recordings.end(), by_id);
  }
  std::sort(found.sessions.begin(), found.sessions.end(),
            [](const PowerUp& a, const PowerUp& b) { return a.name < b.name; });
  return found;
}

}  // namespace driftlab::regression
