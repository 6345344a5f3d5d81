// SPDX-License-Identifier: Apache-2.0
//
// The frame stream: tokens to words, words to tokens, stream files. The contract is docs/stream.md.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kage/defs.hpp"

namespace kage {

/// A span with depth: OP, SP and TP. Colour is used by OP and TP only.
struct SpanToken {
  int xl = 0;
  int xr = 0;                            ///< half open, xl <= xr <= width
  std::int64_t z = 0;                    ///< at xl, Z_FRAC fraction bits, half an LSB included
  std::int64_t dz = 0;                   ///< per pixel
  int w = 0;                             ///< SP: signed multiplicity
  int normal_class = 0;                  ///< OP: 0 is unlit; without a table 1 is lit, with one the table's class
  std::array<std::int32_t, 3> color{};   ///< at xl, COLOR_FRAC fraction bits with SMOOTH, else 0 .. 255
  std::array<std::int32_t, 3> dcolor{};  ///< SMOOTH: per pixel
  int alpha = 0;                         ///< TP: 0 (not to be seen) .. 255 (opaque)
};

/// FACE and SEG: an entry of a unit's face table, and a run of pixels of one face (docs/stream.md, "Units and the
/// tree").
struct SegmentToken {
  int unit = 0;
  int face = 0;                         ///< SEG: 2^FACE_BITS - 1 is blank
  std::int64_t z = 0;                   ///< SEG: at the first pixel, as a span's; not for blank ones
  int dx = 0;                           ///< SEG: pixels, at least 1
  bool sync = false;                    ///< SEG: first of its unit's line
  int index = 0;                        ///< FACE: draw index of the polyhedron
  int normal_class = 0;                 ///< FACE: as OP's
  std::int64_t dz = 0;                  ///< FACE: depth per pixel
  std::array<std::int32_t, 3> color{};  ///< FACE: 0 .. 255
};

/// TABLE: what a pixel of a class loses for each shadowed sample of a light.
struct TableToken {
  int normal_class = 0;                  ///< 1 .. 2^CLASS_BITS - 1
  int light = 0;                         ///< 0 .. LIGHTS - 1
  std::array<std::uint32_t, 3> share{};  ///< of each channel, in 2^-SHADE_FRAC, at most 2^SHADE_FRAC
};

/// Writes tokens of one configuration to the end of a vector of words. The caller sees to order and to what the
/// fields mean (check_frame() judges both). A value that its field cannot hold is never cut: Error names token, field
/// and value, and the words are as they were. The class is left out where the configuration has no shadows.
class TokenWriter {
 public:
  TokenWriter(const Config& config, std::vector<std::uint32_t>& out);

  /// Go on writing elsewhere.
  void write_to(std::vector<std::uint32_t>& out) { out_ = &out; }

  void header(const FrameHeader& header);
  void shade(std::uint32_t shade);
  void table(const TableToken& entry);
  void face(const SegmentToken& face);
  void seg(const SegmentToken& segment);
  void tree();
  void op(const SpanToken& span);
  void sp(const SpanToken& span);
  void nc(int xl, int xr, int w);
  void inside(int w);  ///< IF
  void ev(int xl, int xr);
  void es(int xl, int xr, int light);
  void resolve();
  void tp(const SpanToken& span);
  void eol(int y);
  void end();

 private:
  template <Kind K, class T>
  void pack(const T& token);

  Config config_;
  Layout layout_;
  std::vector<std::uint32_t>* out_;
};

/// Any token, decoded. `span.xl`, `span.xr` and `span.w` are also those of NC, IF, EV and ES.
struct Token {
  Kind kind{};
  SpanToken span;
  SegmentToken segment;  ///< FACE and SEG
  TableToken table;      ///< TABLE; its light is also that of ES
  std::uint32_t shade = 0;
  int y = 0;  ///< EOL
};

/// Decode the token that starts at `words[0]`; `words` must hold it whole.
Token decode(const Config& config, const Layout& layout, std::span<const std::uint32_t> words);

/// The same for one token after the other: fields that its kind does not have in this configuration stay as they are.
void decode(const Config& config, const Layout& layout, std::span<const std::uint32_t> words, Token& token);

/// One line that says what the token is: "OP [12, 40) z 123.5 dz -0.25 color 10,20,30 lit".
std::string to_string(const Config& config, const Token& token);

/// Count of each kind of token, and words.
struct TokenCounts {
  std::array<std::uint64_t, 16> of_kind{};
  std::uint64_t words = 0;
  std::uint64_t spans = 0;        ///< OP, SP, NC, TP
  std::uint64_t span_pixels = 0;  ///< pixels in them
  int units = 0;                  ///< units with faces; of several frames, the most

  TokenCounts& operator+=(const TokenCounts& other);
};

/// Checks a frame whose words come in pieces, as strictly as a file is: every field in its range, order of tokens, bits
/// past the last field zero, no span whose depth or colour overflows its accumulator. On a fault feed() or finish()
/// throws Error that names frame, line, token and byte offset; `where` opens the message and `offset` is that of the
/// first word.
class FrameChecker {
 public:
  FrameChecker(const Config& config, std::string where, std::uint64_t offset);
  ~FrameChecker();
  FrameChecker(const FrameChecker&) = delete;
  FrameChecker& operator=(const FrameChecker&) = delete;

