#include "server/api/live_events.hpp"

#include "schema/json/growing_recording.hpp"
#include "schema/json/json.hpp"

#include <algorithm>
#include <chrono>

namespace driftlab::server {
namespace {

class LiveEvents final : public EventSource {
 public:
  LiveEvents(const LiveRecordings& recordings, std::string id, LiveAbout about, std::string channel)
      : recordings_(recordings), id_(std::move(id)), about_(std::move(about)), channel_(std::move(channel)) {}

  [[nodiscard]] const std::string& subject() const override { return id_; }

  [[nodiscard]] Result<Batch> next() override {
    const auto now = std::chrono::steady_clock::now();
    const auto recording = recordings_.find(id_);
    if (!recording) {
      return Batch{"event: finished\ndata: {}\n\n", true};
    }
    if (now < due_ || recording->samples == told_) {
      return Batch{};
    }
    const auto samples = recordings_.samples(id_);
    if (!samples) {
      return Batch{};
    }
    const auto column = static_cast<std::size_t>(std::find(about_.columns.begin(), about_.columns.end(), channel_) -
                                                 about_.columns.begin());
    const GrowingRecording look = look_at_growth(samples->time_s, samples->columns[column]);
    Json data = growing_recording_to_json(look, unit_of(about_, channel_));
    data["channel"] = channel_;
    data["still"] = still(*samples);
    told_ = recording->samples;
    const auto took = std::chrono::steady_clock::now() - now;
    due_ = now + std::max<std::chrono::steady_clock::duration>(std::chrono::seconds(2), 20 * took);
    return Batch{"id: " + std::to_string(told_) + "\nevent: growth\ndata: " + to_text(data) + "\n\n", false};
  }

 private:
  /// False as soon as one sensor moves; null where none can tell.
  [[nodiscard]] Json still(const LiveSamples& samples) const {
    Json answer = nullptr;
    for (std::size_t c = 0; c < about_.columns.size(); ++c) {
      const auto rests = lies_still(samples.time_s, samples.columns[c], unit_of(about_, about_.columns[c]));
      if (rests && (answer.is_null() || !*rests)) {
        answer = *rests;
      }
    }
    return answer;
  }

  const LiveRecordings& recordings_;
  std::string id_;
  LiveAbout about_;
  std::string channel_;
  std::size_t told_ = 0;
  std::chrono::steady_clock::time_point due_{};
};

}  // namespace

std::unique_ptr<EventSource> growth_events(const LiveRecordings& recordings, std::string id, LiveAbout about,
                                           std::string channel) {
  return std::make_unique<LiveEvents>(recordings, std::move(id), std::move(about), std::move(channel));
}

}  // namespace driftlab::server
