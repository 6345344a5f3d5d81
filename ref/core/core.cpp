// SPDX-License-Identifier: Apache-2.0
// Frame control: header, order of tokens, errors, and the lines of a frame.
#include "kage/core.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "core/line_parts.hpp"
#include "kage/token.hpp"
#include "polygon/span_tokens.hpp"
#include "stream/cutter.hpp"

namespace kage {

struct GoldenCore::Data {
  explicit Data(const Config& c) : config(c), layout(c), parts(c), spans(c), writer(c, made_words) {}

  /// Where in a frame the core is.
  enum class At { header, lines, ended, failed };

  Config config;
  Layout layout;
  LineView::Parts parts;
  WordCutter cutter;
  std::vector<std::uint8_t> out;
  Token t;           // the one at hand
  SpanTokens spans;  // that tokens come to
  std::vector<std::uint32_t> made_words;
  TokenWriter writer;  // of what the front end makes, for the observer
  CoreObserver* observer = nullptr;

  // State of the current frame:
  FrameStatus status;
  At at = At::header;
  std::uint32_t number = 0;
  std::uint32_t token = 0;  // the next one
  std::uint64_t taken = 0;  // words of tokens that came whole
  std::uint64_t came = 0;   // words

  /// The error of a header that arrived whole.
  [[nodiscard]] ErrorCode check_header(const FrameHeader& h) const {
    if (!h.known() || (h.level() == Level::polygons && config.active == 0)) return ErrorCode::HEADER;
    if (h.width < 1 || h.width > config.max_width || h.height < 1 || h.height > kMaxHeight) return ErrorCode::SIZE;
    return h.param_hash == param_hash(config) ? ErrorCode::NONE : ErrorCode::PARAMS;
  }

  void apply(const Token& done) {
    switch (done.kind) {
      case Kind::SHADE:
        parts.pixels.set_shade(done.shade);
        break;
      case Kind::TABLE:
        parts.pixels.add_share(done.table);
        break;
      case Kind::FACE:
        parts.tree.add_face(done.segment);
        break;
      case Kind::SEG:
        if (parts.rules.outcome().taken) parts.tree.add_segment(done.segment);
        break;
      case Kind::TREE:
        parts.pixels.tree(parts.tree.take_line(observer != nullptr));
        break;
      case Kind::OP:
        parts.pixels.op(done.span);
        break;
      case Kind::SP:
        parts.pixels.sp(done.span);
        break;
      case Kind::TP:
        parts.pixels.tp(done.span);
        break;
      case Kind::NC:
        parts.pixels.nc(done.span.xl, done.span.xr, done.span.w);
        break;
      case Kind::IF:
        parts.pixels.inside(done.span.w);
        break;
      case Kind::EV:
        parts.pixels.ev(done.span.xl, done.span.xr);
        break;
      case Kind::ES:
        parts.pixels.es(done.span.xl, done.span.xr, done.table.light);
        break;
      case Kind::RESOLVE:
        parts.pixels.resolve(done.samples);
        break;
      default:
        break;
    }
  }

  void emit(int y, bool blank, const LineSink& sink) {
    parts.pixels.finish(blank, out);
    sink(y, out);
  }

  void start() {
    status = {};
    at = At::header;
    number = token = 0;
    taken = came = 0;
    cutter.start();
  }

  /// The frame's error; the lines that have not ended are background.
  void fail(ErrorCode e, const LineSink& sink, std::span<const std::uint32_t> words = {}) {
    const bool lines = at == At::lines;
    at = At::failed;
    status.error = e;
    status.frame = number;
    status.line = lines ? static_cast<std::uint32_t>(parts.rules.line()) : 0;
    status.token = token;
    if (observer != nullptr) observer->failed(status, words, view());
    if (!lines) return;
    for (int y = parts.rules.line(); y < status.height; ++y) emit(y, true, sink);
  }

  void header(std::span<const std::uint32_t> h, const LineSink& sink) {
    const FrameHeader read = FrameHeader::read(h);
    number = read.frame;
    if (const ErrorCode e = check_header(read); e != ErrorCode::NONE) return fail(e, sink);
    status.width = read.width;
    status.height = read.height;
    parts.rules.start(config, status.width, status.height);
    parts.pixels.start(status.width, read.background);
    parts.tree.start(status.width);
    spans.start(read);
    out.resize(static_cast<std::size_t>(status.width) * static_cast<std::size_t>(config.channels));
    taken = kHeaderWords;
    token = 1;
    at = At::lines;
    if (observer != nullptr) observer->header(h, view());
  }

