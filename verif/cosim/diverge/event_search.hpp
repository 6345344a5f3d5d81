// SPDX-License-Identifier: Apache-2.0
//
// One frame's events: those that the golden core says must come, against those that the RTL gives, as they come.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cosim/diverge/blame.hpp"
#include "cosim/diverge/expected_events.hpp"
#include "cosim/mismatch.hpp"
#include "kage/core.hpp"

namespace kage::cosim {

/// Told of each event and what was expected in its place.
using Watch = std::function<void(const ExpectedEvent&, const kage_rtl_event&)>;

/// Call feed() with the frame's words and take() with the RTL's events, in any order: events of the side that is ahead
/// are kept. Call finish() when the frame has ended, then end().
class EventSearch : private CoreObserver {
 public:
  /// With `watch`, nothing stops at a difference. `unwatched`: as RtlCore has it. Where tokens are not watched, which
  /// of two differences comes first is taken from their clocks, and is less sure.
  explicit EventSearch(const Config& config, std::uint32_t unwatched = 0, Watch watch = {});

  void feed(std::span<const std::uint32_t> words);
  void finish();
  void take(std::span<const kage_rtl_event> events);

  /// Nothing more will come: what is still expected is missing. With `blocked`, events of units and tree that are
  /// missing do not count: they wait for the pixels, which are to blame.
  void end(std::uint64_t clock, bool blocked);

  /// Number of the golden core's events that are kept until the RTL does its part, and would be missing if it did not.
  /// Events of the video do not count: after an error they are all the rest of the frame, at once.
  [[nodiscard]] std::size_t pending();

  /// The first in the order of tokens and stages, of those seen by now; none if unexpected() comes before it.
  [[nodiscard]] std::optional<Mismatch> first() const { return unexpected_leads() ? std::nullopt : first_; }
  /// First RTL event that matches no expected event.
  [[nodiscard]] const std::optional<kage_rtl_event>& unexpected() const { return unexpected_; }
  /// The first small module that broke its own contract.
  [[nodiscard]] const std::optional<kage_rtl_event>& part() const { return part_; }
  /// Whether something differed more than so many clocks ago.
  [[nodiscard]] bool seen_before(std::uint64_t clock, std::uint64_t ago) const;
  /// Known facts of first(), or else of unexpected().
  [[nodiscard]] Clue clue() const;

 private:
  // Events of the golden core.
  void header(std::span<const std::uint32_t> words, const LineView& line) override;
  void came(std::uint32_t index, const Token& token, std::span<const std::uint32_t> words) override;
  void before(std::uint32_t index, const Token& token, std::span<const std::uint32_t> words,
              const LineView& line) override;
  void after(std::uint32_t index, const Token& token, const LineView& line) override;
  void failed(const FrameStatus& status, std::span<const std::uint32_t> words, const LineView& line) override;

  LineSink sink();
  void offer(const Mismatch& m);
  void take(const kage_rtl_event& a);
  void take_error(std::deque<ExpectedEvent>& q, const kage_rtl_event& a);
  void stop(Stage stage, int unit);
  /// Whether the unexpected event comes before the first mismatch in the order of tokens and stages.
  [[nodiscard]] bool unexpected_leads() const;
  [[nodiscard]] bool stopped(const kage_rtl_event& a) const;
  /// Whether a segment is what frame_control's token has.
  [[nodiscard]] bool is_token(const kage_rtl_event& segment) const;

  Watch watch_;
  Config config_;
  ExpectedEvents expected_;
  bool tokens_watched_;
  GoldenCore golden_;
  std::vector<Kind> kinds_;  // of each token but the header, the one that is wrong included
  bool polygons_ = false;    // the frame is at the polygon level: those are the tokens that came in
  std::array<bool, kStages> stopped_{};
  std::vector<bool> stopped_columns_;
  std::optional<Mismatch> first_;
  std::optional<kage_rtl_event> unexpected_;
  std::uint32_t unexpected_token_ = 0;  // the last that frame_control had taken then
  std::optional<kage_rtl_event> part_;
  std::uint32_t tokens_ = 0;  // that the RTL's frame_control has taken
  std::uint32_t height_ = 0;
  bool ended_ = false;
  bool again_ = false;                 // as in Clue
  bool of_token_ = false;              // likewise
  kage_rtl_event token_{};             // the last that came
  bool at_last_ = false;               // what token_reader said of END
  std::vector<kage_rtl_event> ahead_;  // what came before it can be known whether it should
  std::uint64_t seen_;                 // clock of the earliest difference
};

}  // namespace kage::cosim
