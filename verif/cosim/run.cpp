// SPDX-License-Identifier: Apache-2.0
#include "cosim/run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "kage/diff.hpp"
#include "kage/error.hpp"
#include "pipeline/frame_picture.hpp"

namespace kage::cosim {
namespace {

/// A piece of a frame on its way to the actual core.
struct Piece {
  std::vector<std::uint32_t> words;
  Lines lines;          // what the expected core made of them
  bool before = false;  // of RunOptions::before
  struct End {
    FrameEnd expected;
    TokenCounts counts;
    std::unique_ptr<FramePicture> picture;  // without its name
    Lines undrawn;                          // of the picture, which is complete without them or needs them all

    /// To be called for a picture that is wanted.
    void draw() {
      if (!picture) return;
      for (; !undrawn.empty(); undrawn.pop()) picture->line(undrawn.front());
      picture->close();
    }
  };
  std::optional<End> end;  // the frame ends here

  [[nodiscard]] std::size_t bytes() const {
    return words.size() * sizeof words[0] + lines.bytes() + (end ? end->undrawn.bytes() : 0);
  }
};

/// A core in a frame that is compared.
class Compared {
 public:
  Compared(Core& core, int frame, bool keep) : core_(core), comparison_(frame, core.channels(), keep) {
    core.begin(frame);
  }

  /// Its part of a piece, before which the expected lines of it are there, and how it ends the frame where that is the
  /// last. A failure ends what can be compared: the expected core alone goes on to the frame's end.
  void take(Lines lines, const Piece& piece) {
    if (failed_) return;
    comparison_.expect(std::move(lines));
    const LineSink sink = [this](int, std::span<const std::uint8_t> line) { comparison_.actual(line); };
    try {
      core_.feed(piece.words, sink);
      if (piece.end) end_ = core_.finish(sink);
    } catch (const CoreFailure& e) {
      comparison_.failed(e);
      failed_ = true;
    }
  }

  [[nodiscard]] const FrameEnd& end() const { return end_; }
  [[nodiscard]] bool failed() const { return failed_; }
  std::optional<Difference> finish(const FrameEnd& expected) { return comparison_.finish(expected, end_); }
  [[nodiscard]] FrameComparison::Drawn drawn(const Image& expected) const { return comparison_.drawn(expected); }

 private:
  Core& core_;
  FrameComparison comparison_;
  FrameEnd end_;
  bool failed_ = false;
};

/// The actual core, and the verdict.
class Comparer {
 public:
  Comparer(Core& actual, const RunOptions& options) : actual_(actual), options_(options) {}

  /// False after the first difference: nothing more is wanted.
  bool take(Piece piece) {
    if (piece.before) return take_before(piece);
    const bool keep = !options_.out.empty();
    if (!own_) {
      own_.emplace(actual_, number(), keep);
      if (report_.frames == 0 && options_.other_state != nullptr) other_.emplace(*options_.other_state, number(), keep);
    }
    if (other_) other_->take(piece.lines, piece);
    own_->take(std::move(piece.lines), piece);
    return !piece.end || end_frame(*piece.end);
  }

  [[nodiscard]] Report& report() { return report_; }

  /// There is a verdict: the pictures get their names, here or by the caller.
  void commit() {
    if (options_.files != nullptr)
      options_.files->take(files_);
    else
      files_.commit();
  }

 private:
  /// Number of the frame at hand.
  [[nodiscard]] int number() const { return options_.steps.first + report_.frames * options_.steps.step; }

  /// Runs a frame before those of this run; its output is judged by the run that compares it.
  bool take_before(Piece& piece) {
    if (!own_) own_.emplace(actual_, number() - (options_.before - before_) * options_.steps.step, false);
    own_->take(std::move(piece.lines), piece);
    if (!piece.end) return true;
    ++before_;
    report_.broken = own_->failed();
    own_.reset();
    return !report_.broken;
  }

