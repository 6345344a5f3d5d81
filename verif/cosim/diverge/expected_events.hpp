// SPDX-License-Identifier: Apache-2.0
//
// The events that the RTL's stages must give for a frame, made of what the golden core does.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contract/derived.hpp"
#include "cosim/diverge/stages.hpp"
#include "kage/core.hpp"
#include "kage/stream.hpp"

namespace kage::cosim {

/// One event, and where in the frame it belongs.
struct ExpectedEvent {
  Stage stage{};
  int unit = 0;             ///< an expansion unit's number, a pixel's x; of a pixel that leaves, 1: its line's last
  int line = 0;             ///< lines that had ended
  std::uint32_t token = 0;  ///< index of the token it comes of
  /// The same as frame_control counts, for which a front end makes some; of an error the token that shows it.
  std::uint32_t nth = 0;
  int step = 0;             ///< order among the events of a token: those of a later step follow from earlier ones
  int x = -1;               ///< the pixel, where it is of one
  bool load = false;        ///< a command, or what it does, that brings a colour back
  std::uint32_t cares = 0;  ///< bit i: value i matters
  std::array<std::uint64_t, KAGE_RTL_EVENT_VALUES> value{};
  /// Value i is to be this, or matters as it is, or does not matter.
  void expect(int i, std::uint64_t v) {
    value[static_cast<std::size_t>(i)] = v;
    look_at(i);
  }
  void look_at(int i) { cares |= 1U << i; }
  void ignore(int i) { cares &= ~(1U << i); }

  int masked = -1;  ///< of this value only the bits of `mask` matter
  std::uint64_t mask = ~std::uint64_t{0};
};

/// Feeds on a golden core: events gather in queues as it works. One queue a stage, but one a unit and one a pixel's
/// column, because the RTL works on those beside each other.
class ExpectedEvents : public CoreObserver {
 public:
  /// Without those of stages that nothing watches: a bit for each, RtlCore::unwatched().
  explicit ExpectedEvents(const Config& config, std::uint32_t unwatched = 0);

  /// Its queue; empty if nothing is expected. `unit` as in the event.
  std::deque<ExpectedEvent>& queue(Stage stage, int unit);

  /// Calls `each` with every queue that is not empty.
  template <class Each>
  void for_each(Each each) {
    for (auto& queues : queues_)
      for (auto& q : queues)
        if (!q.empty()) each(q);
  }

  /// Expected event for a token at which the RTL must not report an error.
  [[nodiscard]] static ExpectedEvent no_error(int line, std::uint32_t token);

  /// Whether the frame has an error. From it on the dropped tokens and the lost line are not compared.
  [[nodiscard]] bool failed() const { return failed_; }

  /// The token at which the error shows, as frame_control counts them; none before it is dropped.
  [[nodiscard]] std::uint32_t failed_at() const { return failed_at_; }

  /// The golden core has ended the frame.
  void ended();

  /// A line has left the golden core.
  void line(int y, std::span<const std::uint8_t> pixels);

  void header(std::span<const std::uint32_t> words, const LineView& line) override;
  void before(std::uint32_t index, const Token& token, std::span<const std::uint32_t> words,
              const LineView& line) override;
  void after(std::uint32_t index, const Token& token, const LineView& line) override;
  void failed(const FrameStatus& status, std::span<const std::uint32_t> words, const LineView& line) override;

 private:
  struct Leaving {
    std::uint64_t color = 0;
    bool covered = false;
    bool dark = false;
    std::uint64_t normal_class = 0;
    std::uint64_t counts = 0;
  };

  // The order of a token's events. A line that goes out and comes back has its own steps behind those of the token.
  enum Step {
    of_token,
    of_control,
    of_unit,
    of_tree,
    of_command,
    of_pixel,
    of_exit,
    of_load,
    of_load_command,
    of_loaded,
    of_out,
    of_end
  };

  static std::uint64_t low(std::int64_t value, int bits) {
    return static_cast<std::uint64_t>(value) & (bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1);
  }
  static int number(Kind kind) { return static_cast<int>(kind); }

  ExpectedEvent event(Stage stage, int step) const;
  void put(ExpectedEvent e);
  [[nodiscard]] bool watched(Stage stage) const { return (unwatched_ >> static_cast<unsigned>(stage) & 1U) == 0; }
  /// The event that was put() last into a queue, so that more can be said of it. For a stage that no monitor watches,
  /// an event that nobody reads.
  ExpectedEvent& newest(Stage stage, int unit);
  void token_words(std::span<const std::uint32_t> words, bool final);
  void wrong_token(ErrorCode code, bool header, std::span<const std::uint32_t> words);
  void command(int kind, int xl, int xr, int step);
  void span_command(const Token& t, const LineView& line);
  void table_event(const TableToken& t);
  void face_event(const SegmentToken& f);
  void segment_event(const SegmentToken& s);
  void tree_events(const LineView& line);
  void came_to_pixel(int x, std::optional<std::uint64_t> z, std::optional<std::uint64_t> color);
  void touch(int kind, int x, const PixelState& after, int step);
  [[nodiscard]] int kind_of_command(Kind kind) const;

  // Events of a whole line: expected_line.cpp.
  void state(std::uint64_t bias, bool matters);
  void paint(const LineView& line);
  void load_back(int x, const PixelState& s);
  [[nodiscard]] PixelState painted(const PixelState& before) const;
  void end_line(const LineView* line);
  void line_event(bool blank, bool load, int step);
  void leave(const std::vector<Leaving>& pixels, bool blank);
  [[nodiscard]] Leaving leaving(const PixelState& s, bool resolved) const;
  [[nodiscard]] std::vector<Leaving> all_leaving(const LineView& line) const;

  [[nodiscard]] bool clear(const PixelState& s) const { return s.z == derived::clear_depth(config_); }
  [[nodiscard]] std::uint64_t held(const std::array<std::uint16_t, 3>& color) const;

  Config config_;
  std::uint32_t unwatched_;
  ExpectedEvent nowhere_;
  int depth_bits_;
  int ramp_bits_;
  std::array<std::vector<std::deque<ExpectedEvent>>, kStages> queues_;

  // State of the frame:
  bool failed_ = false;
  std::uint32_t failed_at_ = 0;
  int width_ = 0;
  int height_ = 0;
  int y_ = 0;                // lines that have ended
  std::uint32_t token_ = 0;  // the one at hand
  std::uint32_t nth_ = 0;    // likewise, as frame_control counts
  std::uint64_t background_ = 0;
  std::uint64_t shade_ = 0;
  std::vector<int> given_;  // pixels of the line that a unit is being given

  // State of the line:
  std::optional<std::uint64_t> pass_;  // behind a RESOLVE of linear light: what a light's command has as its count
  bool resolved_ = false;
  bool painted_ = false;
  std::uint64_t bias_ = 0;                                          // of the last that had one
  std::vector<Leaving> before_resolve_;                             // what was there when RESOLVE came
  std::vector<std::pair<std::uint32_t, std::uint32_t>> eol_token_;  // of each line, and its nth
};

}  // namespace kage::cosim
