// SPDX-License-Identifier: Apache-2.0
// Stores of sweeps. Pages are SQLite's to read; kage looks at the schema, the version and each row.
#include "explore/sweep_store.hpp"
#include "file/read_file.hpp"
#include "fuzz/target.hpp"
#include "kage/error.hpp"

namespace kage::fuzz {
namespace {

/// A store that passes its check opens, and its rows go into another one.
void run_store(Bytes bytes) {
  const auto path = file_of("s.sqlite", bytes);
  std::filesystem::remove(path.string() + "-journal");
  explore::SweepStore::check(path);
  const auto taken = file_of("taken.sqlite", {});
  std::filesystem::remove(taken.string() + "-journal");
  explore::SweepStore store(taken);
  const int runs = store.absorb(path);
  require(runs == store.runs() && runs == explore::SweepStore(path).runs(), "all rows are taken");
  explore::SweepStore::check(taken);
}

std::vector<std::string> store_seeds() {
  const auto path = file_of("seed.sqlite", {});
  std::vector<std::string> seeds;
  for (const int rows : {0, 2}) {
    {
      explore::SweepStore store(path);
      for (int i = 0; i < rows; ++i)
        store.keep_run(std::to_string(i), "courtyard", "Z_BITS=8", {.build = "b", .scene = "s", .tools = "t"}, "{}");
      if (rows > 0) store.keep_clocks("0", {.cycles = 1000, .foretold = 900, .seconds = 0.5});
    }
    seeds.push_back(read_file(path));
  }
  return seeds;
}

}  // namespace

std::span<const Target> store_targets() {
  static const Target kTargets[] = {{"store", "stores of sweeps", run_store, store_seeds}};
  return kTargets;
}

}  // namespace kage::fuzz