  void feed(std::span<const std::uint32_t> words);

  /// After the last words: the counts.
  TokenCounts finish(FrameHeader* header = nullptr);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// The same for a frame whose words are all there.
TokenCounts check_frame(const Config& config, std::span<const std::uint32_t> words, const std::string& where,
                        std::uint64_t offset, FrameHeader* header = nullptr);

class TempFiles;

/// Writes a stream file. A file appears under its name only when finish() has succeeded; otherwise what was there
/// stays. A pipe or a device gets each section once it is whole, a frame at a time: what it got of a stream that failed
/// lacks the last section, DONE, so that no reader takes it for whole. Every error of writing is thrown as Error.
class StreamFileWriter {
 public:
  StreamFileWriter(const std::filesystem::path& path, const Config& config);
  /// Writes to the open file `fd` as to a pipe, and leaves it open. `name` is what messages call it.
  StreamFileWriter(int fd, const std::string& name, const Config& config);
  ~StreamFileWriter();
  StreamFileWriter(const StreamFileWriter&) = delete;
  StreamFileWriter& operator=(const StreamFileWriter&) = delete;

  /// A frame in pieces: begin_frame(), its words, end_frame(). No piece is kept.
  void begin_frame();
  /// A frame as a port may bring it, sound or not (section PORT): a reader does not check it.
  void begin_port_frame();
  void words(std::span<const std::uint32_t> words);
  void end_frame();

  /// A frame whose words are all there.
  void frame(std::span<const std::uint32_t> words);

  /// Where the frames come from, as JSON text (docs/stream.md, Files): once, after the last frame. Cores ignore it.
  void origin(const std::string& json);

  /// Ends the file, which gets its name now, or, the second way, with the others of `files` (ref/file/temp_file.hpp).
  void finish();
  void finish(TempFiles& files);

 private:
  struct Data;
  StreamFileWriter(std::unique_ptr<Data> data, const Config& config);
  std::unique_ptr<Data> data_;
};

/// A section of a stream file that is neither the configuration, a frame nor the end: ORIG, or one that this reader
/// does not know.
struct StreamSection {
  std::string tag;           ///< four characters; those that cannot be printed are ?
  int frames_before = 0;     ///< frames in the file before it
  std::string_view payload;  ///< valid as long as the file is open
};

/// A stream file, mapped: another program must not make it shorter while it is open. Where one does, what is gone
/// raises SIGBUS on reading, in frame() or in the words it gave, and a program that wants to outlive that has to handle
/// the signal (kage does, see cli/mapped.hpp). Opening checks magic, version, configuration and the list of sections;
/// frame() checks the section's checksum and the frame's tokens.
class StreamFile {
 public:
  explicit StreamFile(const std::filesystem::path& path);
  ~StreamFile();
  StreamFile(StreamFile&&) noexcept;
  StreamFile& operator=(StreamFile&&) noexcept;

  [[nodiscard]] const Config& config() const;
  [[nodiscard]] int frame_count() const;
  /// Whether frame `index` is as a port may bring it (section PORT): nothing in it has been checked but its checksum.
  [[nodiscard]] bool is_port_frame(int index) const;
  [[nodiscard]] std::uint64_t bytes() const;

  /// The text that StreamFileWriter::origin() took, or nothing.
  [[nodiscard]] const std::string& origin() const;

  /// All sections but configuration, frames and end, in the file's order.
  [[nodiscard]] std::vector<StreamSection> sections() const;

  /// Frame `index` has been read: its pages need not stay in memory. Its words stay valid, and are read again from the
  /// file where they are used once more. Without this a file that is read through comes to be in memory whole.
  void leave(int index) const;

  /// Words of frame `index`, valid as long as this object. Checked on every call; counts are added to `counts` if
  /// given.
  [[nodiscard]] std::span<const std::uint32_t> frame(int index, TokenCounts* counts = nullptr) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// The tokens of a frame that may break any rule, one after the other. The walk ends behind END, at the first word that
/// begins no token, at a token that the frame's end cuts, or at the frame's end; nothing past that is read.
class TokenWalk {
 public:
  /// `layout` and `words`, which begin with the header, must outlive the walk.
  TokenWalk(const Layout& layout, std::span<const std::uint32_t> words);

  /// The words of the next token; none where the walk has ended.
  [[nodiscard]] std::span<const std::uint32_t> peek() const;

  /// The same, and the walk goes on behind them.
  std::span<const std::uint32_t> next();

  /// What has not been walked over.
  [[nodiscard]] std::span<const std::uint32_t> rest() const { return rest_; }

  /// What the rest of an ended walk is: "2 words behind END", "kind 0, which is no token here", "OP of 5 words, cut
  /// after 2"; nothing where there is none.
  [[nodiscard]] std::string rest_text() const;

 private:
  const Layout* layout_;
  std::span<const std::uint32_t> rest_;
  bool ended_ = false;  // by END
};

/// Words as they are: "0x00000006 0x0000001f".
std::string words_text(std::span<const std::uint32_t> words);

/// What the words of a frame, sound or not, have of tokens, as far as a TokenWalk goes.
TokenCounts count_tokens(const Config& config, std::span<const std::uint32_t> words);

/// True if the file begins like a stream file.
bool is_stream_file(const std::filesystem::path& path);

}  // namespace kage