  bool end_frame(Piece::End& end) {
    const FrameEnd& e = end.expected;
    const FrameEnd& a = own_->end();
    const int frame = number();
    report_.first_difference = own_->finish(e);
    if (!report_.first_difference && other_) {
      report_.first_difference = other_->finish(e);
      if (report_.first_difference) report_.first_difference->other_state = true;
    }
    FrameResult result{frame, e.status, end.counts, a.cycles, a.stalls, a.phase_stalls, {}};
    // If this frame is right and the one ahead of it is not, pictures would show nothing.
    const bool differs = report_.first_difference && !report_.first_difference->ahead;
    const bool wanted = options_.all_pictures || differs;
    if (wanted && !options_.all_pictures) end.draw();
    const bool shown = wanted && end.picture && end.picture->drawn();
    if (shown) result.picture = end.picture->path().string();
    report_.add(result, e.seconds, a.seconds);
    if (shown) {
      if (differs) expected_ = load_image(end.picture->temp());
      end.picture->hand_over(files_);
    }
    if (report_.first_difference) {
      report_.same = false;
      if (differs && !options_.out.empty()) show_difference(frame);
      return false;
    }
    // Both refuse the header alike, so there is nothing that could have been compared: no verdict, and never "same".
    if (e.status.width == 0 && !options_.refusals)
      throw Error(fmt::format("{}: frame {}: the cores refuse it: {}", options_.name, frame, describe(e.status)));
    if (options_.same) options_.same(result);
    own_.reset();
    other_.reset();
    return true;
  }

  void show_difference(int frame) {
    const auto [actual, came] = (report_.first_difference->other_state ? *other_ : *own_).drawn(expected_);
    Image difference;
    if (!expected_.data.empty()) {
      // A pixel that never came has no colour that could differ.
      Image told = actual;
      const auto missing = static_cast<std::ptrdiff_t>(came);
      std::copy(expected_.data.begin() + missing, expected_.data.end(), told.data.begin() + missing);
      report_.difference = diff_images(expected_, told, {}, &difference);
      const auto pixels = static_cast<std::ptrdiff_t>(came / static_cast<std::size_t>(actual.channels));
      report_.missing_pixels = std::int64_t{actual.width} * actual.height - pixels;
      std::fill(difference.data.begin() + pixels * difference.channels, difference.data.end(), std::uint8_t{0});
    }
    const auto save = [&](const char* suffix, const Image& image) {
      if (image.data.empty()) return;
      const auto path = options_.out / fmt::format("{}_{:04}{}.png", options_.name, frame, suffix);
      save_image(files_, path, image);
      report_.pictures.push_back(path.string());
    };
    save("_expected", expected_);
    save("_actual", actual);
    save("_difference", difference);
  }

  Core& actual_;
  const RunOptions& options_;
  Report report_;
  TempFiles files_;                // the pictures of the report
  Image expected_;                 // of the frame with the difference
  int before_ = 0;                 // frames of RunOptions::before that have ended
  std::optional<Compared> own_;    // the actual core
  std::optional<Compared> other_;  // RunOptions::other_state
};

/// The comparer on a thread of its own, behind a queue that holds so much and no more.
class Behind {
 public:
  Behind(Comparer& comparer, const std::function<void()>& wait)
      : comparer_(comparer), wait_(wait), thread_([this] { work(); }) {}
  ~Behind() {
    end(true);
    thread_.join();
  }
  Behind(const Behind&) = delete;
  Behind& operator=(const Behind&) = delete;

  /// Waits for room. False: nothing more is wanted.
  bool put(Piece piece) {
    const std::size_t bytes = piece.bytes();
    std::unique_lock lock(mutex_);
    until(lock, [&] { return stopped_ || bytes_ == 0 || bytes_ + bytes <= kAheadBytes; });
    if (stopped_) return false;
    bytes_ += bytes;
    queue_.push_back(std::move(piece));
    changed_.notify_all();
    return true;
  }

  /// Wait until all that was put is worked off, or nothing more is wanted. Throws what the comparer threw.
  void finish() {
    end(false);
    std::unique_lock lock(mutex_);
    until(lock, [&] { return stopped_; });
    if (error_) std::rethrow_exception(error_);
  }

 private:
  template <class Condition>
  void until(std::unique_lock<std::mutex>& lock, Condition condition) {
    while (!changed_.wait_for(lock, std::chrono::milliseconds(100), condition)) {
      if (!wait_) continue;
      lock.unlock();
      wait_();
      lock.lock();
    }
  }

  void end(bool at_once) {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    if (at_once) stopped_ = true;
    changed_.notify_all();
  }

