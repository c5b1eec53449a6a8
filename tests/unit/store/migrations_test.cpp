#include "server/store/sqlite/migrations.hpp"

#include "server/store/sqlite/sqlite_store.hpp"
#include "tests/unit/store/small_disk.hpp"
#include "tests/unit/store/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace driftlab::server {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Result<std::unique_ptr<SqliteStore>> open_with(const std::filesystem::path& directory,
                                               const std::vector<Migration>& migrations) {
  static const FakeClock clock;
  SqliteOptions options;
  options.migrations = migrations;
  return open_sqlite_store(directory, clock, options);
}

/// The embedded migrations and one more.
std::vector<Migration> next_release(const std::string& sql = "ALTER TABLE devices ADD COLUMN owner TEXT") {
  std::vector<Migration> migrations = embedded_migrations();
  migrations.push_back({static_cast<int>(migrations.size()) + 1, "next", sql});
  return migrations;
}

int released() { return static_cast<int>(embedded_migrations().size()); }

/// A row in every table.
Device fill(Store& store) {
  const Device device = add_device(store);
  const Recording recording = add_recording(store, device);
  add_job(store, "done");
  const Job done = claim_one(store);
  JobResults results = results_for(done, recording);
  Study study;
  study.device_id = device.id;
  study.unique_key = "study";
  const std::string study_id = store.add_study(study)->study.id;
  Model model;
  model.unique_key = "model";
  const std::string model_id = store.add_model(model)->model.id;
  Investigation investigation;
  investigation.device_id = device.id;
  investigation.study_id = study_id;
  investigation.baseline_id = model_id;
  investigation.model_id = model_id;
  results.investigations.push_back(investigation);
  ResultVerdict item;
  item.recording_id = recording.id;
  item.level = "look";
  item.verdict = "does not fit";
  results.verdicts.push_back(item);
  EXPECT_TRUE(store.succeed(lease_of(done), results)->held);
  add_job(store, "failed");
  EXPECT_TRUE(store.fail_attempt(lease_of(claim_one(store)), {"{}"})->held);
  add_job(store, "queued");
  IdempotentReply reply;
  reply.key = "key";
  EXPECT_TRUE(store.remember_reply(reply));
  return device;
}

void expect_filled(Store& store, const Device& device) {
  EXPECT_EQ(store.device(device.name)->id, device.id);
  EXPECT_THAT(*store.recordings({}, {}), SizeIs(1));
  EXPECT_THAT(*store.jobs({}, {}), SizeIs(3));
  EXPECT_THAT(*store.fits({}, {}), SizeIs(2));
  EXPECT_THAT(*store.investigations({}, {}), SizeIs(1));
  EXPECT_THAT(*store.verdicts({}, {}), SizeIs(1));
}

TEST(Migrations, EmbeddedTextsAreTheFilesOfTheRepository) {
#ifdef DRIFTLAB_SOURCE_DIR
  const std::filesystem::path folder = std::filesystem::path(DRIFTLAB_SOURCE_DIR) / "migrations" / "sqlite";
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files += entry.path().extension() == ".sql" ? 1 : 0;
  }
  ASSERT_EQ(embedded_migrations().size(), files);
  for (const Migration& migration : embedded_migrations()) {
    std::string digits = std::to_string(migration.number);
    digits.insert(0, 4 - digits.size(), '0');
    std::ifstream file(folder / (digits + "_" + migration.name + ".sql"));
    ASSERT_TRUE(file) << migration.name;
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_EQ(migration.sql, text.str());
  }
#else
  GTEST_SKIP() << "DRIFTLAB_SOURCE_DIR is not defined";
#endif
}

TEST(Migrations, NumbersHaveNoHoles) {
  ASSERT_FALSE(embedded_migrations().empty());
  for (std::size_t i = 0; i < embedded_migrations().size(); ++i) {
    EXPECT_EQ(embedded_migrations()[i].number, static_cast<int>(i) + 1);
  }
}

