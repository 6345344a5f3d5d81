// SPDX-License-Identifier: Apache-2.0
//
// Coverage by frames of all that a configuration has: kinds of tokens, borders and extremes of their fields, errors.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/stream.hpp"

namespace kage::verif {

/// Something that a frame may have or not.
struct CoveragePoint {
  std::string group;         ///< "token", "span", "depth", "error", ...
  std::string name;          ///< "OP ends at a group's border"
  std::uint64_t frames = 0;  ///< that had it
};

/// Counts, by what the golden core does with the frames' words.
class Coverage : private CoreObserver {
 public:
  /// For frames at that level.
  explicit Coverage(const Config& config, Level level = Level::spans);

  /// A frame, its words in pieces.
  void words(std::span<const std::uint32_t> piece);
  void end_frame();

  /// Adds the counts of other frames.
  void absorb(const Coverage& other);

  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  /// All that the configuration has, reached or not, in the order of the groups.
  [[nodiscard]] const std::vector<CoveragePoint>& points() const { return points_; }

 private:
  /// A point's index; none where the configuration has no such thing.
  struct Point {
    std::size_t index = ~std::size_t{0};
  };
  struct Span {
    Point none, one, whole, at_border, in_group, ends_at_border;
  };
  struct Ramp {
    Point under, over, wraps, level;
  };

  Point add(bool there, const std::string& group, const std::string& name);
  Span add_span(bool there, const std::string& kind, bool whole);
  Ramp add_ramp(bool there, const std::string& group, const std::string& what);
  void hit(Point point, bool is = true) {
    if (is && point.index < seen_.size()) seen_[point.index] = true;
  }
  void hit_span(const Span& points, const SpanToken& s, int width);
  /// A value at each of `count` pixels: `fraction` bits of it are cut off, what is left is clamped to least .. most.
  struct Range {
    int bits;  // of the accumulator
    int fraction;
    std::int64_t least, most;
  };
  [[nodiscard]] Range depth_range() const;
  [[nodiscard]] Range color_range() const;
  void hit_ramp(const Ramp& points, std::int64_t start, std::int64_t step, int count, const Range& range);

  void header(std::span<const std::uint32_t> words, const LineView& line) override;
  void before(std::uint32_t index, const Token& token, std::span<const std::uint32_t> words,
              const LineView& line) override;
  void came(std::uint32_t index, const Token& token, std::span<const std::uint32_t> words) override;
  void after(std::uint32_t index, const Token& token, const LineView& line) override;
  void failed(const FrameStatus& status, std::span<const std::uint32_t> words, const LineView& line) override;
  void made(Kind kind);
  void ramps(const SpanToken& s, bool colored);
  void opaque(const SpanToken& s, const LineView& line);
  void light(const SpanToken& s, const LineView& line);
  void volume(const Token& t, const LineView& line);
  void translucent(const SpanToken& s, const LineView& line);
  [[nodiscard]] bool in_shadow(const PixelState& p, std::uint32_t bias) const;
  [[nodiscard]] std::uint64_t half_sum() const;
  [[nodiscard]] std::uint64_t lost(const PixelState& p, std::size_t channel) const;
  void resolve(const LineView& line);
  void segment(const SegmentToken& s);
  void tree(const LineView& line);
  void frame_state();

  Config config_;
  GoldenCore golden_;
  std::vector<CoveragePoint> points_;
  std::vector<bool> seen_;  // in the frame at hand, by point
  std::uint64_t frames_ = 0;
  bool any_words_ = false;

  // State of the frame:
  bool state_told_ = false;  // what came before the first line
  bool shade_ = false;
  std::vector<TableToken> table_;
  std::vector<std::vector<std::int64_t>> faces_;  // dz, of each unit
  std::vector<int> segments_;                     // of the unit's line at hand
  bool has_spans_ = false;                        // the line at hand
  bool volume_ = false;                           // its last token was of a volume, or ended one
  int lights_ = 0;                                // its RESOLVEs of linear light
  int samples_ = 0;                               // that the last one told
  int waits_ = 0;                                 // edges that a POLYGON waits for
  bool gradient_ = false;                         // it has had a GRADIENT
  int end_ = 0;                                   // one past the frame's last line
  Kind came_{};                                   // at the polygon level the stream's token

  std::array<Point, kKinds> kind_{};
  std::array<Span, kKinds> span_{};
  std::array<Point, kErrorNames.size()> error_{};
  Ramp depth_{}, face_depth_{}, color_{};
  Point tie_{}, behind_{}, unlit_{}, last_class_{};
  Point light_early_{}, light_again_{}, light_tie_{}, light_most_{}, light_few_{};
  Point one_wide_{}, widest_{}, one_line_{}, bare_line_{};
  Point shade_none_{}, shade_zero_{}, shade_some_{}, shade_most_{};
  Point table_none_{}, table_whole_{}, table_cut_{}, share_most_{}, black_{}, half_sum_{}, counter_full_{};
  Point weight_plus_{}, weight_minus_{}, weight_other_{}, inside_at_ev_{}, bias_at_ev_{}, dark_{};
  Point alpha_none_{}, alpha_some_{}, alpha_all_{}, over_clear_{}, over_surface_{}, hidden_{};
  Point edge_later_{}, edge_last_{}, edge_left_{}, edge_right_{}, edge_tie_{}, whole_cap_{}, plain_{}, of_spans_{};
  Point made_at_polygon_{}, made_at_edge_{}, made_at_span_{}, made_at_eol_{};
  Point unit_tie_{}, index_tie_{}, blank_{}, dx_one_{}, dx_most_{}, unit_full_{}, last_face_{};
};

}  // namespace kage::verif
