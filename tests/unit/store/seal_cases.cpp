// A flipped bit in a row is noticed: whatever table and column it is in, by whoever reads the row, and by reading all
// of them back.
#include "server/store/retry_policy.hpp"
#include "server/store/sql/seals.hpp"
#include "tests/unit/store/row_suite.hpp"

#include <map>

namespace driftlab::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// What reads a row of each table, as an error where it fails.
using Readers = std::map<std::string, std::function<std::optional<Error>()>>;

template <class Row>
std::optional<Error> error_of(const Result<Row>& result) {
  return result ? std::nullopt : std::optional(result.error());
}

class SealedRows : public RowSuite {
 protected:
  /// A row in every sealed table, and how each is read.
  Readers fill();

  std::vector<std::string> damaged() {
    std::vector<std::string> found;
    EXPECT_TRUE(
        rows().read_back_rows([](std::size_t) { return true; }, [&](const std::string& row) { found.push_back(row); }));
    return found;
  }

  std::string value_of(const SealedTable& table, const std::string& column) {
    return *database().read([&](Connection& c) -> Result<std::string> {
      const auto value = c.query_text("SELECT " + column + " FROM " + std::string(table.name) + " LIMIT 1");
      return value ? Result<std::string>(value->value_or("")) : fail(value.error());
    });
  }

  /// Writes one column of the table's only row as a fault of the disk would. False: a constraint is against it.
  bool write(const SealedTable& table, const std::string& column, const std::string& value) {
    std::string literal = "'";  // of no type, so that it is a number where the column is one
    for (const char letter : value) {
      literal.append(letter == '\'' ? 2 : 1, letter);
    }
    const std::string sql = "UPDATE " + std::string(table.name) + " SET " + column + " = " + literal + "'";
    return database().write(WriteKind::Fenced, [&](Connection& c) { return c.prepare(sql).run(); }).has_value();
  }
};

Webhook webhook_to(const std::string& url) {
  Webhook webhook;
  webhook.url = url;
  webhook.description = "a line";
  webhook.events = {"job.ended"};
  webhook.secret = "whsec_a";
  return webhook;
}

