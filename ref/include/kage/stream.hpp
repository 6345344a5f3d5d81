// SPDX-License-Identifier: Apache-2.0

/// @file
/// The frame stream: checking and walking a frame's words, and stream files; token.hpp has the tokens. The contract is
/// docs/stream.md.
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
#include "kage/token.hpp"

namespace kage {

/// Count of each kind of token, and words.
struct TokenCounts {
  std::array<std::uint64_t, kKinds> of_kind{};  ///< tokens, by Kind
  std::uint64_t words = 0;                      ///< of 32 bits, the header's among them
  std::uint64_t spans = 0;                      ///< OP, SP, NC, TP, and those that the front end makes
  std::uint64_t made = 0;                       ///< of `spans` those that the front end makes of polygons
  std::uint64_t span_pixels = 0;                ///< pixels in them
  int units = 0;                                ///< units with faces; of several frames, the most
  int active = 0;  ///< polygons at once, which ACTIVE must hold; of several frames, the most

  /// Adds those of another frame.
  /// @param other its counts
  /// @return the sum
  TokenCounts& operator+=(const TokenCounts& other);
};

/// Checks a frame whose words come in pieces, as strictly as a file is. Fields must be in range and tokens in order,
/// bits past the last field zero, and no span may overflow its depth or colour accumulator. On a fault feed() or
/// finish()
/// throws Error that names frame, line, token and byte offset; `where` opens the message and `offset` is that of the
/// first word.
class FrameChecker {
 public:
  /// Checks a frame from its header on.
  /// @param config a legal configuration
  /// @param where opens the messages
  /// @param offset of the first word in its file, in bytes
  FrameChecker(const Config& config, std::string where, std::uint64_t offset);
  ~FrameChecker();
  FrameChecker(const FrameChecker&) = delete;
  FrameChecker& operator=(const FrameChecker&) = delete;

  /// Checks as much as has come. Throws Error on a fault.
  /// @param words those that follow
  void feed(std::span<const std::uint32_t> words);

  /// The frame's words have all come. Throws Error on a fault.
  /// @param header filled if given
  /// @return counts of the tokens
  TokenCounts finish(FrameHeader* header = nullptr);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Checks a frame whose words are all there. Throws Error on a fault.
/// @param config a legal configuration
/// @param words the whole frame
/// @param where opens the messages
/// @param offset of the first word in its file, in bytes
/// @param header filled if given
/// @return counts of the tokens
TokenCounts check_frame(const Config& config, std::span<const std::uint32_t> words, const std::string& where,
                        std::uint64_t offset, FrameHeader* header = nullptr);

/// Writes a stream file. A file appears under its name only when finish() has succeeded; otherwise an older file stays.
/// A pipe or a device gets each section once it is whole, a frame at a time. If the stream fails, it never gets the
/// last section, DONE, so no reader takes the stream for whole. Every error of writing is thrown as Error.
class StreamFileWriter {
 public:
  /// Begins a file.
  /// @param path its name, or a pipe or a device
  /// @param config that of the frames, legal
  StreamFileWriter(const std::filesystem::path& path, const Config& config);
  /// Writes to an open file as to a pipe, and leaves it open.
  /// @param fd the open file
  /// @param name what messages call it
  /// @param config that of the frames, legal
  StreamFileWriter(int fd, const std::string& name, const Config& config);
  ~StreamFileWriter();
  StreamFileWriter(const StreamFileWriter&) = delete;
  StreamFileWriter& operator=(const StreamFileWriter&) = delete;

  /// Begins a frame in pieces: words() and end_frame() follow. No piece is kept.
  void begin_frame();
  /// Begins a frame as a port may bring it, sound or not (section PORT): a reader does not check it.
  void begin_port_frame();
  /// A piece of the frame that was begun.
  /// @param words those that follow
  void words(std::span<const std::uint32_t> words);
  /// Ends the frame that was begun.
  void end_frame();

  /// A frame whose words are all there.
  /// @param words the whole frame
  void frame(std::span<const std::uint32_t> words);

  /// Says where the frames come from (docs/stream-files.md): once, after the last frame. Cores ignore it.
  /// @param json text
  void origin(const std::string& json);