TEST(Migrations, EachSaysInItsFirstLineWhoMayWorkBesideIt) {
  const auto beside = [](const std::string& sql) { return oldest_beside({30, "name", sql}); };
  EXPECT_EQ(beside("-- Programs of schema 28 and later may work beside it.\nSELECT 1"), 28);
  for (const char* const other : {"", "-- No older program may work beside it.\n", "-- Programs of schema 28\n",
                                  "-- Programs of schema 31 and later may work beside it.\n",
                                  "-- Programs of schema x and later may work beside it.\n",
                                  "\n-- Programs of schema 28 and later may work beside it.\n"}) {
    EXPECT_EQ(beside(other), 30) << other;
  }
  for (const Migration& migration : embedded_migrations()) {
    if (migration.number >= 20) {
      EXPECT_TRUE(migration.sql.starts_with("-- No older program may work beside it.\n") ||
                  oldest_beside(migration) < migration.number)
          << migration.name;
    }
  }
}

TEST(Migrations, AnOlderProgramOpensANewerStoreThatLetsIt) {
  const TemporaryDirectory directory;
  Device device;
  const std::string beside = "-- Programs of schema " + std::to_string(released()) + " and later may work beside it.\n";
  {
    const auto newer = open_with(directory.path(), next_release(beside + "ALTER TABLE devices ADD COLUMN owner TEXT"));
    ASSERT_TRUE(newer) << newer.error().message;
    EXPECT_EQ((*newer)->newer_schema(), "");
    device = fill(**newer);
  }
  {
    const auto older = open_with(directory.path(), embedded_migrations());
    ASSERT_TRUE(older) << older.error().message;
    EXPECT_THAT((*older)->newer_schema(), HasSubstr("this one works beside it"));
    expect_filled(**older, device);
    add_device(**older, "another");
  }
  EXPECT_TRUE(open_with(directory.path(), next_release(beside + "ALTER TABLE devices ADD COLUMN owner TEXT")));
}

TEST(Migrations, FromEachReleasedSchemaWithRowsNothingIsLost) {
  // Migrating starts from every schema that was ever released; rows are written by today's store into the newest only.
  for (int schema = 1; schema <= released(); ++schema) {
    const TemporaryDirectory directory;
    const std::vector<Migration> then(embedded_migrations().begin(), embedded_migrations().begin() + schema);
    ASSERT_TRUE(open_with(directory.path(), then));
    const auto now = open_with(directory.path(), embedded_migrations());
    ASSERT_TRUE(now) << now.error().message;
    EXPECT_EQ((*now)->facts().schema_before, schema);
    EXPECT_EQ((*now)->facts().schema, released());
  }
  const TemporaryDirectory directory;
  Device device;
  {
    const auto store = open_with(directory.path(), embedded_migrations());
    ASSERT_TRUE(store);
    device = fill(**store);
  }
  const auto next = open_with(directory.path(), next_release());
  ASSERT_TRUE(next) << next.error().message;
  EXPECT_EQ((*next)->facts().schema_before, released());
  EXPECT_EQ((*next)->facts().schema, released() + 1);
  expect_filled(**next, device);
}

/// Statements that make a blob, its recording and a channel's result in a store of before pooling.
std::string recording_with_result(const std::string& name) {
  const std::string hash = hash_of(name);
  const std::string recording = "'rec_" + name + "', ";
  return "INSERT INTO blobs VALUES ('" + hash + "', 1, 'csv', 'none', 1, '[]', '[]', 0);" +
         "INSERT INTO recordings VALUES (" + recording + "'dev_1', '" + hash + "', 1, '{}', 'static', '{}', 0, 0);" +
         "INSERT INTO channel_results (id, job_id, device_id, recording_id, recording_revision, channel, quantity, "
         "axis, condition, document_json, settings_json, created_at) VALUES ('chr_" +
         name + "', 'job_1', 'dev_1', " + recording + "1, 'gz', 'angular_rate', 'z', 'static', '{}', '{}', 0)";
}

