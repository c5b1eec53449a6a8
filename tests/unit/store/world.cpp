#include "tests/unit/store/world.hpp"

#include "server/store/digest.hpp"
#include "server/store/sql/sql_store.hpp"

#include <stdlib.h>

#include <algorithm>
#include <system_error>

namespace driftlab::server {
namespace {

/// {"name":"value"}
std::string member(const std::string& name, const std::string& value) {
  std::string text = "{\"";
  return text.append(name).append("\":\"").append(value).append("\"}");
}

}  // namespace

TemporaryDirectory::TemporaryDirectory() {
  std::string name = (std::filesystem::temp_directory_path() / "driftlab-test-XXXXXX").string();
  EXPECT_NE(::mkdtemp(name.data()), nullptr);
  path_ = name;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> files_below(const std::filesystem::path& directory) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
    if (entry.is_regular_file() && entry.path().extension() != ".lock") {
      files.push_back(std::filesystem::relative(entry.path(), directory).string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string hash_of(const std::string& seed) { return sha256_hex(seed); }

Device add_device(Store& store, const std::string& name) {
  Device device;
  device.name = name;
  Result<Store::DeviceOutcome> added = store.ensure_device(device);
  EXPECT_TRUE(added) << added.error().message;
  return added.value().device;
}

Recording add_recording(Store& store, const Device& device, const std::string& seed, const std::string& condition) {
  Blob blob;
  blob.sha256 = hash_of(seed);
  blob.bytes = 1000;
  blob.format = "csv";
  blob.compression = "none";
  blob.rows = 10;
  Recording recording;
  recording.device_id = device.id;
  recording.metadata_json = member("condition", condition);
  recording.condition = condition;
  Result<RecordingOutcome> added = store.add_recording(blob, recording);
  EXPECT_TRUE(added) << added.error().message;
  return added.value().recording;
}

Caller add_caller(Store& store, const std::string& id) {
  Token token;
  token.id = id;
  token.name = id;
  token.scope = Scope::Run;
  token.secret_sha256 = std::string(64 - id.size(), '0') + id;
  EXPECT_TRUE(dynamic_cast<SqlStore&>(store).access().add_token(token));
  return {Principal{id, id, Scope::Run, {}, ""}, "req", "127.0.0.1"};
}

Job add_job(Store& store, const std::string& unique_key, int priority) {
  Result<EnqueuedJob> added = store.enqueue({"characterise", unique_key, "{}", priority});
  EXPECT_TRUE(added) << added.error().message;
  EXPECT_TRUE(added->created);
  return added.value().job;
}

Job claim_one(Store& store) {
  Result<std::optional<Job>> claimed = store.claim(kLease);
  EXPECT_TRUE(claimed) << claimed.error().message;
  EXPECT_TRUE(claimed->has_value()) << "no job was due";
  if (!claimed || !*claimed) {
    return {};
  }
  return std::move(**claimed);
}

JobResults results_for(const Job& job, const Recording& recording, const std::string& channel) {
  JobResults results;
  results.document_json = member("job", job.id);
  ChannelResult found;
  found.id = make_id("chr", 0);
  found.device_id = recording.device_id;
  found.recording_id = recording.id;
  found.recording_revision = recording.revision;
  found.channel = channel;
  found.quantity = "angular_rate";
  found.axis = std::string("z");
  found.condition = recording.condition;
  found.document_json = member("channel", channel);
  found.settings_json = R"({"seed":1})";
  for (int rank = 0; rank < 2; ++rank) {
    Fit fit;
    fit.id = make_id("fit", rank);
    fit.channel_result_id = found.id;
    fit.device_id = found.device_id;
    fit.recording_id = found.recording_id;
    fit.recording_revision = found.recording_revision;
    fit.channel = channel;
    fit.quantity = found.quantity;
    fit.axis = found.axis;
    fit.condition = found.condition;
    fit.model = rank == 0 ? "WN+GM" : "WN";
    fit.rank = rank;
    fit.document_json = member("model", fit.model);
    results.fits.push_back(fit);
  }
  results.channels.push_back(std::move(found));
  return results;
}

}  // namespace driftlab::server