Readers SealedRows::fill() {
  const Device device = add_device(store());
  const Recording recording = add_recording(store(), device);
  add_job(store(), "key");
  EXPECT_TRUE(store().fail_attempt(lease_of(claim_one(store())), {R"({"detail":"a disk"})", true})->held);
  clock_.advance(kLongestPauseMicros);
  const Job job = claim_one(store());
  JobResults results = results_for(job, recording);
  results.fits.resize(1);
  results.document_json = R"({"of":"a job"})";
  results.artefacts = {{"report.md", "A text."}};
  const Study study = store().add_study({"", device.id, "study", R"({"recordings":[]})", 0})->study;
  const StoredDrive drive = store().add_drive({"", device.id, "drive", R"({"gnss":{}})", 0})->drive;
  const StoredCalibration calibration =
      store().add_calibration({"", device.id, "calibration", R"({"bias":[1,2,3]})", 0})->calibration;
  Model model;
  model.unique_key = "model";
  model.device_id = device.id;
  model.name = "a model";
  model.document_json = R"({"processes":[]})";
  model.provenance_json = R"({"by":"hand"})";
  model = store().add_model(model)->model;
  Investigation investigation{"inv_1",   job.id, device.id, study.id, model.id, model.id, R"({"findings":1})",
                              "A page.", 0};
  results.investigations = {investigation};
  ResultVerdict verdict;
  verdict.recording_id = recording.id;
  verdict.channel = "gz";
  verdict.level = "look";
  verdict.verdict = "does not fit";
  results.verdicts = {verdict};
  EXPECT_TRUE(store().succeed(lease_of(job), results)->held);
  EXPECT_TRUE(store().add_anchor({"", device.id, "firmware=1", "why", 0, R"({"alpha":0.05})"}));
  IdempotentReply reply{"reply", "POST", "/v1/jobs", "aa", 201, R"({"a":"b"})", R"({"id":"x"})", 0};
  EXPECT_TRUE(store().remember_reply(reply));
  Token token;
  token.id = "aaaaaaaa";
  token.name = "a token";
  token.scope = Scope::Run;
  token.devices = {{"imu-1"}};
  token.secret_sha256 = std::string(64, 'a');
  token.expires_at = 1'000'000;
  EXPECT_TRUE(rows().access().add_token(token));
  const Webhook webhook = *rows().webhooks().add_webhook(webhook_to("https://lab.example/hook"), 9);
  EXPECT_TRUE(rows().webhooks().rotate_webhook(webhook.id, "whsec_b", 0));
  const std::string fit = results.fits.front().id;
  return {
      {"devices", [=, this] { return error_of(store().device(device.id)); }},
      {"blobs", [=, this] { return error_of(store().blob(recording.blob_sha256)); }},
      {"recordings", [=, this] { return error_of(store().recording(recording.id)); }},
      {"jobs", [=, this] { return error_of(store().job(job.id)); }},
      {"job_attempts", [=, this] { return error_of(store().job(job.id)); }},
      {"job_results", [=, this] { return error_of(store().result_document(job.id)); }},
      {"channel_results",
       [=, this] { return error_of(store().latest_channel_results(device.id, "angular_rate", "z")); }},
      {"fits", [=, this] { return error_of(store().fit(fit)); }},
      {"studies", [=, this] { return error_of(store().study(study.id)); }},
      {"drives", [=, this] { return error_of(store().drive(drive.id)); }},
      {"calibrations", [=, this] { return error_of(store().calibration(calibration.id)); }},
      {"models", [=, this] { return error_of(store().model(model.id)); }},
      {"investigations", [=, this] { return error_of(store().investigation("inv_1")); }},
      {"verdicts", [=, this] { return error_of(store().verdicts({}, {})); }},
      {"anchors", [=, this] { return error_of(store().anchors(std::nullopt, {})); }},
      {"artefacts", [=, this] { return error_of(store().artefact(job.id, "report.md")); }},
      {"idempotent_replies", [=, this] { return error_of(store().idempotent_reply("reply")); }},
      {"tokens",
       [this]() -> std::optional<Error> {
         const auto all = rows().access().tokens();
         const bool is_damaged = all && all->front().is_damaged;
         return is_damaged ? std::optional(damaged_row("tokens", "token", all->front().id)) : error_of(all);
       }},
      {"webhooks", [=, this] { return error_of(rows().webhooks().webhook(webhook.id)); }},
  };
}

std::vector<std::string> columns_of(const SealedTable& table) {
  std::vector<std::string> columns;
  std::string_view rest = table.columns;
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(", "), rest.size());
    columns.emplace_back(rest.substr(0, comma));
    rest.remove_prefix(std::min(comma + 2, rest.size()));
  }
  return columns;
}

DRIFTLAB_OVER_ALL_STORES(SealedRows);

TEST_P(SealedRows, AFlippedBitIsNoticedInEveryColumnOfEveryTable) {
  const Readers readers = fill();
  ASSERT_THAT(damaged(), IsEmpty());
  int told = 0;
  rows().tell_damage_to([&](const Error& error) { told += damaged_row_of(error).empty() ? 0 : 1; });
  for (const SealedTable& table : sealed_tables()) {
    const auto& read = readers.at(std::string(table.name));
    EXPECT_EQ(read(), std::nullopt) << table.name;
    int flipped = 0;
    for (const std::string& column : columns_of(table)) {
      const bool names_rows = column == "id" || column == "key" || column == "device_id" || column == "recording_id" ||
                              column == "quantity" || column == "axis" || column == "name" || column == "sha256" ||
                              column == "revision" || column == "recording_revision" || column == "job_id";
      const std::string sound = value_of(table, column);
      if (sound.empty()) {
        continue;
      }
      std::string other = sound;
      other[other.size() / 2] = static_cast<char>(other[other.size() / 2] ^ 1);
      if (!write(table, column, other)) {
        continue;  // a constraint is against it, as of a key that another table names
      }
      ++flipped;
      const std::vector<std::string> named = damaged();
      ASSERT_EQ(named.size(), 1U) << table.name << "." << column;
      EXPECT_EQ(*rows().is_damaged(named.front()), std::optional(true)) << named.front();
      if (!names_rows) {  // by another name the row is not found
        told = 0;
        const auto error = read();
        ASSERT_TRUE(error) << table.name << "." << column;
        EXPECT_EQ(error->code, ErrorCode::Io);
        EXPECT_TRUE(damaged_row_of(*error).starts_with(std::string(table.name) + "/")) << error->message;
        EXPECT_EQ(told, 1) << "whoever is to know is told";
      }
      ASSERT_TRUE(write(table, column, sound)) << table.name << "." << column;
      ASSERT_EQ(read(), std::nullopt) << table.name << "." << column;
      EXPECT_EQ(*rows().is_damaged(named.front()), std::optional(false)) << named.front();
    }
    EXPECT_GE(flipped, 1) << table.name;
  }
  EXPECT_THAT(damaged(), IsEmpty());
}