  void work() {
    std::unique_lock lock(mutex_);
    while (!stopped_) {
      changed_.wait(lock, [&] { return stopped_ || ended_ || !queue_.empty(); });
      if (stopped_) break;
      if (queue_.empty()) {
        stopped_ = true;
        break;
      }
      // The piece counts until it is worked off.
      const std::size_t bytes = queue_.front().bytes();
      Piece piece = std::move(queue_.front());
      queue_.pop_front();
      lock.unlock();
      bool more = false;
      std::exception_ptr error;
      try {
        more = comparer_.take(std::move(piece));
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      bytes_ -= bytes;
      error_ = error;
      if (!more) stopped_ = true;
      changed_.notify_all();
    }
    changed_.notify_all();
  }

  Comparer& comparer_;
  const std::function<void()>& wait_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Piece> queue_;
  std::size_t bytes_ = 0;
  bool ended_ = false;    // nothing more will be put
  bool stopped_ = false;  // nothing more will be taken
  std::exception_ptr error_;
  std::thread thread_;
};

using Taker = std::function<bool(Piece)>;

/// The expected core works through all frames; what it does is handed to `take`.
void lead(int frames, const Feed& feed, Core& expected, const RunOptions& options, const Taker& take) {
  const auto hand_on = [&](Piece& piece) {
    const bool before = piece.before;
    if (!take(std::exchange(piece, {}))) throw Enough();
    piece.before = before;
  };
  for (int i = options.steps.first - options.before * options.steps.step; i < frames; i += options.steps.step) {
    if (options.begin) options.begin(i);
    const bool before = i < options.steps.first;
    Piece piece;
    piece.before = before;
    std::unique_ptr<FramePicture> picture;
    if (!options.out.empty() && !before)
      picture = std::make_unique<FramePicture>(options.out / fmt::format("{}_{:04}.png", options.name, i));
    Lines undrawn;
    const LineSink line = [&](int, std::span<const std::uint8_t> pixels) {
      piece.lines.add(pixels);
      if (!picture) return;
      if (options.all_pictures)
        picture->line(pixels);
      else
        undrawn.add(pixels);  // a file for each of thousands of small frames takes far longer than their pixels
    };
    const TokenCounts counts = feed(i, [&](std::span<const std::uint32_t> words) {
      piece.words.assign(words.begin(), words.end());
      if (picture) picture->words(words);
      expected.feed(words, line);
      hand_on(piece);
    });
    const FrameEnd end = expected.finish(line);
    piece.end = Piece::End{end, counts, std::move(picture), std::move(undrawn)};
    if (options.all_pictures) piece.end->draw();
    hand_on(piece);
  }
}

}  // namespace

void Report::add(const FrameResult& result, double expected, double actual) {
  ++frames;
  width = std::max(width, result.status.width);
  height = std::max(height, result.status.height);
  pixels_compared += static_cast<std::uint64_t>(result.status.width) * static_cast<std::uint64_t>(result.status.height);
  spans += result.counts.spans;
  span_pixels += result.counts.span_pixels;
  segments += result.counts.of_kind[static_cast<std::size_t>(Kind::SEG)];
  cycles += result.cycles;
  stalls.starved += result.stalls.starved;
  stalls.blocked += result.stalls.blocked;
  expected_seconds += expected;
  actual_seconds += actual;
  frame_seconds.push_back(expected + actual);
  if (result.taken) taken.push_back(result.frame);
  if (!result.picture.empty()) pictures.push_back(result.picture);
  if (each.size() < kFrameResults || first_difference) each.push_back(result);
}

Report run(int frames, const Feed& feed, Core& expected, Core& actual, const RunOptions& options) {
  Comparer comparer(actual, options);
  std::optional<Behind> thread;
  try {
    if (options.two_threads) thread.emplace(comparer, options.wait);
  } catch (const std::system_error&) {  // the system gives no more threads: one does both
  }
  if (thread) {
    Behind& behind = *thread;
    try {
      lead(frames, feed, expected, options, [&](Piece piece) { return behind.put(std::move(piece)); });
      behind.finish();
    } catch (const Enough&) {
      behind.finish();
    } catch (const std::exception&) {
      // A frame that cannot be made is as far as it goes; a difference before it counts, however far behind.
      behind.finish();
      if (comparer.report().same) throw;
    }
  } else {
    try {
      lead(frames, feed, expected, options, [&](Piece piece) { return comparer.take(std::move(piece)); });
    } catch (const Enough&) {
    }
  }
  if (comparer.report().frames == 0 && !comparer.report().broken) throw Error("no frame to compare");
  comparer.commit();
  return std::move(comparer.report());
}

}  // namespace kage::cosim
