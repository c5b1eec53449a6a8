#include "core/campaign/regression/sessions.hpp"

#include <algorithm>
#include <map>

namespace driftlab::regression {
namespace {

constexpr double kSamePowerUp = 600.0;

struct Timed {
  double began_s = 0.0;
  const ComparedRecording* recording = nullptr;
};

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
      found.notes.push_back(std::to_string(count) + " recordings are one session (" + session.recordings.front()->id +
                            " to " + session.recordings.back()->id + ", less than 10 min apart) and count once.");
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