TEST_P(SealedRows, OfANameThatIsNoRowsNothingIsSaid) {
  fill();
  EXPECT_EQ(*rows().is_damaged("kitchens/spoon"), std::optional<bool>());
  EXPECT_EQ(*rows().is_damaged("devices"), std::optional<bool>());
  EXPECT_EQ(*rows().is_damaged("devices/a/b"), std::optional<bool>());
  EXPECT_EQ(*rows().is_damaged("devices/gone"), std::optional(false));
}

TEST_P(SealedRows, ASealThatIsDamagedItselfIsNoticed) {
  const Readers readers = fill();
  const SealedTable& fits = sealed_table("fits");
  std::string seal = value_of(fits, "seal");
  ASSERT_EQ(seal.size(), 64U);
  seal[7] = seal[7] == '0' ? '1' : '0';
  ASSERT_TRUE(write(fits, "seal", seal));
  EXPECT_TRUE(readers.at("fits")());
  EXPECT_EQ(damaged().size(), 1U);
}

TEST_P(SealedRows, RowsOfAnEarlierReleaseAreReadAndThenSealed) {
  const Readers readers = fill();
  EXPECT_EQ(*rows().seal_unsealed_rows(), 0) << "whatever is written has its seal";
  for (const SealedTable& table : sealed_tables()) {
    ASSERT_TRUE(write(table, std::string(table.seal), ""));
    EXPECT_EQ(readers.at(std::string(table.name))(), std::nullopt) << table.name;
  }
  EXPECT_GE(*rows().seal_unsealed_rows(), static_cast<int>(sealed_tables().size()));
  EXPECT_EQ(*rows().seal_unsealed_rows(), 0);
  EXPECT_THAT(damaged(), IsEmpty());
  for (const SealedTable& table : sealed_tables()) {
    EXPECT_EQ(readers.at(std::string(table.name))(), std::nullopt) << table.name;
    EXPECT_EQ(value_of(table, std::string(table.seal)).size(), 64U) << table.name << "." << table.seal;
  }
}

TEST_P(SealedRows, ChangesOfARowKeepItsSealTrue) {
  const Device device = add_device(store());
  Recording recording = add_recording(store(), device);
  DeviceChange change;
  change.labels_json = R"({"room":"2"})";
  ASSERT_TRUE(store().update_device(device.id, change, 1));
  recording.metadata_json = R"({"id":"other"})";
  ASSERT_TRUE(store().revise_recording(recording, 1));
  add_job(store(), "key");
  const Job job = claim_one(store());
  ASSERT_TRUE(store().report_progress(lease_of(job), "half", 0.5));
  ASSERT_TRUE(store().fail_attempt(lease_of(job), {"{}", true, false}));
  ASSERT_TRUE(store().request_cancel(job.id));
  EXPECT_THAT(damaged(), IsEmpty());
  EXPECT_TRUE(store().device(device.id));
  EXPECT_TRUE(store().recording(recording.id));
  EXPECT_FALSE(store().job(job.id)->is_damaged);
}