  /// Ends the file, which gets its name now.
  void finish();

 private:
  friend struct StreamFileWriterInside;  // how the library itself names a file together with others
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

/// A stream file, mapped: another program must not make it shorter while it is open. If one does, reading the lost
/// part, in frame() or in the words it gave, raises SIGBUS; a program that must survive this handles the signal.
/// Opening checks magic, version, configuration and the list of sections; frame() checks the section's checksum and the
/// frame's tokens.
class StreamFile {
 public:
  /// Opens a file. Throws Error that names file and place where magic, version, configuration or the list of sections
  /// are not right.
  /// @param path its name
  explicit StreamFile(const std::filesystem::path& path);
  ~StreamFile();
  StreamFile(StreamFile&&) noexcept;
  StreamFile& operator=(StreamFile&&) noexcept;

  /// @return that of the frames, legal
  [[nodiscard]] const Config& config() const;
  /// @return how many frames the file has
  [[nodiscard]] int frame_count() const;
  /// Whether a frame is as a port may bring it (section PORT): nothing in it has been checked but its checksum.
  /// @param index 0 .. frame_count() - 1
  /// @return true if it is
  [[nodiscard]] bool is_port_frame(int index) const;
  /// @return the file's length
  [[nodiscard]] std::uint64_t bytes() const;

  /// @return the text that StreamFileWriter::origin() took, or nothing
  [[nodiscard]] const std::string& origin() const;

  /// @return all sections but configuration, frames and end, in the file's order
  [[nodiscard]] std::vector<StreamSection> sections() const;

  /// A frame has been read: its pages need not stay in memory. Its words stay valid, and are read again from the file
  /// where they are used once more. Without this a file that is read through comes to be in memory whole.
  /// @param index 0 .. frame_count() - 1
  void leave(int index) const;

  /// Words of a frame, checked on every call. Throws Error that names file, frame, line, token and byte offset on a
  /// fault.
  /// @param index 0 .. frame_count() - 1
  /// @param counts those of the frame are added, if given
  /// @return the words, valid as long as this object
  [[nodiscard]] std::span<const std::uint32_t> frame(int index, TokenCounts* counts = nullptr) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// The tokens of a frame that may break any rule, one after the other. The walk ends behind END, at the first word that
/// begins no token, at a token that the frame's end cuts, or at the frame's end; nothing past that is read.
class TokenWalk {
 public:
  /// A walk from the first token behind the header.
  /// @param layout must outlive the walk
  /// @param words begin with the header, and must outlive the walk
  TokenWalk(const Layout& layout, std::span<const std::uint32_t> words);

  /// @return the words of the next token; none where the walk has ended
  [[nodiscard]] std::span<const std::uint32_t> peek() const;

  /// Goes on behind the next token.
  /// @return its words; none where the walk has ended
  std::span<const std::uint32_t> next();

  /// @return what the frame's tokens are, by its header
  [[nodiscard]] Level level() const { return level_; }

  /// @return what has not been walked over
  [[nodiscard]] std::span<const std::uint32_t> rest() const { return rest_; }

  /// Puts in words what the rest of an ended walk is.
  /// @return "2 words behind END", "kind 0, which is no token here", "OP of 5 words, cut after 2"; nothing where there
  /// is none
  [[nodiscard]] std::string rest_text() const;

 private:
  const Layout* layout_;
  Level level_;
  std::span<const std::uint32_t> rest_;
  bool ended_ = false;  // by END
};

/// Writes words as they are.
/// @param words any
/// @return "0x00000006 0x0000001f"
std::string words_text(std::span<const std::uint32_t> words);

/// Counts what the words of a frame, sound or not, have of tokens, as far as a TokenWalk goes.
/// @param config that of the words
/// @param words the whole frame
/// @return counts of the tokens
TokenCounts count_tokens(const Config& config, std::span<const std::uint32_t> words);

/// Looks at how a file begins.
/// @param path any file
/// @return true if it begins like a stream file
bool is_stream_file(const std::filesystem::path& path);

}  // namespace kage
