/// A section of tests/hidden/RESULTS.md: what the stored extension is worth on fresh data, for every cause under both
/// baselines. DRIFTLAB_HIDDEN_STORED studies per cell (3), z = 30.
#include "core/investigate/causes/cause.hpp"
#include "tests/accuracy/section.hpp"
#include "tests/hidden/fresh_likelihood.hpp"
#include "tests/hidden/stored_gain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace driftlab::hidden {
namespace {

struct Cell {
  int studies = 0, named = 0, held = 0, claims = 0, fair = 0;
  double stored = 0.0, attainable = 0.0;
};

TEST(StoredModels, AreWorthOnFreshDataWhatTheTruthIsWorth) {
  const char* const text = std::getenv("DRIFTLAB_HIDDEN_STORED");  // NOLINT(concurrency-mt-unsafe): one thread
  const std::uint64_t seeds = text == nullptr ? 3 : std::strtoull(text, nullptr, 10);
  accuracy::Section section("hidden/stored");
  section.print(
      "## What a stored model is worth\n\nStored extension, stored baseline and truth scored on fresh data from the "
      "truth "
      "by a likelihood of the test's own (tests/hidden/fresh_likelihood.hpp), z = 30, %d studies per cell. `held`: the "
      "extension gains what the truth gains over the stored baseline, within 20 %% (12 nat where that is little). "
      "`worth`: all its gains over all those of the truth. `claimed`: studies whose held-out claim is within a factor "
      "of "
      "1.5 of what the extension gains, of those in which it gains 20 nat. An automatic baseline is refitted without "
      "the "
      "effect; what it can imitate is no gain.\n\n| cause | baseline | named | held | worth | claimed "
      "|\n|---|---|---|---|---|---|\n",
      static_cast<int>(seeds));
  Cell all;
  std::string without_equation;
  for (const investigate::Cause& cause : investigate::cause_registry()) {
    if (!has_equation(std::string(cause.name))) {
      without_equation.append(without_equation.empty() ? "" : ", ").append(cause.name);
      continue;
    }
    for (const bool given : {false, true}) {
      Cell cell;
      for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const StoredGain gain = stored_gain(std::string(cause.name), 30.0, 41000 + 1000 * seed + 30, given);
        ++cell.studies;
        cell.named += gain.named ? 1 : 0;
        cell.held += holds_its_promise(gain) ? 1 : 0;
        cell.stored += gain.stored;
        cell.attainable += gain.attainable;
        if (gain.stored > 20.0) {
          ++cell.claims;
          cell.fair += std::fabs(std::log(std::max(1e-9, gain.claimed / gain.stored))) < std::log(1.5) ? 1 : 0;
        }
      }
      char worth[32] = "";
      if (cell.attainable > 60.0) {
        std::snprintf(worth, sizeof worth, "%.2f", cell.stored / cell.attainable);
      }
      section.print("| %s | %s | %d of %d | %d | %s | %d of %d |\n", std::string(cause.name).c_str(),
                    given ? "given" : "automatic", cell.named, cell.studies, cell.held, worth, cell.fair, cell.claims);
      all.studies += cell.studies;
      all.held += cell.held;
      all.stored += cell.stored;
      all.attainable += cell.attainable;
      all.claims += cell.claims;
      all.fair += cell.fair;
    }
  }
  section.print("\nNot scored, for the test's likelihood has no equation of them: %s.\n", without_equation.c_str());
  section.print("\nHeld in %d of %d (%.0f %%); worth %.2f of the truth; %d of %d claims within a factor of 1.5.\n",
                all.held, all.studies, 100.0 * all.held / all.studies, all.stored / all.attainable, all.fair,
                all.claims);
  EXPECT_GE(all.held, static_cast<int>(0.9 * all.studies));
}

}  // namespace
}  // namespace driftlab::hidden
