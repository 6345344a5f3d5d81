// SPDX-License-Identifier: Apache-2.0

/// @file
/// Tokens: from values to words, and back. The contract is docs/stream.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kage/defs.hpp"

namespace kage {

/// A span with depth: OP, SP and TP. Colour is used by OP and TP only. Ranges are those of the fields; check_frame()
/// refuses depths and colours that leave theirs before the span's last pixel.
struct SpanToken {
  int xl = 0;  ///< its first pixel
  int xr = 0;  ///< half open, xl <= xr <= width
  /// At xl, in 2^-Z_FRAC, half an LSB included: -2^(Z_BITS + Z_FRAC + 1) .. 2^(Z_BITS + Z_FRAC + 1) - 1.
  std::int64_t z = 0;
  std::int64_t dz = 0;  ///< per pixel, in the unit and the range of `z`
  int w = 0;            ///< SP: signed multiplicity, -2^DSF_BITS .. 2^DSF_BITS - 1
  int normal_class =
      0;  ///< OP: 0 is unlit; without a table 1 is lit, with one the table's class; not with linear light
  /// By channel, at xl: with SMOOTH in 2^-COLOR_FRAC, half an LSB included, -2^(COLOR_FRAC + 9) .. 2^(COLOR_FRAC + 9) -
  /// 1; else 0 .. 255.
  std::array<std::int32_t, 3> color{};
  std::array<std::int32_t, 3> dcolor{};  ///< SMOOTH: per pixel, in the unit and the range of `color`
  int alpha = 0;                         ///< TP: 0 (not to be seen) .. 255 (opaque)
};

/// FACE and SEG: an entry of a unit's face table, and a run of pixels of one face (docs/stream.md, "Units and the
/// tree").
struct SegmentToken {
  int unit = 0;          ///< 0 .. UNITS - 1
  int face = 0;          ///< SEG: 2^FACE_BITS - 1 is blank
  std::int64_t z = 0;    ///< SEG: at the first pixel, as a span's; not for blank ones
  int dx = 0;            ///< SEG: pixels, at least 1
  bool sync = false;     ///< SEG: first of its unit's line
  int index = 0;         ///< FACE: draw index of the polyhedron
  int normal_class = 0;  ///< FACE: as OP's
  std::int64_t dz = 0;   ///< FACE: depth per pixel
  /// FACE: 0 .. 255, or with linear light 0 .. 2^LINEAR_BITS - 1.
  std::array<std::int32_t, 3> color{};
};

/// TABLE: what a pixel of a class loses for each shadowed sample of a light.
struct TableToken {
  int normal_class = 0;                  ///< 1 .. 2^CLASS_BITS - 1
  int light = 0;                         ///< 0 .. LIGHTS - 1
  std::array<std::uint32_t, 3> share{};  ///< of each channel, in 2^-SHADE_FRAC, at most 2^SHADE_FRAC
};

/// POLYGON, EDGE, GRADIENT and AT (docs/stream.md, "The polygon level"). The look of a POLYGON, its weight and its
/// alpha are those of Token::span, the light of an AT that of Token::table.
struct PolygonToken {
  /// POLYGON: depth at pixel 0 of the line above its first, in 2^-24 LSB, modulo 2^(Z_BITS + 2) LSB. GRADIENT: colour
  /// likewise, modulo 2^10.
  std::int64_t value = 0;
  std::int64_t right = 0;  ///< its slope a pixel, in the unit and the range of `value`
  std::int64_t down = 0;   ///< its slope a line, likewise
  int channel = 0;         ///< GRADIENT: 0 .. CHANNELS - 1
  int side = 0;            ///< EDGE: 0 goes down as the polygon's outline goes round, 1 goes up
  bool last = false;       ///< EDGE: the polygon ends where the edge ends
  int top_x = 0;           ///< EDGE: its upper end, in 1/256 pixel, -2^23 .. 2^23 - 1
  int top_y = 0;           ///< EDGE: likewise
  int bottom_x = 0;        ///< EDGE: its lower end, likewise
  int bottom_y = 0;        ///< EDGE: likewise
  int layer = 0;           ///< AT: 0 opaque, 1 volumes, 2 translucent
  int sample = 0;          ///< AT: of light, 0 .. 2^11 - 1
  int volume = 0;          ///< AT: in its sample, 0 .. 2^18 - 1
  int rank = 0;            ///< AT: in its volume, 0 .. 2^14 - 1
};

struct Token;

/// Writes tokens of one configuration to the end of a vector of words. The caller sees to order and to what the
/// fields mean (check_frame() judges both). A value that its field cannot hold is never cut: Error names token, field
/// and value, and the words are as they were. The class is left out where the configuration has no shadows.
class TokenWriter {
 public:
  /// Writes behind what is there.
  /// @param config a legal configuration
  /// @param out must outlive the writer, or its use
  TokenWriter(const Config& config, std::vector<std::uint32_t>& out);