/// A store of before pooling with one device and as many recordings, each with a result of one job.
void make_results_of_schema_4(const std::filesystem::path& directory, int recordings) {
  const std::vector<Migration> then(embedded_migrations().begin(), embedded_migrations().begin() + 4);
  ASSERT_TRUE(open_with(directory, then));
  const auto old = SqliteConnection::open(directory / "driftlab.db", Access::ReadWrite);
  ASSERT_TRUE((*old)->execute(
      "INSERT INTO devices VALUES ('dev_1', 'phone-07', '', '', '', '{}', 1, 0, 0);"
      "INSERT INTO jobs (id, kind, state, priority, max_failures, unique_key, request_json, run_at, created_at, "
      "finished_at) VALUES ('job_1', 'characterise', 'succeeded', 5, 5, 'key', '{}', 0, 0, 0);"
      "INSERT INTO job_results VALUES ('job_1', '{}', 0)"));
  for (int i = 1; i <= recordings; ++i) {
    ASSERT_TRUE((*old)->execute(recording_with_result(std::to_string(i))));
  }
}

TEST(Migrations, WhatAnEarlierReleasePooledIsPooledAgain) {
  // Until schema 4 a characterise job pooled what it saw of its neighbours, so that figures depended on who ended
  // first.
  const TemporaryDirectory directory;
  ASSERT_NO_FATAL_FAILURE(make_results_of_schema_4(directory.path(), 2));
  {
    const auto old = SqliteConnection::open(directory.path() / "driftlab.db", Access::ReadWrite);
    ASSERT_TRUE((*old)->execute(
        "INSERT INTO pooled_results VALUES ('dev_1', 'angular_rate', 'z', 'job_1', '{\"of\":\"one of two\"}', 0)"));
  }
  const auto now = open_with(directory.path(), embedded_migrations());
  ASSERT_TRUE(now) << now.error().message;
  const SensorAxis axis{"dev_1", "angular_rate", "z"};
  EXPECT_EQ((*now)->axis_results(axis)->pooled_json, "");
  EXPECT_THAT((*now)->axis_results(axis)->latest, SizeIs(2));
  EXPECT_EQ(*(*now)->queue_missing_pools(), 1);
  EXPECT_EQ(*(*now)->queue_missing_pools(), 0) << "asked again, the same job";
  EXPECT_EQ((*now)->axis_results(axis)->pool->state, JobState::Queued);
  const auto database = SqliteConnection::open(directory.path() / "driftlab.db", Access::ReadWrite);
  ASSERT_TRUE((*database)->execute(
      "UPDATE jobs SET unique_key = 'of before', request_json = '{\"algorithm_version\":0}' WHERE kind = 'pool'; "
      "UPDATE pools SET unique_key = 'of before'"));
  EXPECT_EQ(*(*now)->queue_missing_pools(), 1) << "pooled by another version";
  ASSERT_TRUE((*database)->execute("DELETE FROM pools"));
  EXPECT_EQ(*(*now)->queue_missing_pools(), 1) << "the axis names no job";
  EXPECT_EQ(*(*now)->queue_missing_pools(), 0);
}

TEST(Migrations, ResultsOfAnEarlierReleaseAreSeenAtAGlance) {
  const TemporaryDirectory directory;
  ASSERT_NO_FATAL_FAILURE(make_results_of_schema_4(directory.path(), 150));
  const auto now = open_with(directory.path(), embedded_migrations());
  ASSERT_TRUE(now) << now.error().message;
  Store& store = **now;
  EXPECT_TRUE(store.overviews({"dev_1"})->at("dev_1").axes.empty());
  int asked = 0;
  const GlanceOf glance_of = [&](const std::string& document) {
    EXPECT_EQ(document, "{}");
    return ++asked == 1 ? Glance{} : Glance{std::to_string(asked), asked == 120 ? 1 : 0};
  };
  EXPECT_EQ(*(*now)->keep_missing_glances(glance_of), 150);
  EXPECT_EQ(asked, 150);
  ASSERT_EQ(store.overviews({"dev_1"})->at("dev_1").axes.size(), 1U);
  EXPECT_EQ(store.overviews({"dev_1"})->at("dev_1").axes.front().glance_json, "120");
  EXPECT_EQ(*(*now)->keep_missing_glances(glance_of), 0) << "they are kept";
}

