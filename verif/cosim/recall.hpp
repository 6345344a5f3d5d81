// SPDX-License-Identifier: Apache-2.0
//
// Frames that an earlier run has compared, and found the same, need not be run again. The RTL's simulation has no
// chance in it: the same model, given the same words with the same stalls from the same initial state, puts out the
// same. So what it put out is kept as a hash (cosim/verdict_store.hpp), and is held against what the golden model of
// today makes of the words of today.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "cosim/model/rtl.hpp"
#include "cosim/model/rtl_identity.hpp"
#include "cosim/model/sha256.hpp"
#include "cosim/ranges.hpp"
#include "cosim/run.hpp"
#include "cosim/verdict_store.hpp"

namespace kage::cosim {

/// Where verdicts are kept, and the conditions under which they hold.
struct RecallOptions {
  std::shared_ptr<VerdictStore> store;
  std::string context;  ///< recall_context()
  bool whole = false;   ///< a frame's verdict counts behind the very same frames of the run alone: all of them, as on
                        ///< one core. Else behind the same one frame, as it is met at the begin of a range
};

/// A hash of what a verdict hangs on besides the frames: the RTL, how it is run, and the part of this program that runs
/// it and compares, by its source text.
std::string recall_context(const RtlIdentity& rtl, const RtlOptions& options);

/// The keys of the verdicts of frames that a core gets one after the other.
class FrameKeys {
 public:
  explicit FrameKeys(const RecallOptions& options) : context_(options.context), whole_(options.whole) {}

  /// The next frame's; `words` is a hash of its words. The first one is one without a frame before it, which is run
  /// with two initial states.
  std::string next(int number, const std::string& words);

 private:
  std::string context_;
  bool whole_;
  std::string before_;
};

/// Frames of a range, one after the other, that have verdicts, or that have none.
struct Stretch {
  FrameRange range;  ///< to be run, if they have none
  bool taken = false;
  Report report;    ///< of those that have
  TempFiles files;  ///< their pictures
};

/// Lets `golden` work through the frames of the range, and finds those whose output by the RTL an earlier run found the
/// same. `all` has the first frame of the run. Members of `options` that it takes: out, name, steps, refusals,
/// all_pictures; begin, which may throw Enough to end it; same, called for frames that have a verdict. A frame that
/// cannot be made has no verdict, like all behind it: whoever runs it will meet that. `before` gives the words of
/// frames that are not compared here.
std::vector<std::unique_ptr<Stretch>> recall(const FrameRange& range, const FrameSteps& all, const Feed& feed,
                                             const Feed& before, Core& golden, const RunOptions& options,
                                             const RecallOptions& recalled);

/// A core, and a hash of what goes in and of what comes out.
class HeardCore : public Core {
 public:
  explicit HeardCore(Core& core) : core_(core) {}

  [[nodiscard]] int channels() const override { return core_.channels(); }
  void begin(int number) override { core_.begin(number); }
  void feed(std::span<const std::uint32_t> words, const LineSink& sink) override;
  FrameEnd finish(const LineSink& sink) override;

  /// SHA-256 of the last frame that ended: its words, and its lines with how it ended.
  [[nodiscard]] const std::string& words() const { return words_; }
  [[nodiscard]] const std::string& output() const { return output_; }

 private:
  LineSink heard(const LineSink& sink);

  Core& core_;
  Sha256 words_hash_;
  Sha256 output_hash_;
  std::string words_;
  std::string output_;
};

/// The expected core of a run() whose verdicts are kept: one for each frame that comes out the same.
class VerdictKeeper : public HeardCore {
 public:
  VerdictKeeper(Core& golden, const RecallOptions& options)
      : HeardCore(golden), store_(*options.store), keys_(options) {}

  FrameEnd finish(const LineSink& sink) override;

  /// Functions for RunOptions::begin and RunOptions::same to call.
  void next(int frame) { frame_ = frame; }
  void same(const FrameResult& result);

  /// How many were kept.
  [[nodiscard]] int kept() const { return kept_; }

 private:
  struct Heard {
    std::string key;
    std::string output;
  };

  VerdictStore& store_;
  FrameKeys keys_;
  int frame_ = 0;
  std::mutex mutex_;
  std::map<int, Heard> heard_;  // frames that the other core is behind with
  int kept_ = 0;
};

/// ", 3 of them taken from earlier runs", behind a number of frames; nothing where none is.
std::string taken_text(std::uint64_t taken);

}  // namespace kage::cosim
