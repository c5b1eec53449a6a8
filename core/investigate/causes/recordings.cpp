#include "core/investigate/causes/recordings.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace driftlab::investigate {

ChannelName name_of(const StudyRecording& recording, const Channel& channel) { return {recording.id, channel.column}; }

std::string list_of_names(const std::vector<std::string>& names) {
  // Names in a sentence. Chosen for who reads it.
  constexpr std::size_t kMost = 6;
  std::string text;
  const std::size_t shown = names.size() > kMost ? kMost - 1 : names.size();
  for (std::size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == names.size();
    text.append(i == 0 ? "" : last ? " and " : ", ").append(names[i]);
  }
  return shown < names.size() ? text.append(" and others") : text;
}

std::string list_of_names(const std::vector<ChannelName>& names) { return list_of_names(texts_of(names)); }

void renew_error(Channel& channel) { channel.error = channel.error.empty() ? Series() : channel.against_reference(); }

void turn_sign(Channel& channel) {
  std::vector<double> turned = channel.measured.values();
  for (double& v : turned) {
    v = -v;
  }
  channel.measured = std::move(turned);
}

std::string in_digits(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 4);
  return error == std::errc{} ? std::string(buffer, end) : std::string("?");
}

void thin_out(StudyRecording& recording, std::size_t every, std::size_t phase, std::deque<std::vector<double>>& rows) {
  const auto thin = [&](auto& values) { values = values.thinned(every, phase); };
  const auto place = [&](std::size_t i) { return i > phase ? (i - phase + every - 1) / every : 0; };
  for (Channel& channel : recording.channels) {
    std::vector<double> kept;
    std::size_t row = 0;
    for (std::size_t i = 0; i < channel.valid.size(); ++i) {
      if (channel.valid[i] == 0) {
        continue;
      }
      if (i >= phase && (i - phase) % every == 0) {
        kept.push_back(channel.rows[row]);
      }
      ++row;
    }
    rows.push_back(std::move(kept));
    channel.rows = rows.back();
    for (Series* const values : {&channel.measured, &channel.error, &channel.reference}) {
      thin(*values);
    }
    thin(channel.valid);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    thin(recording.rate[k]);
    thin(recording.acceleration[k]);
    thin(recording.force[k]);
  }
  thin(recording.temperature);
  thin(recording.angle);
  recording.begin = place(recording.begin);
  recording.end = place(recording.end);
  recording.length = (recording.length - phase + every - 1) / every;
  recording.end = std::min(recording.end, recording.length);
  recording.dt_s *= static_cast<double>(every);
  recording.stamps.missing = 0;
  if (!recording.channels.empty()) {
    recording.stamps.missing = recording.channels.front().valid.absent();
  }
}

void leave_out(StudyRecording& recording, const std::vector<unsigned char>& gone,
               std::deque<std::vector<double>>& rows) {
  for (Channel& channel : recording.channels) {
    std::vector<double> kept;
    std::size_t row = 0;
    std::vector<unsigned char> places = channel.valid.places();
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] == 0) {
        continue;
      }
      if (gone[i] != 0) {
        places[i] = 0;
      } else {
        kept.push_back(channel.rows[row]);
      }
      ++row;
    }
    channel.valid = Presence(std::move(places));
    rows.push_back(std::move(kept));
    channel.rows = rows.back();
  }
}

void set_aside(StudyRecording& recording) {
  for (Channel& channel : recording.channels) {
    channel.input_only = true;
  }
}

std::vector<FaultyRecordings> resampled_recordings(
    const Study& study, const std::function<Thinning(const StudyRecording&)>& look,
    const std::function<FoundParameter(const StudyRecording&, std::size_t every)>& parameter, const std::string& what,
    const std::stop_token& stop) {
  std::vector<Thinning> of(study.recordings.size());
  std::map<std::size_t, std::vector<std::size_t>> by_m;
  for (std::size_t r = 0; r < of.size() && !stop.stop_requested(); ++r) {
    of[r] = look(study.recordings[r]);
    if (of[r].every > 1) {
      by_m[of[r].every].push_back(r);
    }
  }
  std::vector<FaultyRecordings> faults;
  for (const auto& [every, recordings] : by_m) {
    const bool most = 2 * recordings.size() > study.recordings.size();
    FaultyRecordings fault;
    std::vector<std::string> ids;
    for (const std::size_t r : recordings) {
      ids.push_back(study.recordings[r].id);
      for (const Channel& channel : study.recordings[r].channels) {
        if (!channel.input_only && !channel.error.empty()) {
          fault.channels.push_back(name_of(study.recordings[r], channel));
        }
      }
    }
    fault.parameters = {parameter(study.recordings[recordings.front()], every)};
    fault.sentence = list_of_names(ids) + ": " + what + ". ";
    fault.sentence.append(most ? "What follows is of one sample in " + std::to_string(every) + " of them"
                               : "They are set aside");
    fault.sentence.append(most && recordings.size() < study.recordings.size()
                              ? ", and the recordings at the full rate are set aside."
                              : ".");
    fault.mend = [most, of, m = every](Study& mended, std::deque<std::vector<double>>& rows) {
      for (std::size_t r = 0; r < of.size(); ++r) {
        if (of[r].every == m && most) {
          thin_out(mended.recordings[r], m, of[r].phase, rows);
        } else if ((of[r].every == m) != most) {
          set_aside(mended.recordings[r]);
        }
      }
    };
    faults.push_back(std::move(fault));
  }
  return faults;
}

}  // namespace driftlab::investigate
