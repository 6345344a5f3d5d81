// SPDX-License-Identifier: Apache-2.0
#include "cosim/report/token_store.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "contract/kinds.hpp"
#include "kage/error.hpp"

namespace kage::report {

std::string base64(std::span<const std::uint8_t> data) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((data.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < data.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, data.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < n; ++k) group |= static_cast<std::uint32_t>(data[i + k]) << (16 - 8 * k);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

TokenStore::TokenStore(const Config& config, std::size_t budget)
    : config_(config),
      layout_(config),
      spans_(config),
      counter_(config),
      budget_(budget),
      file_(std::tmpfile(), std::fclose),
      writer_(config, raw_) {
  if (!file_)
    throw Error(
        fmt::format("the report: no temporary file can be made: {}; --no-report goes without", std::strerror(errno)));
}

std::string TokenStore::text(const Band& band) const {
  std::string text(band.bytes, '\0');
  if (std::fseek(file_.get(), static_cast<long>(band.offset), SEEK_SET) != 0 ||
      std::fread(text.data(), 1, text.size(), file_.get()) != text.size())
    throw Error("the report: its temporary file cannot be read");
  return text;
}

void TokenStore::begin(int frame) {
  cutter_.start();
  header_ = true;
  broken_ = false;
  line_ = 0;
  ahead_.assign(static_cast<std::size_t>(config_.units), {});
  band_.frame = frame;
  open_band(-1, 1);
  if (frames_.size() <= static_cast<std::size_t>(frame)) frames_.resize(static_cast<std::size_t>(frame) + 1);
  frames_.back() = {};
}

void TokenStore::words(std::span<const std::uint32_t> piece) {
  if (broken_) return;
  cutter_.feed(piece);
  if (header_) {
    const auto words_of_header = cutter_.take(kHeaderWords);
    if (words_of_header.empty()) return;
    const FrameHeader h = FrameHeader::read(words_of_header);
    header_ = false;
    width_ = h.width;
    level_ = h.level();
    band_.indexed = level_ == Level::polygons;
    spans_.start(h);
    counter_.start(width_);
    frames_.back().background = h.background;
    frames_.back().tokens = 1;
    // A core refuses such a frame, and a front end has no spans of that width.
    broken_ = width_ > config_.max_width;
    if (broken_) return;
  }
  while (const std::uint32_t* first = cutter_.peek()) {
    const std::size_t n = layout_.words_of(*first, level_);
    // A word that begins no token ends the frame for a core; the page has the tokens before it.
    broken_ = n == 0;
    if (broken_) return;
    const auto body = cutter_.take(n);
    if (body.empty()) return;
    token(body);
    if (broken_) return;
  }
}

void TokenStore::token(std::span<const std::uint32_t> words) {
  decode(config_, layout_, words, t_, level_);
  const std::uint32_t index = frames_.back().tokens++;
  const ErrorCode error =
      spans_.add(t_, [&](const Token& t, bool made) { span_token(index, t, made || t.kind != t_.kind); });
  if (phase_of(t_.kind) == Phase::polygons) counter_.polygon_token();
  if (t_.kind == Kind::SEG) segment(index, words);
  if (t_.kind == Kind::TREE) tree();
  broken_ = t_.kind == Kind::END || error != ErrorCode::NONE;
  if (t_.kind != Kind::EOL || ++line_ % kBandLines != 0) return;
  close_band();
  open_band(line_, index + 1);
}

// A token of the span level, of which the page tells a pixel's history.
void TokenStore::span_token(std::uint32_t index, const Token& t, bool made) {
  counter_.token(t);
  // The state ends with the first token that is of a line.
  if (band_.line < 0 && !info_of(t.kind).state) {
    close_band();
    open_band(0, index);
  }
  if (full_) return;
  if (band_.indexed) raw_.push_back(index | (made ? kMade : 0));
  writer_.token(t);
}

void TokenStore::segment(std::uint32_t index, std::span<const std::uint32_t> words) {
  const auto unit = static_cast<std::size_t>(t_.segment.unit);
  if (unit < ahead_.size()) ahead_[unit].push_back({index, {words.begin(), words.end()}, t_.segment.dx});
}

// A unit's SEGs of a line sum to the width.
void TokenStore::tree() {
  for (auto& unit : ahead_)
    for (int sum = 0; sum < width_ && !unit.empty(); unit.pop_front()) sum += unit.front().dx;
}

void TokenStore::open_band(int line, std::uint32_t token) {
  band_.line = line;
  band_.token = token;
  band_.ahead = 0;
  band_.indexed = level_ == Level::polygons;
  raw_.clear();
  for (const auto& unit : ahead_)
    for (const Segment& s : unit) {
      if (band_.indexed) raw_.push_back(s.index);
      raw_.insert(raw_.end(), s.words.begin(), s.words.end());
      ++band_.ahead;
    }
}

void TokenStore::close_band() {
  if (full_ || frames_.back().tokens == 0 || (wanted_ && !wanted_(band_.frame, band_.line))) return;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(raw_.size() * 4);
  for (const std::uint32_t w : raw_)
    for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(w >> shift));
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), Z_BEST_SPEED) != Z_OK)
    throw Error("the report's tokens: zlib cannot pack them");
  packed.resize(size);
  keep(band_, base64(packed));
}

void TokenStore::keep(Band band, const std::string& text) {
  full_ = bytes_ + text.size() > budget_;
  if (full_) return;
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size())
    throw Error(fmt::format("the report: its temporary file cannot be written: {}; --no-report goes without",
                            std::strerror(errno)));
  band.offset = bytes_;
  band.bytes = text.size();
  bytes_ += text.size();
  bands_.push_back(band);
}

void TokenStore::append(const TokenStore& later, std::size_t frames) {
  std::size_t end = 0;  // the number of the first frame that is too many
  for (; end < later.frames_.size() && frames > 0; ++end) frames -= later.frames_[end].tokens > 0 ? 1 : 0;
  if (frames_.size() < end) frames_.resize(end);
  for (std::size_t i = 0; i < end; ++i)
    if (later.frames_[i].tokens > 0) frames_[i] = later.frames_[i];
  for (const Band& band : later.bands_)
    if (static_cast<std::size_t>(band.frame) < end && !full_) keep(band, later.text(band));
  full_ = full_ || later.full_;
}

void TokenStore::end() {
  // After the last line comes END alone, which does nothing to a pixel.
  const bool lines_left = band_.line != line_ || t_.kind != Kind::END;
  if (!raw_.empty() && lines_left) close_band();
  frames_.back().phases = counter_.sums();
}

}  // namespace kage::report