TEST(Migrations, RecordingsOfAnEarlierReleaseHaveTheirNamesAndJobs) {
  const TemporaryDirectory directory;
  const std::vector<Migration> then(embedded_migrations().begin(), embedded_migrations().begin() + 9);
  ASSERT_TRUE(open_with(directory.path(), then));
  {
    const auto old = SqliteConnection::open(directory.path() / "driftlab.db", Access::ReadWrite);
    ASSERT_TRUE((*old)->execute(
        "INSERT INTO devices VALUES ('dev_1', 'phone-07', '', '', '', '{}', 1, 0, 0);"
        "INSERT INTO blobs VALUES ('" +
        hash_of("a") +
        "', 1, 'csv', 'none', 1, '[]', '[]', 0);"
        "INSERT INTO recordings (id, device_id, blob_sha256, revision, metadata_json, condition, quality_json, "
        "created_at, updated_at) VALUES ('rec_1', 'dev_1', '" +
        hash_of("a") +
        "', 1, '{\"id\":\"static 1\"}', 'static', '{}', 0, 0);"
        "INSERT INTO jobs (id, kind, state, priority, max_failures, unique_key, request_json, run_at, created_at) "
        "VALUES ('job_1', 'characterise', 'queued', 5, 5, 'key', '{\"recordings\":[{\"id\":\"rec_1\"}]}', 0, 0)"));
  }
  const auto now = open_with(directory.path(), embedded_migrations());
  ASSERT_TRUE(now) << now.error().message;
  EXPECT_EQ((*now)->recording("rec_1")->name, "static 1");
  EXPECT_EQ((*now)->recording("rec_1")->file_name, "");
  EXPECT_EQ((*now)->recording("rec_1")->latest_job, "job_1");
}

TEST(Migrations, RecordingsOfAnEarlierReleaseAreListedByWhetherTheyHaveAResultAndCounted) {
  const TemporaryDirectory directory;
  const std::vector<Migration> then(embedded_migrations().begin(), embedded_migrations().begin() + 26);
  ASSERT_TRUE(open_with(directory.path(), then));
  const auto file = directory.path() / "driftlab.db";
  const auto run = [&](const std::string& sql) {
    const auto connection = SqliteConnection::open(file, Access::ReadWrite);
    const Status ran = (*connection)->execute(sql);
    EXPECT_TRUE(ran) << ran.error().message;
  };
  run("INSERT INTO devices (id, name, model, imu, serial, labels_json, revision, created_at, updated_at) VALUES "
      "('dev_1', 'phone-07', '', '', '', '{}', 1, 0, 0);"
      "INSERT INTO blobs (sha256, bytes, format, compression, row_count, columns_json, notes_json, created_at) VALUES "
      "('" +
      hash_of("a") +
      "', 1, 'csv', 'none', 1, '[]', '[]', 0);"
      "INSERT INTO recordings (id, device_id, blob_sha256, revision, metadata_json, condition, quality_json, "
      "created_at, updated_at) VALUES ('rec_1', 'dev_1', '" +
      hash_of("a") +
      "', 1, '{}', 'static', '{}', 0, 0);"
      "INSERT INTO tokens (id, name, secret_sha256, scope, created_at) VALUES ('tokenone', 'one', '" +
      hash_of("secret") +
      "', 'run', 0);"
      "INSERT INTO owners (object_id, token_id) VALUES ('rec_1', 'tokenone');"
      "INSERT INTO jobs (id, kind, state, priority, max_failures, unique_key, request_json, run_at, created_at, "
      "finished_at) VALUES ('job_1', 'characterise', 'succeeded', 5, 5, 'key', '{}', 0, 0, 0);"
      "INSERT INTO channel_results (id, job_id, device_id, recording_id, recording_revision, channel, quantity, axis, "
      "condition, document_json, settings_json, created_at) VALUES ('res_1', 'job_1', 'dev_1', 'rec_1', 1, 'gyro_z', "
      "'angular_rate', 'z', 'static', '{}', '{}', 0)");
  const auto listed = [&] {
    const auto connection = SqliteConnection::open(file, Access::ReadOnly);
    return (*connection)->query_integer("SELECT count(*) FROM recordings_without_result").value().value();
  };
  const auto kept = [&](std::int64_t devices, std::int64_t recordings) {
    const auto store = open_with(directory.path(), embedded_migrations());
    ASSERT_TRUE(store) << store.error().message;
    EXPECT_EQ((*store)->counts(std::nullopt)->devices, devices);
    EXPECT_EQ((*store)->counts(std::nullopt)->recordings, recordings);
    EXPECT_EQ((*store)->usage_of("dev_1", hash_of("a"))->bytes, recordings) << "of one byte each";
    EXPECT_EQ((*store)->usage_of_token("tokenone", hash_of("a"))->recordings, recordings);
  };
  kept(1, 1);
  EXPECT_EQ(listed(), 0) << "it has a result";
  run("DELETE FROM channel_results");
  EXPECT_EQ(listed(), 1) << "it has none any more";
  run("PRAGMA foreign_keys = ON; DELETE FROM jobs; DELETE FROM recordings");
  EXPECT_EQ(listed(), 0);
  kept(1, 0);
  run("DELETE FROM devices");
  kept(0, 0);
}