  void feed(std::span<const std::uint32_t> piece, const LineSink& sink) {
    came += piece.size();
    if (at == At::ended || at == At::failed) return;
    cutter.feed(piece);
    if (at == At::header) {
      const auto h = cutter.take(kHeaderWords);
      if (h.empty()) return;
      header(h, sink);
    }
    while (at == At::lines) {
      const std::uint32_t* first = cutter.peek();
      if (first == nullptr) return;
      const std::size_t n = layout.words_of(*first, spans.level());
      if (n == 0) return fail(ErrorCode::KIND, sink, std::span(first, 1));
      const auto body = cutter.take(n);
      if (body.empty()) return;
      decode(config, layout, body, t, spans.level());
      if (observer != nullptr && spans.level() == Level::polygons) observer->came(token, t, body);
      const ErrorCode e = spans.add(t, [&](const Token& of_spans, bool made) {
        const bool as_it_came = !made && of_spans.kind == t.kind;
        return take(of_spans, as_it_came ? body : std::span<const std::uint32_t>(), sink);
      });
      if (e != ErrorCode::NONE) {
        if (parts.rules.fault().code != ErrorCode::NONE) {
          status.unit = parts.rules.fault().unit;
          token = parts.rules.fault().token;
        }
        return fail(e, sink, body);
      }
      if (at == At::ended) return;
      taken += n;
      ++token;
    }
  }

  /// A token of the span level: what is wrong with it, or it has done what it does. One that the front end makes has no
  /// words of the stream.
  ErrorCode take(const Token& next, std::span<const std::uint32_t> words, const LineSink& sink) {
    if (const ErrorCode e = parts.rules.accept(next, token); e != ErrorCode::NONE) return e;
    if (observer != nullptr) observer->before(token, next, words.empty() ? words_of(next) : words, view());
    if (next.kind == Kind::END) {
      at = At::ended;
      return ErrorCode::NONE;
    }
    if (next.kind == Kind::EOL)
      emit(next.y, false, sink);
    else
      apply(next);
    if (observer != nullptr) observer->after(token, next, view());
    return ErrorCode::NONE;
  }

  /// The words of a token that the front end has made and the rules have taken.
  std::span<const std::uint32_t> words_of(const Token& made) {
    made_words.clear();
    writer.token(made);
    return made_words;
  }

  [[nodiscard]] LineView view() const { return LineView(parts); }

  FrameStatus finish(const LineSink& sink) {
    const auto beat = static_cast<std::uint64_t>(config.beat_words);
    constexpr std::array<std::uint32_t, kGreatest.beat_words> kFill{};
    feed(std::span(kFill).first((beat - came % beat) % beat), sink);
    if (at == At::header || at == At::lines) {
      const std::uint32_t* first = at == At::lines ? cutter.peek() : nullptr;
      fail(ErrorCode::LAST_EARLY, sink, std::span(first, first != nullptr ? 1 : 0));
    } else if (at == At::ended && taken / beat != came / beat - 1) {
      status.error = ErrorCode::LAST_LATE;  // all lines have left
      status.frame = number;
      status.line = static_cast<std::uint32_t>(parts.rules.line());
      status.token = token;
      if (observer != nullptr) observer->failed(status, {}, view());
    }
    const FrameStatus result = status;
    start();
    return result;
  }
};

GoldenCore::GoldenCore(const Config& config) : data_(std::make_unique<Data>(config)) {}
GoldenCore::~GoldenCore() = default;
GoldenCore::GoldenCore(GoldenCore&&) noexcept = default;
GoldenCore& GoldenCore::operator=(GoldenCore&&) noexcept = default;

void GoldenCore::observe(CoreObserver* observer) { data_->observer = observer; }

LineView GoldenCore::line() const { return data_->view(); }

void GoldenCore::feed(std::span<const std::uint32_t> words, const LineSink& sink) { data_->feed(words, sink); }

FrameStatus GoldenCore::finish(const LineSink& sink) { return data_->finish(sink); }

FrameStatus GoldenCore::frame(std::span<const std::uint32_t> words, const LineSink& sink) {
  data_->start();
  data_->feed(words, sink);
  return data_->finish(sink);
}

std::string describe(const FrameStatus& status) {
  const auto code = static_cast<std::size_t>(status.error);
  if (status.error == ErrorCode::NONE) return "no error";
  return fmt::format("{} at line {}, token {}: {}", kErrorNames[code], status.line, status.token, kErrorTexts[code]);
}

}  // namespace kage
