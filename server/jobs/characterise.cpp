/// The job kind `characterise`: recordings in, variances, Allan coefficients and ranked fits of each sensor channel
/// out.
///
/// `inputs`: {"recordings": ["rec_..."]}, 1 to 100 of them, or {"study": "stu_..."}. `parameters`: {"models": ["WN",
/// ...], "seed": 1}, both optional.
#include "schema/json/characterise.hpp"

#include "core/analysis/characterise_campaign.hpp"
#include "core/analysis/characterise_channels.hpp"
#include "core/analysis/told_characterisation.hpp"
#include "schema/json/campaign_summary.hpp"
#include "schema/json/characterisation.hpp"
#include "server/jobs/job_parts.hpp"
#include "server/jobs/line_verdicts.hpp"
#include "server/jobs/stored_recordings.hpp"
#include "server/jobs/told_glance.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace driftlab::server {
namespace {

constexpr std::size_t kMostRecordings = 100;

/// Ids of the recordings asked for, without repeats, in the order given.
std::vector<std::string> listed_ids(const Json& list, Faults& faults) {
  std::vector<std::string> ids;
  if (!list.is_array() || list.empty() || list.size() > kMostRecordings) {
    faults.add("/inputs/recordings", ErrorCode::InvalidArgument, "Name 1 to 100 recordings by their ids, or a study.");
    return ids;
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Json& id = list[i];
    if (!id.is_string() || !is_id(id.get<std::string>(), "rec")) {
      faults.add("/inputs/recordings/" + std::to_string(i), ErrorCode::InvalidArgument,
                 "A recording id looks like rec_01H….");
    } else if (std::find(ids.begin(), ids.end(), id.get<std::string>()) == ids.end()) {
      ids.push_back(id.get<std::string>());
    }
  }
  return ids;
}

/// What a job is asked to work on: recordings by id, or a study that names them.
struct Inputs {
  std::vector<std::string> recordings;
  std::string study;  ///< empty: none
};

Result<Inputs> read_inputs(const Json& document, JobContext& context, Faults& faults) {
  Inputs inputs;
  ObjectReader reader(document, "/inputs", faults);
  const Json* const list = reader.member("recordings");
  const auto study = reader.text("study");
  reader.reject_unknown();
  if (list != nullptr && study) {
    faults.add("/inputs/study", ErrorCode::InvalidArgument, "Name either recordings or a study, not both.");
    return inputs;
  }
  if (!study) {
    inputs.recordings = listed_ids(list != nullptr ? *list : Json(), faults);
    return inputs;
  }
  inputs.study = *study;
  auto row = context.store.study(*study);
  if (!row) {
    if (row.error().code != ErrorCode::NotFound) {
      return fail(row.error());
    }
    faults.add("/inputs/study", ErrorCode::NotFound, "There is no study " + *study + ".");
    return inputs;
  }
  auto stored = parse_json(row->document_json);
  if (!stored) {
    return fail(stored.error());
  }
  for (const Json& entry : (*stored)["recordings"]) {
    inputs.recordings.push_back(entry["recording"].get<std::string>());
  }
  return inputs;
}

/// All channels of the recordings, wherever each is characterised.
Result<std::vector<CharacterisedRecording>> characterise_in_parts(StoredRecordings& recordings,
                                                                  const CharacteriseOptions& options,
                                                                  const RunControl& control, JobParts& parts) {
  std::vector<std::size_t> expected;
  for (std::size_t i = 0; i < recordings.count(); ++i) {
    const auto channels = recordings.expected_channels(i);
    if (!channels) {
      return fail(recordings.located(i, channels.error()));
    }
    expected.push_back(*channels);
  }
  CampaignChannels channels(recordings, options, expected);
  const auto compute = [&](std::size_t number, const RunControl& part) { return channels.characterise(number, part); };
  const auto take = [&](CharacterisedRecording one) -> Result<bool> {
    channels.add(std::move(one));
    return true;
  };
  if (auto shared = share_values<CharacterisedRecording>(parts, channels.count(), compute, take, control); !shared) {
    return fail(shared.error());
  }
  return std::move(channels.found());
}

using ResultIds = std::map<std::pair<std::string, std::string>, std::string>;  ///< by recording and column

/// The compiler's view of the machine: results name it, because other instruction sets may round differently.
std::string_view instruction_set() {
#if defined(__x86_64__)
  return "x86-64";
#elif defined(__aarch64__)
  return "aarch64";
#else
  return "other";
#endif
}

class Characterise final : public DividedKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "characterise"; }
  [[nodiscard]] int version() const override { return kAlgorithmVersion; }

  [[nodiscard]] Result<Json> canonical_request(const Json& inputs, const Json& parameters,
                                               JobContext& context) const override {
    Faults faults;
    auto wanted = read_inputs(inputs, context, faults);
    if (!wanted) {
      return fail(wanted.error());
    }
    const CharacteriseOptions options = characterise_options_from_json(parameters, "/parameters", faults);
    Json pinned = Json::array();
    for (const std::string& id : wanted->recordings) {
      auto recording = context.store.recording(id);
      if (!recording) {
        if (recording.error().code != ErrorCode::NotFound) {
          return fail(recording.error());
        }
        faults.add("/inputs/recordings", ErrorCode::NotFound, "There is no recording " + id + ".");
        continue;
      }
      pinned.push_back(Json{{"id", id}, {"revision", recording->revision}});
    }
    if (!faults.none()) {
      return fail(faults.error());
    }
    Json named{{"recordings", std::move(pinned)}};
    if (!wanted->study.empty()) {
      named["study"] = wanted->study;
    }
    return Json{{"kind", name()}, {"inputs", std::move(named)}, {"parameters", to_json(options)}};
  }

  /// A few arrays of one channel's length at a time.
  [[nodiscard]] JobCost cost(const Json& request, JobContext& context) const override {
    constexpr std::int64_t kBytesPerSample = 40;
    constexpr double kSecondsPerSample = 1e-6;
    JobCost cost;
    for (const RecordingSize& size : sizes_of(request["inputs"]["recordings"], context.store)) {
      cost.memory_bytes = std::max(cost.memory_bytes, JobCost{}.memory_bytes + kBytesPerSample * size.rows);
      cost.seconds += kSecondsPerSample * static_cast<double>(size.rows * size.columns);
    }
    return cost;
  }

  [[nodiscard]] Result<JobResults> run_in_parts(const Json& request, JobContext& context, const RunControl& control,
                                                JobParts& parts) const override {
    Faults faults;
    const CharacteriseOptions options = characterise_options_from_json(request["parameters"], "/parameters", faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
    std::vector<StoredRecordingRequest> wanted = recordings_from_request(request["inputs"]["recordings"]);
    for (StoredRecordingRequest& one : wanted) {
      one.name = one.id;
    }
    StoredRecordings recordings(context.store, context.blobs, std::move(wanted), context.verify_columns);
    auto characterised = characterise_in_parts(recordings, options, part_of(control, 0.0, kRecordingsShare), parts);
    if (!characterised) {
      return fail(characterised.error());
    }
    ResultIds ids;
    const auto named = [&](const std::string& recording, const std::string& column) {
      return ids.try_emplace({recording, column}, make_id("chr", context.clock.now())).first->second;
    };
    const auto found =
        summarise_characterised(std::move(*characterised), part_of(control, kRecordingsShare, 1.0), named);
    if (!found) {
      return fail(found.error());
    }
    JobResults results;
    std::vector<Json> documents;
    for (std::size_t i = 0; i < found->recordings.size(); ++i) {
      documents.push_back(to_json(found->recordings[i]));
      collect(recordings.row(i), found->recordings[i], documents.back(), options, context, named, results);
    }
    Json document = characterisation_document(std::move(documents));
    document["study"] = request["inputs"].value("study", Json());
    add_summary(document, found->together);
    results.document_json = to_text(document);
    if (auto compared = add_line_verdicts(context.store, results); !compared) {
      return fail(compared.error());
    }
    return results;
  }

 private:
  /// The channel of the recording whose verdict a person should read first.
  static void note(const Recording& recording, const CharacterisedRecording& characterised, JobResults& results) {
    if (characterised.channels.empty()) {
      return;
    }
    const GravestChannel gravest = gravest_channel(characterised);
    results.verdicts.push_back({.device_id = recording.device_id,
                                .recording_id = recording.id,
                                .channel = gravest.channel,
                                .level = std::string(driftlab::name_of(gravest.verdict.level)),
                                .verdict = gravest.verdict.sentence});
  }

  /// Rows for the store: one per channel and one per fit. `document`: that of `characterised`, whose parts are stored.
  static void collect(const Recording& recording, const CharacterisedRecording& characterised, const Json& document,
                      const CharacteriseOptions& options, JobContext& context, const ResultName& named,
                      JobResults& results) {
    Json settings = to_json(options);
    settings["algorithm_version"] = kAlgorithmVersion;
    settings["instruction_set"] = instruction_set();
    settings["driftlab_version"] = DRIFTLAB_VERSION;
    const UtcMicros now = context.clock.now();
    note(recording, characterised, results);
    for (std::size_t c = 0; c < characterised.channels.size(); ++c) {
      const CharacterisedChannel& channel = characterised.channels[c];
      const Json& told = document["channels"][c];
      ChannelResult row;
      row.device_id = recording.device_id;
      row.recording_id = recording.id;
      row.recording_revision = recording.revision;
      row.channel = channel.column;
      row.id = named(row.recording_id, row.channel);
      row.quantity = driftlab::name_of(channel.role.quantity);
      row.axis = channel.role.axis;
      row.condition = recording.condition;
      row.document_json = to_text(told);
      row.settings_json = to_text(settings);
      row.created_at = now;
      row.glance = told_glance(told).value_or(Glance{});
      for (std::size_t rank = 0; rank < channel.result.fits.size(); ++rank) {
        Fit fit;
        fit.id = make_id("fit", now);
        fit.channel_result_id = row.id;
        fit.device_id = row.device_id;
        fit.recording_id = row.recording_id;
        fit.recording_revision = row.recording_revision;
        fit.channel = row.channel;
        fit.quantity = row.quantity;
        fit.axis = row.axis;
        fit.condition = row.condition;
        fit.model = channel.result.fits[rank].model;
        fit.rank = static_cast<int>(rank);
        Json document_of_fit = told["fits"][rank];
        document_of_fit["density"] = told["allan_parameters"]["N"];
        fit.document_json = to_text(document_of_fit);
        fit.created_at = now;
        results.fits.push_back(std::move(fit));
      }
      results.channels.push_back(std::move(row));
    }
  }
};

}  // namespace

std::unique_ptr<JobKind> make_characterise_kind() { return std::make_unique<Characterise>(); }

}  // namespace driftlab::server