TEST(Migrations, AnchorsOfAnEarlierReleaseKeptNoSettings) {
  const TemporaryDirectory directory;
  const std::vector<Migration> then(embedded_migrations().begin(), embedded_migrations().begin() + 11);
  ASSERT_TRUE(open_with(directory.path(), then));
  {
    const auto old = SqliteConnection::open(directory.path() / "driftlab.db", Access::ReadWrite);
    ASSERT_TRUE(
        (*old)->execute("INSERT INTO devices VALUES ('dev_1', 'phone-07', '', '', '', '{}', 1, 0, 0);"
                        "INSERT INTO anchors VALUES ('anc_1', 'dev_1', 'firmware=1.0', 'why', 7)"));
  }
  const auto now = open_with(directory.path(), embedded_migrations());
  ASSERT_TRUE(now) << now.error().message;
  const auto anchors = (*now)->anchors("dev_1", {});
  ASSERT_TRUE(anchors);
  ASSERT_THAT(*anchors, SizeIs(1));
  EXPECT_EQ(anchors->front().label, "firmware=1.0");
  EXPECT_EQ(anchors->front().created_at, 7);
  EXPECT_EQ(anchors->front().settings_json, "");
}

TEST(Migrations, ResultsOfAnEarlierReleaseKeepTheirVerdicts) {
  const TemporaryDirectory directory;
  const std::vector<Migration> then(embedded_migrations().begin(), embedded_migrations().begin() + 13);
  ASSERT_TRUE(open_with(directory.path(), then));
  {
    const auto old = SqliteConnection::open(directory.path() / "driftlab.db", Access::ReadWrite);
    std::string rows = "INSERT INTO devices VALUES ('dev_1', 'phone-07', '', '', '', '{}', 1, 0, 0);";
    const auto add = [&](const std::string& job, const std::string& kind, const std::string& document) {
      rows +=
          "INSERT INTO jobs (id, kind, state, priority, max_failures, unique_key, request_json, run_at, created_at, "
          "finished_at) VALUES ('" +
          job + "', '" + kind + "', 'succeeded', 5, 5, '" + job + "', '{}', 0, 0, 0);" +
          "INSERT INTO job_devices VALUES ('" + job + "', 'dev_1');" + "INSERT INTO job_results VALUES ('" + job +
          "', '" + document + "', 7);";
    };
    add("job_1", "regress", R"({"summary":{"level":"wrong","verdict":"Fail."}})");
    add("job_2", "investigate", R"({"summary":{"level":"fine","verdict":"Nothing is missing."}})");
    add("job_3", "outage_evaluation", "no JSON");
    add("job_4", "characterise", R"({"recordings":[]})");
    rows += "INSERT INTO attention VALUES ('att_0', 'job_1', 'dev_1', NULL, '', 'wrong', 'Fail.', 7)";
    ASSERT_TRUE((*old)->execute(rows));
  }
  const auto now = open_with(directory.path(), embedded_migrations());
  ASSERT_TRUE(now) << now.error().message;
  VerdictFilter filter;
  filter.device_id = "dev_1";
  ASSERT_THAT(*(*now)->verdicts(filter, {}), SizeIs(1));
  EXPECT_EQ((*now)->verdicts(filter, {})->front().verdict, "Fail.");
  filter.to_read = false;
  const auto all = *(*now)->verdicts(filter, {});
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_EQ(all.back().verdict, "Nothing is missing.");
  EXPECT_EQ(all.back().level, "fine");
  EXPECT_EQ(all.back().job_id, "job_2");
  EXPECT_EQ(all.back().created_at, 7);
}

