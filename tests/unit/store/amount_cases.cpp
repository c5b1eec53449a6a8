#include "server/store/principal.hpp"
#include "server/store/sql/sql_store.hpp"
#include "tests/unit/store/store_suite.hpp"

#include <map>
#include <random>
#include <set>

namespace driftlab::server {
namespace {

using AmountStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(AmountStore);

constexpr int kBytes = 1000;  // of every recording of these tests

TEST_P(AmountStore, WhatIsKeptIsWhatIsThereAfterAnySequenceOfChanges) {
  const std::vector<Device> devices{add_device(store(), "one"), add_device(store(), "two"),
                                    add_device(store(), "three")};
  const std::vector<Caller> callers{add_caller(store(), "aaaaaaaa"), add_caller(store(), "bbbbbbbb")};
  struct Kept {
    std::size_t device;
    std::string blob;
    std::size_t caller;
  };
  std::map<std::string, Kept> there;
  std::set<std::string> blobs;
  std::mt19937_64 random(20261129);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (int step = 0; step < 120; ++step) {
    if (below(3) > 0 || there.empty()) {
      const std::size_t device = below(devices.size());
      const std::size_t caller = below(callers.size());
      const std::string seed = std::to_string(below(8));  // often one that the device has already
      const ActingFor acting(callers[caller]);
      const Recording added = add_recording(store(), devices[device], seed);
      there.try_emplace(added.id, Kept{device, hash_of(seed), caller});  // who sends it again does not own it
      blobs.insert(hash_of(seed));
    } else {
      const auto gone = std::next(there.begin(), static_cast<std::ptrdiff_t>(below(there.size())));
      ASSERT_TRUE(store().remove_recording(gone->first, Store::kAnyRevision));
      const std::string blob = gone->second.blob;
      there.erase(gone);
      if (store().remove_unused_blob(blob).value()) {
        blobs.erase(blob);
      }
    }
    if (below(10) == 0) {
      ASSERT_TRUE(store().settle_recordings());
    }
    const auto counts = store().counts();
    ASSERT_TRUE(counts);
    EXPECT_EQ(counts->devices, 3);
    EXPECT_EQ(counts->recordings, std::ssize(there));
    EXPECT_EQ(*dynamic_cast<SqlStore&>(store()).blob_bytes(), kBytes * std::ssize(blobs));
    const std::string sought = hash_of(std::to_string(below(8)));
    const auto expect = [&](const Result<DeviceUsage>& usage, const auto& belongs) {
      ASSERT_TRUE(usage);
      std::int64_t number = 0;
      bool holds = false;
      for (const auto& [id, kept] : there) {
        number += belongs(kept) ? 1 : 0;
        holds = holds || (belongs(kept) && kept.blob == sought);
      }
      EXPECT_EQ(usage->recordings, number) << "step " << step;
      EXPECT_EQ(usage->bytes, kBytes * number);
      EXPECT_EQ(usage->holds_these_bytes, holds);
    };
    for (std::size_t d = 0; d < devices.size(); ++d) {
      expect(store().usage_of(devices[d].id, sought), [&](const Kept& kept) { return kept.device == d; });
    }
    for (std::size_t c = 0; c < callers.size(); ++c) {
      expect(store().usage_of_token(callers[c].principal.token, sought),
             [&](const Kept& kept) { return kept.caller == c; });
    }
  }
}

TEST_P(AmountStore, ADeviceThatIsGoneIsCountedNoMore) {
  const Device device = add_device(store(), "gone");
  const Recording recording = add_recording(store(), device);
  ASSERT_TRUE(store().remove_recording(recording.id, Store::kAnyRevision));
  ASSERT_TRUE(store().remove_device(device.id, device.revision));
  ASSERT_TRUE(store().settle_recordings());
  EXPECT_EQ(store().counts()->devices, 0);
  EXPECT_EQ(store().counts()->recordings, 0);
  EXPECT_EQ(store().usage_of(device.id, recording.blob_sha256)->recordings, 0);
}

}  // namespace
}  // namespace driftlab::server