TEST_P(SealedRows, ADamagedTokenIsRevokedAndNotRotated) {
  AccessStore& access = rows().access();
  Token token;
  token.id = "aaaaaaaa";
  token.name = "a token";
  token.secret_sha256 = std::string(64, 'a');
  ASSERT_TRUE(access.add_token(token));
  ASSERT_TRUE(access.rotate_token("aaaaaaaa", std::string(64, 'b')));
  ASSERT_TRUE(access.note_use({{"aaaaaaaa", 5}}));
  EXPECT_THAT(damaged(), IsEmpty());
  ASSERT_TRUE(write(sealed_table("tokens"), "scope", "admin"));
  EXPECT_TRUE(access.tokens()->front().is_damaged);
  EXPECT_EQ(damaged_row_of(access.rotate_token("aaaaaaaa", std::string(64, 'c')).error()), "tokens/aaaaaaaa");
  ASSERT_TRUE(access.revoke_token("aaaaaaaa"));
  EXPECT_FALSE(access.tokens()->front().is_damaged);
  EXPECT_TRUE(access.tokens()->front().revoked_at);
  EXPECT_THAT(damaged(), IsEmpty());
}

TEST_P(SealedRows, ADamagedWebhookIsToldNothingAndCanBeRemoved) {
  WebhookStore& hooks = rows().webhooks();
  const Webhook webhook = *hooks.add_webhook(webhook_to("https://a.example/"), 9);
  WebhookChange change;
  change.description = "a line";
  ASSERT_TRUE(hooks.change_webhook(webhook.id, change, 1));
  ASSERT_TRUE(hooks.rotate_webhook(webhook.id, "t", 0));
  ASSERT_TRUE(hooks.test_webhook(webhook.id));
  EXPECT_THAT(damaged(), IsEmpty());
  ASSERT_TRUE(write(sealed_table("webhooks"), "url", "https://b.example/"));
  const std::string row = "webhooks/" + webhook.id;
  EXPECT_EQ(damaged_row_of(hooks.webhooks({}).error()), row);
  EXPECT_EQ(damaged_row_of(hooks.rotate_webhook(webhook.id, "u", 0).error()), row);
  EXPECT_EQ(damaged_row_of(hooks.change_webhook(webhook.id, change, 3).error()), row);
  const auto due = hooks.due({});
  ASSERT_TRUE(due && *due);
  EXPECT_TRUE((*due)->webhook.is_damaged);
  ASSERT_TRUE(hooks.remove_webhook(webhook.id, Store::kAnyRevision));
  EXPECT_THAT(*hooks.webhooks({}), IsEmpty());
  EXPECT_THAT(damaged(), IsEmpty());
}

TEST_P(SealedRows, AJobWithADamagedRequestIsClaimedOnceAndSaysSo) {
  add_job(store(), "key");
  ASSERT_TRUE(write(sealed_table("jobs"), "request_json", "{ }"));
  const Job job = claim_one(store());
  EXPECT_TRUE(job.is_damaged) << "it is not run";
  EXPECT_EQ(damaged_row_of(store().job(job.id).error()), "jobs/" + job.id);
  EXPECT_TRUE(store().fail_attempt(lease_of(job), {"{}"})->held) << "and does not stand before others";
}

TEST_P(SealedRows, WhatIsDamagedCanBeRemoved) {
  const Device device = add_device(store());
  const Recording recording = add_recording(store(), device);
  const Study study = store().add_study({"", device.id, "study", "{}", 0})->study;
  ASSERT_TRUE(write(sealed_table("recordings"), "metadata_json", "{ }"));
  ASSERT_TRUE(write(sealed_table("studies"), "document_json", "{ }"));
  EXPECT_THAT(damaged(), ElementsAre("recordings/" + recording.id, "studies/" + study.id));
  EXPECT_TRUE(store().remove_study(study.id));
  EXPECT_TRUE(store().remove_recording(recording.id, Store::kAnyRevision));
  EXPECT_THAT(damaged(), IsEmpty());
}

}  // namespace
}  // namespace driftlab::server