TEST(Migrations, ABackupIsMadeBeforeAndCanBeOpenedByTheOldRelease) {
  const TemporaryDirectory directory;
  Device device;
  {
    const auto store = open_with(directory.path(), embedded_migrations());
    device = fill(**store);
    EXPECT_TRUE((*store)->facts().backup.empty()) << "a new database has nothing to lose";
  }
  const TemporaryDirectory restored;
  {
    const auto next = open_with(directory.path(), next_release());
    ASSERT_TRUE(next);
    const auto backup = (*next)->facts().backup;
    ASSERT_TRUE(std::filesystem::exists(backup));
    std::filesystem::copy_file(backup, restored.path() / "driftlab.db");
  }
  EXPECT_FALSE(open_with(directory.path(), embedded_migrations())) << "the old release refuses the new schema";
  const auto old = open_with(restored.path(), embedded_migrations());
  ASSERT_TRUE(old) << old.error().message;
  expect_filled(**old, device);
}

TEST(Migrations, ANewerSchemaIsRefusedAndLeftAlone) {
  const TemporaryDirectory directory;
  ASSERT_TRUE(open_with(directory.path(), next_release()));
  const auto refused = open_with(directory.path(), embedded_migrations());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Conflict);
  EXPECT_THAT(refused.error().fields, Contains(ErrorField{"database_schema", std::to_string(released() + 1)}));
  EXPECT_THAT(refused.error().fields, Contains(ErrorField{"binary_schema", std::to_string(released())}));
  EXPECT_TRUE(open_with(directory.path(), next_release()));
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "backups"));
}

TEST(Migrations, AChangedTextOfAnAppliedMigrationIsRefused) {
  const TemporaryDirectory directory;
  ASSERT_TRUE(open_with(directory.path(), embedded_migrations()));
  std::vector<Migration> changed = embedded_migrations();
  changed.front().sql += "-- one more line\n";
  const auto refused = open_with(directory.path(), changed);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Conflict);
  EXPECT_THAT(refused.error().fields, Contains(ErrorField{"migration", "1"}));
}

TEST(Migrations, ATamperedHistoryIsRefused) {
  const TemporaryDirectory directory;
  const auto tamper = [&](const char* sql) {
    const auto connection = SqliteConnection::open(directory.path() / "driftlab.db", Access::ReadWrite);
    ASSERT_TRUE((*connection)->execute(sql));
  };
  ASSERT_TRUE(open_with(directory.path(), embedded_migrations()));
  tamper("PRAGMA user_version=0");
  EXPECT_EQ(open_with(directory.path(), embedded_migrations()).error().code, ErrorCode::Conflict);
  tamper(("PRAGMA user_version=" + std::to_string(released())).c_str());
  ASSERT_TRUE(open_with(directory.path(), embedded_migrations()));
  tamper("UPDATE schema_migrations SET sha256 = 'x' WHERE number = 1");
  EXPECT_EQ(open_with(directory.path(), embedded_migrations()).error().code, ErrorCode::Conflict);
}

TEST(Migrations, AForeignDatabaseIsRefused) {
  const TemporaryDirectory directory;
  {
    const auto connection = SqliteConnection::open(directory.path() / "driftlab.db", Access::ReadWrite);
    ASSERT_TRUE((*connection)->execute("CREATE TABLE theirs (a); INSERT INTO theirs VALUES (1)"));
  }
  const auto refused = open_with(directory.path(), embedded_migrations());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Conflict);
}

