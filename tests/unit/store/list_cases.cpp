#include "tests/unit/store/store_suite.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace driftlab::server {
namespace {

using ListStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(ListStore);

/// A recording whose metadata and file have these names.
Recording add_named(Store& store, const Device& device, const std::string& id, const std::string& file,
                    const std::string& condition = "static") {
  Blob blob;
  blob.sha256 = hash_of(id + "/" + file + "/" + condition);
  blob.bytes = 10;
  blob.format = "csv";
  blob.compression = "none";
  blob.rows = 1;
  Recording recording;
  recording.device_id = device.id;
  recording.metadata_json = id.empty() ? "{}" : R"({"id":")" + id + R"("})";
  recording.condition = condition;
  recording.file_name = file;
  return store.add_recording(blob, recording)->recording;
}

/// The names of every row, two a page.
template <class List>
std::vector<std::string> names_by_page(const List& list) {
  std::vector<std::string> names;
  Page page{"", 2, PageOrder::ByName};
  while (true) {
    const auto rows = list(page);
    EXPECT_TRUE(rows);
    if (!rows || rows->empty()) {
      return names;
    }
    for (const auto& row : *rows) {
      names.push_back(row.name);
    }
    page.after = rows->back().id;
    page.after_name = rows->back().name;
  }
}

TEST_P(ListStore, NamesOrderAListAndEqualOnesAreEachThereOnce) {
  const Device device = add_device(store(), "b");
  add_device(store(), "c");
  add_device(store(), "a");
  EXPECT_EQ(names_by_page([&](const Page& page) { return store().devices({}, page); }),
            (std::vector<std::string>{"a", "b", "c"}));
  add_named(store(), device, "same", "1.csv");
  add_named(store(), device, "same", "2.csv");
  add_named(store(), device, "same", "3.csv");
  add_named(store(), device, "", "first.csv");
  add_named(store(), device, "", "");
  EXPECT_EQ(names_by_page([&](const Page& page) { return store().recordings({}, page); }),
            (std::vector<std::string>{"", "first.csv", "same", "same", "same"}));
  for (const char* const name : {"y", "x", "y"}) {
    Model model;
    model.name = name;
    model.unique_key = make_id("key", 0);
    ASSERT_TRUE(store().add_model(model));
  }
  ModelFilter sought;
  sought.text = "MOD_";
  EXPECT_EQ(store().models(sought, {})->size(), 3U);
  sought.text = "nowhere";
  EXPECT_TRUE(store().models(sought, {})->empty());
  EXPECT_EQ(store().devices(DeviceFilter{"DEV_"}, {})->size(), 3U);
  EXPECT_TRUE(store().devices(DeviceFilter{"nowhere"}, {})->empty());
  EXPECT_EQ(names_by_page([&](const Page& page) { return store().models({}, page); }),
            (std::vector<std::string>{"x", "y", "y"}));
}

/// Every recording in that order, two a page.
std::vector<std::string> ids_by_page(Store& store, const RecordingFilter& filter, PageOrder order) {
  std::vector<std::string> ids;
  Page page{"", 2, order};
  for (auto rows = store.recordings(filter, page); rows && !rows->empty(); rows = store.recordings(filter, page)) {
    for (const Recording& row : *rows) {
      ids.push_back(row.id);
    }
    page.after = rows->back().id;
    page.after_name = rows->back().name;
  }
  return ids;
}

TEST_P(ListStore, WhatIsOfOneValueIsListedInEveryOrderAndNothingElse) {
  const std::array devices{add_device(store(), "one"), add_device(store(), "two")};
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> added;
  for (int i = 0; i < 20; ++i) {
    const Device& device = devices[static_cast<std::size_t>(i % 2)];
    const std::string condition = i % 3 == 0 ? "static" : i % 3 == 1 ? "rotation" : "statid";
    added[{device.id, condition}].push_back(add_named(store(), device, std::to_string(i), "", condition).id);
  }
  for (const std::string& device : {devices[0].id, std::string()}) {
    for (const std::string& condition : {std::string("static"), std::string("statid"), std::string()}) {
      RecordingFilter filter;
      std::vector<std::string> expected;
      for (const auto& [of, ids] : added) {
        if ((device.empty() || of.first == device) && (condition.empty() || of.second == condition)) {
          expected.insert(expected.end(), ids.begin(), ids.end());
        }
      }
      std::ranges::sort(expected);
      filter.device_id = device.empty() ? std::nullopt : std::optional(device);
      filter.condition = condition.empty() ? std::nullopt : std::optional(condition);
      EXPECT_EQ(ids_by_page(store(), filter, PageOrder::OldestFirst), expected) << device << condition;
      auto by_name = ids_by_page(store(), filter, PageOrder::ByName);
      std::ranges::sort(by_name);
      EXPECT_EQ(by_name, expected) << device << condition;
      std::ranges::reverse(expected);
      EXPECT_EQ(ids_by_page(store(), filter, PageOrder::NewestFirst), expected) << device << condition;
    }
  }
}

TEST_P(ListStore, TheRowBehindACursorNeedNotBeThereAnyMore) {
  const Device device = add_device(store());
  add_named(store(), device, "a", "");
  const Recording gone = add_named(store(), device, "b", "");
  const Recording last = add_named(store(), device, "c", "");
  ASSERT_TRUE(store().remove_recording(gone.id, 1));
  const auto rows = store().recordings({}, Page{gone.id, 2, PageOrder::ByName, gone.name});
  ASSERT_EQ(rows->size(), 1U);
  EXPECT_EQ(rows->front().id, last.id);
}

TEST_P(ListStore, ANameIsThatOfTheMetadataElseThatOfTheFileAndFollowsARevision) {
  Recording recording = add_named(store(), add_device(store()), "", "gyro.csv");
  EXPECT_EQ(recording.name, "gyro.csv");
  recording.metadata_json = R"({"id":"rate 9"})";
  EXPECT_EQ(store().revise_recording(recording, 1)->name, "rate 9");
  EXPECT_EQ(store().recording(recording.id)->file_name, "gyro.csv");
}

TEST_P(ListStore, RecordingsAreSoughtByTextTimeAndResult) {
  const Device device = add_device(store());
  const Recording table = add_named(store(), device, "Turntable 9", "a.csv", "constant_rate:z:9:deg/s");
  clock_.advance(kHour);
  const Recording still = add_named(store(), device, "", "STILL_1.csv");
  const auto ids = [&](RecordingFilter filter) {
    std::vector<std::string> found;
    const auto rows = store().recordings(filter, {});
    for (const Recording& row : *rows) {
      found.push_back(row.id);
    }
    return found;
  };
  const auto with = [&](const auto& change) {
    RecordingFilter filter;
    change(filter);
    return ids(filter);
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(with([](RecordingFilter& f) { f.text = "turntable"; }), Ids{table.id});
  EXPECT_EQ(with([](RecordingFilter& f) { f.text = "still_"; }), Ids{still.id});
  EXPECT_EQ(with([](RecordingFilter& f) { f.text = "CONSTANT_RATE"; }), Ids{table.id});
  EXPECT_EQ(with([](RecordingFilter& f) { f.text = "%"; }), Ids{}) << "what is sought is no pattern";
  EXPECT_EQ(with([](RecordingFilter& f) { f.text = "stil__1"; }), Ids{}) << "nor is a part of it";
  EXPECT_EQ(with([](RecordingFilter& f) { f.text = "9 a.csv"; }), Ids{table.id});
  EXPECT_EQ(with([](RecordingFilter& f) { f.text = "\\"; }), Ids{});
  EXPECT_EQ(with([&](RecordingFilter& f) { f.text = still.id; }), Ids{still.id});
  EXPECT_EQ(with([&](RecordingFilter& f) { f.since = clock_.now(); }), Ids{still.id});
  EXPECT_EQ(with([&](RecordingFilter& f) { f.since = clock_.now() + kSecond; }), Ids{});
  EXPECT_EQ(with([](RecordingFilter& f) { f.has_result = true; }), Ids{});
  add_job(store(), "key");
  const Job job = claim_one(store());
  ASSERT_TRUE(store().succeed(lease_of(job), results_for(job, table))->held);
  EXPECT_EQ(with([](RecordingFilter& f) { f.has_result = true; }), Ids{table.id});
  const auto without = [](RecordingFilter& f) { f.has_result = false; };
  EXPECT_EQ(with(without), Ids{still.id}) << "before the list has been settled";
  EXPECT_EQ(*store().settle_recordings(), 1) << "the one that has a result by now";
  EXPECT_EQ(*store().settle_recordings(), 0);
  EXPECT_EQ(with(without), Ids{still.id});
  const Recording later = add_named(store(), device, "", "later.csv");
  EXPECT_EQ(with(without).size(), 2U) << later.id;
}

TEST_P(ListStore, JobsAreSoughtByDeviceScenarioAndTimeAndARecordingNamesItsNewest) {
  const Recording recording = add_recording(store(), add_device(store(), "one"));
  const Recording other = add_recording(store(), add_device(store(), "two"), "other");
  EXPECT_EQ(recording.latest_job, "");
  const auto asked = [&](const std::string& key, const std::string& request) {
    return store().enqueue({"characterise", key, request})->job;
  };
  const auto naming = [](const Recording& named) {
    return R"({"inputs":{"recordings":[{"id":")" + named.id + R"("},{"id":")" + named.id + R"("}]}})";
  };
  asked("a", naming(recording));
  const Job newest = asked("b", naming(recording));
  const Job of_other = asked("c", naming(other));
  clock_.advance(kHour);
  const Job shipped = asked("d", R"({"inputs":{"scenario":"Paper"}})");
  const Job own = asked("e", R"({"inputs":{"scenario":{"name":"tunnel","runs":3}}})");
  EXPECT_EQ(store().recording(recording.id)->latest_job, newest.id);
  const auto ids = [&](const JobFilter& filter) {
    std::vector<std::string> found;
    const auto rows = store().jobs(filter, {});
    for (const Job& row : *rows) {
      found.push_back(row.id);
    }
    return found;
  };
  using Ids = std::vector<std::string>;
  JobFilter filter;
  filter.device_id = other.device_id;
  EXPECT_EQ(ids(filter), Ids{of_other.id});
  filter = {};
  filter.scenario = "PAPER";
  EXPECT_EQ(ids(filter), Ids{shipped.id});
  filter.scenario = "tunnel";
  EXPECT_EQ(ids(filter), Ids{own.id});
  filter = {};
  filter.since = clock_.now();
  EXPECT_EQ(ids(filter), (Ids{shipped.id, own.id}));
}

TEST_P(ListStore, InvestigationsAreSoughtByTextAndTime) {
  const Device device = add_device(store(), "ADIS16405-1");
  Study study;
  study.device_id = device.id;
  study.unique_key = "study";
  Model model;
  model.unique_key = "model";
  Investigation made;
  made.device_id = device.id;
  made.study_id = store().add_study(study)->study.id;
  made.baseline_id = made.model_id = store().add_model(model)->model.id;
  made.summary_json = R"([{"cause":"temperature_bias"}])";
  add_job(store(), "key");
  JobResults results;
  results.investigations.push_back(made);
  ASSERT_TRUE(store().succeed(lease_of(claim_one(store())), results)->held);
  InvestigationFilter filter;
  for (const auto& [text, found] : {std::pair{"adis", 1U}, std::pair{"Temperature", 1U}, std::pair{"vibration", 0U}}) {
    filter.text = text;
    EXPECT_EQ(store().investigations(filter, {})->size(), found) << text;
  }
  filter = {};
  filter.since = clock_.now() + kSecond;
  EXPECT_TRUE(store().investigations(filter, {})->empty());
}

/// What a job says of a recording.
ResultVerdict about(const Recording& recording, const std::string& verdict, const std::string& level = "look") {
  ResultVerdict item;
  item.device_id = recording.device_id;
  item.recording_id = recording.id;
  item.channel = "gz";
  item.level = level;
  item.verdict = verdict;
  return item;
}

TEST_P(ListStore, VerdictsAreTheNewestWordOnARecordingAndEveryOtherResult) {
  const Recording recording = add_recording(store(), add_device(store()));
  const auto finish = [&](const std::vector<ResultVerdict>& items) {
    clock_.advance(kMinute);
    add_job(store(), "key " + make_id("job", 0));
    const Job job = claim_one(store());
    JobResults results = results_for(job, recording);
    results.verdicts = items;
    EXPECT_TRUE(store().succeed(lease_of(job), results)->held);
    return job;
  };
  const auto verdicts = [&](const VerdictFilter& filter = {}) {
    std::vector<std::string> found;
    const auto items = store().verdicts(filter, {"", 50, PageOrder::NewestFirst});
    for (const ResultVerdict& item : *items) {
      found.push_back(item.verdict);
    }
    return found;
  };
  using Verdicts = std::vector<std::string>;
  finish({about(recording, "does not fit")});
  ResultVerdict whole;
  whole.level = "wrong";
  whole.verdict = "worse than before";
  const Job regression = finish({whole});
  EXPECT_EQ(verdicts(), (Verdicts{"worse than before", "does not fit"}));
  const auto items = *store().verdicts({}, {});
  EXPECT_EQ(items.back().job_id, regression.id);
  EXPECT_EQ(items.back().kind, "characterise");
  EXPECT_EQ(items.back().device_id, "") << "its job names none";
  EXPECT_EQ(items.front().channel, "gz");
  VerdictFilter filter;
  filter.device_id = recording.device_id;
  EXPECT_EQ(verdicts(filter), Verdicts{"does not fit"});
  filter = {};
  filter.since = clock_.now();
  EXPECT_EQ(verdicts(filter), Verdicts{"worse than before"});
  finish({about(recording, "gross errors")});
  EXPECT_EQ(verdicts(), (Verdicts{"gross errors", "worse than before"}));
  finish({about(recording, "fits", "fine")});
  EXPECT_EQ(verdicts(), Verdicts{"worse than before"}) << "a newer result of the recording is fine";
  filter = {};
  filter.to_read = false;
  EXPECT_EQ(verdicts(filter), (Verdicts{"fits", "worse than before"})) << "and is kept as what the recording comes to";
  filter.device_id = recording.device_id;
  EXPECT_EQ(verdicts(filter), Verdicts{"fits"});
  finish({about(recording, "again")});
  Page limited;
  limited.visible = Visibility{R"(["another"])", "token"};
  EXPECT_TRUE(store().verdicts({}, limited)->empty()) << "a token limited to other devices";
  ASSERT_TRUE(store().remove_recording(recording.id, 1));
  EXPECT_EQ(verdicts(), Verdicts{}) << "results that held the recording go with it";
}

TEST_P(ListStore, WhatTheDevicesOfAModelSayOfOneHoldsUntilTheySayElse) {
  const Recording recording = add_recording(store(), add_device(store()));
  const auto finish = [&](const std::string& model, const std::string& said) {
    clock_.advance(kMinute);
    add_job(store(), "key " + make_id("job", 0));
    JobResults results;
    results.verdicts.push_back(about(recording, "fits", "fine"));
    results.verdicts.push_back({.device_id = recording.device_id, .channel = model, .level = "look", .verdict = said});
    ASSERT_TRUE(store().succeed(lease_of(claim_one(store())), results)->held);
  };
  const auto newest = [&] {
    return store().overviews({recording.device_id})->at(recording.device_id).verdict->verdict;
  };
  finish("MPU-6050", "not of the line");
  finish("board", "not of the boards");
  EXPECT_EQ(store().verdicts({}, {})->size(), 2U) << "each model speaks for itself";
  finish("MPU-6050", "not of the line by N");
  EXPECT_EQ(newest(), "not of the line by N");
  const std::string own = store().device(recording.device_id)->name;
  Page limited;
  limited.visible = Visibility{"[\"" + own + "\"]", "token"};
  VerdictFilter all;
  all.to_read = false;
  ASSERT_EQ(store().verdicts(all, limited)->size(), 1U) << "to whom the other devices are nothing";
  EXPECT_EQ(store().verdicts(all, limited)->front().verdict, "fits");
  EXPECT_EQ(store().overviews({recording.device_id}, limited.visible)->at(recording.device_id).verdict->verdict, "fits");
  finish("MPU-6050", "");
  EXPECT_EQ(newest(), "fits") << "nothing is to be said any more";
  ASSERT_EQ(store().verdicts({}, {})->size(), 1U);
  EXPECT_EQ(store().verdicts({}, {})->front().channel, "board");
}

TEST_P(ListStore, AResultOfOneDeviceIsThatDevices) {
  const Recording recording = add_recording(store(), add_device(store()));
  const std::string request = R"({"inputs":{"device":")" + recording.device_id + R"("}})";
  ASSERT_TRUE(store().enqueue({"regress", "key", request}));
  JobResults results;
  ResultVerdict whole;
  whole.level = "look";
  whole.verdict = "inconclusive";
  results.verdicts.push_back(whole);
  ASSERT_TRUE(store().succeed(lease_of(claim_one(store())), results)->held);
  ASSERT_EQ(store().verdicts({}, {})->size(), 1U);
  EXPECT_EQ(store().verdicts({}, {})->front().device_id, recording.device_id);
}

TEST_P(ListStore, JobsThatEndedSinceAreCountedWithoutPools) {
  add_device(store());
  const auto end = [&](const std::string& kind, bool well) {
    clock_.advance(kMinute);
    EXPECT_TRUE(store().enqueue({kind, make_id("key", 0), "{}"}));
    const Job job = claim_one(store());
    EXPECT_TRUE(well ? store().succeed(lease_of(job), {})->held : store().fail_attempt(lease_of(job), {"{}"})->held);
  };
  end("characterise", false);
  const UtcMicros since = clock_.now() + kSecond;
  end("characterise", true);
  end("characterise", true);
  end("pool", true);
  end("regress", false);
  const auto ended = store().ended_since(since);
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->succeeded, 2);
  EXPECT_EQ(ended->failed, 1);
  EXPECT_EQ(store().ended_since(0)->failed, 2);
  EXPECT_EQ(store().ended_since(0, Visibility{"[]", "token"})->failed, 0);
}

}  // namespace
}  // namespace driftlab::server
