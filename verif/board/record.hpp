// SPDX-License-Identifier: Apache-2.0
//
// A run on a board as a run of kage cosim is told: its record, its pictures and its page.
#pragma once

#include <filesystem>
#include <string>

#include "board/pack_run.hpp"
#include "cosim/report/run_record.hpp"
#include "file/temp_file.hpp"
#include "kage/cosim.hpp"
#include "vectors/pack.hpp"

namespace kage::board {

/// A pack that was played, and the verdict.
struct BoardRun {
  const vectors::Pack& pack;
  std::string folder;  ///< the pack's
  std::string port;
  const PackVerdict& verdict;
  std::string again;  ///< the command line that repeats it
  std::string kage;   ///< the version that made it, "kage 0.1.0"
};

/// The record. An `out` that is not empty adds to `files`: pictures of the frames, a stream file of them, and
/// report.html. With the stream file, `kage explain` tells what the page has no room for. If a file cannot be written,
/// the verdict stays as it is and gets a note.
report::RunRecord record_of(const BoardRun& run, const std::string& out, TempFiles& files, cosim::Host& host);

}  // namespace kage::board