TEST(Migrations, OneThatFailsLeavesTheDatabaseAsItWas) {
  const TemporaryDirectory directory;
  Device device;
  {
    const auto store = open_with(directory.path(), embedded_migrations());
    device = fill(**store);
  }
  for (const char* sql : {"CREATE TABLE half (a); THIS IS NO SQL", "DELETE FROM devices"}) {
    const auto failed = open_with(directory.path(), next_release(sql));
    ASSERT_FALSE(failed) << sql;
    EXPECT_EQ(failed.error().code, ErrorCode::Internal);
    EXPECT_THAT(failed.error().message, HasSubstr("next"));
  }
  const auto store = open_with(directory.path(), embedded_migrations());
  ASSERT_TRUE(store) << store.error().message;
  expect_filled(**store, device);
}

TEST(Migrations, AFullDiskStopsBeforeMigrating) {
  const std::string said = on_small_disk(4 << 20, [](const std::filesystem::path& disk) -> std::string {
    {
      const auto store = open_with(disk, embedded_migrations());
      if (!store) {
        return store.error().message;
      }
      Device device;
      device.labels_json = std::string(150'000, 'x');
      for (const char* name : {"one", "two", "three"}) {
        device.name = name;
        if (!(*store)->ensure_device(device)) {
          return "no room to begin with";
        }
      }
    }
    // Room to open the database and none for a copy of it, which is larger than what is left.
    std::ofstream(disk / "ballast") << std::string(std::filesystem::space(disk).available - 300'000, 'x');
    const auto failed = open_with(disk, next_release());
    if (failed || failed.error().code != ErrorCode::DiskFull) {
      return failed ? "migrated without a backup" : failed.error().message;
    }
    if (!files_below(disk / "backups").empty()) {
      return "half a backup was left";
    }
    const auto store = open_with(disk, embedded_migrations());
    return store && (*store)->device("three") ? "" : "the database was changed";
  });
  if (said.starts_with("skip")) {
    GTEST_SKIP() << "FULL DISK NOT TESTED, " << said;
  }
  EXPECT_EQ(said, "");
}

/// The table says what the diagram in server/jobs/README.md says.
TEST(JobsTable, RefusesRowsThatTheDiagramDoesNotHave) {
  const TemporaryDirectory directory;
  const auto store = open_with(directory.path(), embedded_migrations());
  ASSERT_TRUE(store);
  add_job(**store, "key");
  const auto connection = SqliteConnection::open((*store)->facts().database, Access::ReadWrite);
  for (const char* change :
       {"state = 'paused'", "state = 'succeeded'", "finished_at = 1", "state = 'running'", "lease_expires_at = 1",
        "progress = 1.5", "progress = -0.1", "priority = 10", "cancel_requested = 1", "failures = 6", "kind = ''",
        "state = 'running', lease_expires_at = 1, attempt = 0, started_at = 1", "progress = 'much'"}) {
    EXPECT_FALSE((*connection)->execute(std::string("UPDATE jobs SET ") + change)) << change;
  }
  EXPECT_TRUE((*connection)->execute("UPDATE jobs SET state = 'failed', finished_at = 1"));
}

TEST(JobsTable, HoldsOneLiveJobForEachKey) {
  const TemporaryDirectory directory;
  const auto store = open_with(directory.path(), embedded_migrations());
  add_job(**store, "key");
  const auto connection = SqliteConnection::open((*store)->facts().database, Access::ReadWrite);
  const std::string copy =
      "INSERT INTO jobs (id, kind, state, priority, max_failures, unique_key, request_json, run_at, created_at, "
      "finished_at) SELECT 'copy', kind, ";
  EXPECT_FALSE((*connection)->execute(copy + "'queued', 5, 5, unique_key, '', 0, 0, NULL FROM jobs"));
  EXPECT_FALSE((*connection)->execute(copy + "'succeeded', 5, 5, unique_key, '', 0, 0, 1 FROM jobs"));
  EXPECT_TRUE((*connection)->execute(copy + "'failed', 5, 5, unique_key, '', 0, 0, 1 FROM jobs"));
}

}  // namespace
}  // namespace driftlab::server