  /// Goes on writing elsewhere.
  /// @param out must outlive the writer, or its use
  void write_to(std::vector<std::uint32_t>& out) { out_ = &out; }

  /// The frame's first words. Throws Error if width or height is not 0 .. 65535.
  /// @param header its fields, but for param_hash: that of the writer's configuration is written
  void header(const FrameHeader& header);
  /// SHADE.
  /// @param shade share of its colour that a pixel in shadow loses, 0 .. 2^SHADE_FRAC
  void shade(std::uint32_t shade);
  /// TABLE.
  /// @param entry what it says
  void table(const TableToken& entry);
  /// FACE.
  /// @param face what it says
  void face(const SegmentToken& face);
  /// SEG.
  /// @param segment what it says
  void seg(const SegmentToken& segment);
  void tree();  ///< TREE
  /// OP.
  /// @param span what it says
  void op(const SpanToken& span);
  /// SP.
  /// @param span what it says
  void sp(const SpanToken& span);
  /// NC.
  /// @param xl its first pixel
  /// @param xr one past its last
  /// @param w signed multiplicity
  void nc(int xl, int xr, int w);
  /// IF.
  /// @param w signed multiplicity
  void inside(int w);
  /// EV.
  /// @param xl its first pixel
  /// @param xr one past its last
  void ev(int xl, int xr);
  /// ES.
  /// @param xl its first pixel
  /// @param xr one past its last
  /// @param light 0 .. LIGHTS - 1
  void es(int xl, int xr, int light);
  /// RESOLVE.
  /// @param samples of the light whose opaque spans follow, with linear light and counters; left out otherwise
  void resolve(int samples = 0);
  /// TP.
  /// @param span what it says
  void tp(const SpanToken& span);
  /// EOL.
  /// @param y number of the line, from 0
  void eol(int y);
  void end();  ///< END
  /// AT.
  /// @param place what it says
  /// @param light of the place
  void at(const PolygonToken& place, int light);
  /// POLYGON.
  /// @param plane value, right and down
  /// @param look colour by channel, 0 .. 255; class, w and alpha, which are left out where the configuration has none
  void polygon(const PolygonToken& plane, const SpanToken& look);
  /// EDGE.
  /// @param edge what it says
  void edge(const PolygonToken& edge);
  /// GRADIENT.
  /// @param plane what it says
  void gradient(const PolygonToken& plane);
  /// A token of any kind.
  /// @param token what it says
  void token(const Token& token);

 private:
  template <Kind K, class T>
  void pack(const T& token);

  Config config_;
  Layout layout_;
  std::vector<std::uint32_t>* out_;
};

/// Any token, decoded. `span.xl`, `span.xr` and `span.w` are also those of NC, IF, EV and ES.
struct Token {
  Kind kind{};              ///< which token it is
  SpanToken span;           ///< OP, SP, NC, IF, EV, ES and TP; of a POLYGON the look
  SegmentToken segment;     ///< FACE and SEG
  TableToken table;         ///< TABLE; its light is also that of ES and AT
  PolygonToken polygon;     ///< POLYGON, EDGE, GRADIENT and AT
  std::uint32_t shade = 0;  ///< SHADE: 0 .. 2^SHADE_FRAC
  int samples = 0;          ///< RESOLVE with linear light and counters: of the light, 0 .. 2^COUNT_BITS - 1
  int y = 0;                ///< EOL
};

/// Decodes a token.
/// @param config that of the words
/// @param layout of the same configuration
/// @param words hold the token whole, from `words[0]` on
/// @param level of its frame
/// @return the token
Token decode(const Config& config, const Layout& layout, std::span<const std::uint32_t> words,
             Level level = Level::spans);

/// The same for one token after the other: fields that its kind does not have in this configuration stay as they are.
/// @param config that of the words
/// @param layout of the same configuration
/// @param words hold the token whole, from `words[0]` on
/// @param token gets what they say
/// @param level of its frame
void decode(const Config& config, const Layout& layout, std::span<const std::uint32_t> words, Token& token,
            Level level = Level::spans);

/// Says in one line what the token is.
/// @param config that of the token
/// @param token of any kind
/// @return "OP [12, 40) z 123.5 dz -0.25 color 10,20,30 lit"
std::string to_string(const Config& config, const Token& token);

}  // namespace kage
