// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "contract/kinds.hpp"
#include "kage/stream_diff.hpp"
#include "number/counted.hpp"
#include "stream/field_diff.hpp"
#include "stream/span_frame.hpp"

namespace kage {
namespace {

using Words = std::span<const std::uint32_t>;

/// Tokens that belong together: a frame's state, a line with its EOL, or what stands behind the lines.
struct Group {
  std::uint64_t first = 0;  // number of its first token
  std::vector<Words> tokens;
};

/// A frame's groups, one after the other. The frame may break any rule: a line may lack its EOL, and words that are no
/// token count as one, the last.
class GroupReader {
 public:
  GroupReader(const Layout& layout, Words frame) : walk_(layout, frame) {}

  /// The frame's state; may be none.
  void state(Group& group) {
    start(group);
    while (info_of(kind()).state) take(group);
  }

  /// The next line; false behind the last one.
  bool line(Group& group) {
    start(group);
    while (!walk_.peek().empty() && kind() != Kind::END) {
      const bool last = kind() == Kind::EOL;
      take(group);
      if (last) break;
    }
    return !group.tokens.empty();
  }

  /// Behind the last line: END, then the words that are no token; either may be missing.
  void end(Group& group) {
    start(group);
    if (kind() == Kind::END) take(group);
    if (!walk_.rest().empty()) group.tokens.push_back(walk_.rest());
  }

 private:
  /// Kind of the next token; 0, which is no kind, where there is none.
  [[nodiscard]] Kind kind() const {
    const Words token = walk_.peek();
    return token.empty() ? Kind{} : kind_of(token[0], walk_.level());
  }

  void start(Group& group) const {
    group.first = number_;
    group.tokens.clear();
  }

  void take(Group& group) {
    group.tokens.push_back(walk_.next());
    ++number_;
  }

  TokenWalk walk_;
  std::uint64_t number_ = 1;  // 0 is the header
};

bool equal(Words a, Words b) { return std::equal(a.begin(), a.end(), b.begin(), b.end()); }

class FrameComparer {
 public:
  /// `config` is that of the frame at the polygon level, if one of them is at the other level.
  FrameComparer(const Config& config, int frame, Words a, Words b) : config_(config), a_(a), b_(b) {
    diff_.frame = frame;
    if (level(a) == level(b)) return;
    const bool expand_a = level(a) == Level::polygons;
    const auto spans = span_frame(config, expand_a ? a : b);
    if (!spans) return;
    spans_ = *spans;
    (expand_a ? a_ : b_) = spans_;
    diff_.expanded = true;
  }

  FrameDiff run() {
    diff_.same = equal(a_, b_);
    if (diff_.same) return diff_;
    header();
    GroupReader reader_a(layout_, a_);
    GroupReader reader_b(layout_, b_);
    Group ga;
    Group gb;
    reader_a.state(ga);
    reader_b.state(gb);
    (void)group(ga, gb, {});
    for (int line = 0;; ++line) {
      const bool in_a = reader_a.line(ga);
      const bool in_b = reader_b.line(gb);
      if (!in_a && !in_b) break;
      if (group(ga, gb, line)) ++diff_.different_lines;
    }
    reader_a.end(ga);
    reader_b.end(gb);
    (void)group(ga, gb, {});
    return diff_;
  }

 private:
  void header() {
    const auto field = [&](const char* name, const std::string& in_a, const std::string& in_b) {
      if (in_a != in_b) found({}, 0, name, in_a, in_b);
    };
    const Words in_a = a_.first(std::min<std::size_t>(a_.size(), kHeaderWords));
    const Words in_b = b_.first(std::min<std::size_t>(b_.size(), kHeaderWords));
    if (equal(in_a, in_b)) return;
    ++diff_.different_tokens;
    if (in_a.size() < kHeaderWords || in_b.size() < kHeaderWords)
      return field("header", words_text(in_a), words_text(in_b));
    const FrameHeader a = FrameHeader::read(a_);
    const FrameHeader b = FrameHeader::read(b_);
    field("magic_version", fmt::format("{:#010x}", a_[0]), fmt::format("{:#010x}", b_[0]));
    field("width", fmt::format("{} pixels", a.width), fmt::format("{} pixels", b.width));
    field("height", fmt::format("{} lines", a.height), fmt::format("{} lines", b.height));
    field("param_hash", fmt::format("{:#010x}", a.param_hash), fmt::format("{:#010x}", b.param_hash));
    field("background", fmt::format("{:#08x}", a.background), fmt::format("{:#08x}", b.background));
    field("frame", fmt::format("frame number {}", a.frame), fmt::format("frame number {}", b.frame));
  }

  /// True if the groups differ.
  bool group(const Group& a, const Group& b, std::optional<int> line) {
    const auto [at_a, at_b] = std::mismatch(a.tokens.begin(), a.tokens.end(), b.tokens.begin(), b.tokens.end(), equal);
    if (at_a == a.tokens.end() && at_b == b.tokens.end()) return false;
    const auto same_before = static_cast<std::size_t>(at_a - a.tokens.begin());
    const auto [end_a, end_b] = std::mismatch(a.tokens.rbegin(), std::make_reverse_iterator(at_a), b.tokens.rbegin(),
                                              std::make_reverse_iterator(at_b), equal);
    const auto left_a = std::make_reverse_iterator(at_a) - end_a;
    const auto left_b = std::make_reverse_iterator(at_b) - end_b;
    diff_.different_tokens += static_cast<std::uint64_t>(std::max(left_a, left_b));
    const Words ta = at_a == a.tokens.end() ? Words() : *at_a;
    const Words tb = at_b == b.tokens.end() ? Words() : *at_b;
    if (!diff_.first) found(line, a.first + same_before, field(ta, tb), words(ta, level(a_)), words(tb, level(b_)));
    return true;
  }

  void found(std::optional<int> line, std::uint64_t token, std::string field, std::string a, std::string b) {
    if (!diff_.first) diff_.first = StreamPlace{diff_.frame, line, token, std::move(field), std::move(a), std::move(b)};
  }

  /// Whether words are one token whole. Those behind END may be by chance, and are told as that token then.
  [[nodiscard]] bool is_token(Words words, Level level) const {
    return !words.empty() && layout_.words_of(words[0], level) == words.size();
  }

  [[nodiscard]] static Level level(Words frame) { return FrameHeader::read(frame).level(); }

  [[nodiscard]] std::string words(Words token, Level level) const {
    constexpr std::size_t kTold = 8;
    if (token.empty()) return "nothing";
    if (is_token(token, level)) return to_string(config_, decode(config_, layout_, token, level));
    return fmt::format("{} no token: {}{}", counted(token.size(), "word that is", "words that are"),
                       words_text(token.first(std::min(token.size(), kTold))), token.size() > kTold ? " ..." : "");
  }

  /// The first field in which two unequal tokens differ.
  [[nodiscard]] std::string field(Words a, Words b) const {
    if (a.empty() || b.empty()) return "token";
    const Level of_a = level(a_);
    const Level of_b = level(b_);
    if (!is_token(a, of_a) || !is_token(b, of_b)) return "words";
    if (of_a != of_b && kind_of(a[0], of_a) != kind_of(b[0], of_b)) return "kind";
    const std::optional<FieldDiff> in_field = first_field_diff(config_, layout_, a, b, of_a);
    return in_field ? in_field->name : "bits behind the last field";  // which are zero in checked frames
  }

  const Config& config_;
  Layout layout_{config_};
  std::vector<std::uint32_t> spans_;  // what polygons come to, where the other frame has none
  Words a_;
  Words b_;
  FrameDiff diff_;
};

/// The same words, which only one of the streams holds to be sound.
FrameDiff unlike_sections(int frame, bool a_is_port) {
  FrameDiff diff;
  diff.frame = frame;
  const auto text = [](bool port) { return port ? "PORT: a frame that is not checked" : "FRAM: a sound frame"; };
  diff.first = StreamPlace{frame, {}, 0, "section", text(a_is_port), text(!a_is_port)};
  return diff;
}

/// A frame that only one of the streams has.
FrameDiff lone_frame(int frame, const TokenCounts& counts, bool in_a) {
  FrameDiff diff;
  diff.frame = frame;
  diff.different_lines = counts.of_kind[static_cast<std::size_t>(Kind::EOL)];
  diff.different_tokens =
      std::accumulate(counts.of_kind.begin(), counts.of_kind.end(), std::uint64_t{1});  // the header
  const std::string text = fmt::format("a frame of {} lines", diff.different_lines);
  diff.first = StreamPlace{frame, {}, 0, "frame", in_a ? text : "nothing", in_a ? "nothing" : text};
  return diff;
}

std::vector<StreamDiff::Section> diff_sections(const std::vector<StreamSection>& a,
                                               const std::vector<StreamSection>& b) {
  std::vector<StreamDiff::Section> found;
  std::vector<bool> taken(b.size());
  for (const StreamSection& s : a) {
    std::size_t k = 0;
    while (k < b.size() && (taken[k] || b[k].tag != s.tag)) ++k;
    if (k == b.size()) {
      found.push_back({s.tag, "only in A"});
      continue;
    }
    taken[k] = true;
    if (b[k].payload != s.payload)
      found.push_back({s.tag, "contents"});
    else if (b[k].frames_before != s.frames_before)
      found.push_back({s.tag, "place among the frames"});
  }
  for (std::size_t k = 0; k < b.size(); ++k)
    if (!taken[k]) found.push_back({b[k].tag, "only in B"});
  return found;
}

std::string reason_of(const StreamDiff& d) {
  std::vector<std::string> parts;
  if (!d.parameters.empty()) {
    const StreamDiff::Parameter& p = d.parameters.front();
    parts.push_back(fmt::format("configurations are unlike: {} is {} and {}", p.name, p.a, p.b));
    if (d.parameters.size() > 1) parts.back() += fmt::format(", and {} more", d.parameters.size() - 1);
  }
  const int common = std::min(d.frames_a, d.frames_b);
  const int lone = std::abs(d.frames_a - d.frames_b);
  if (lone != 0) parts.push_back(fmt::format("A has {} and B {}", counted(d.frames_a, "frame"), d.frames_b));
  // Only frames that both have: the text above already says that the others differ.
  if (const auto unlike = d.different_frames - static_cast<std::uint64_t>(lone); unlike != 0)
    parts.push_back(fmt::format("{} of {} frames {}{}", unlike, common, lone != 0 ? "that both have " : "",
                                unlike == 1 ? "differs" : "differ"));
  for (const StreamDiff::Section& s : d.sections) parts.push_back(fmt::format("section {} differs: {}", s.tag, s.how));
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

}  // namespace

constexpr std::string_view kActiveName = "ACTIVE";

StreamDiff diff_streams(const StreamFile& a, const StreamFile& b, const std::function<void(const FrameDiff&)>& each) {
  StreamDiff d;
  d.frames_a = a.frame_count();
  d.frames_b = b.frame_count();
  d.tokens_compared = true;
  for (const ParamInfo& p : kParams) {
    if (a.config().*(p.member) == b.config().*(p.member)) continue;
    d.parameters.push_back({std::string(p.name), a.config().*(p.member), b.config().*(p.member)});
    d.tokens_compared = d.tokens_compared && !p.affects_pixels;
  }
  for (int i = 0; i < std::max(d.frames_a, d.frames_b); ++i) {
    TokenCounts counts;
    const Words in_a = i < d.frames_a ? a.frame(i, &counts) : Words();
    const Words in_b = i < d.frames_b ? b.frame(i, &counts) : Words();
    const bool both = i < d.frames_a && i < d.frames_b;
    FrameDiff frame;
    frame.frame = i;
    frame.same = true;
    if (!both)
      frame = lone_frame(i, counts, i < d.frames_a);
    else if (d.tokens_compared)
      frame = FrameComparer(b.config().active > a.config().active ? b.config() : a.config(), i, in_a, in_b).run();
    if (both && d.tokens_compared && frame.same && a.is_port_frame(i) != b.is_port_frame(i))
      frame = unlike_sections(i, a.is_port_frame(i));
    frame.compared = !both || d.tokens_compared;
    if (frame.expanded) ++d.expanded_frames;
    if (!frame.same) ++d.different_frames;
    d.different_lines += frame.different_lines;
    d.different_tokens += frame.different_tokens;
    if (!d.first) d.first = frame.first;
    if (each) each(frame);
    if (i < d.frames_a) a.leave(i);
    if (i < d.frames_b) b.leave(i);
  }
  // Spans that polygons come to are the same whatever ACTIVE is.
  if (d.expanded_frames > 0)
    std::erase_if(d.parameters, [](const StreamDiff::Parameter& p) { return p.name == kActiveName; });
  d.sections = diff_sections(a.sections(), b.sections());
  d.reason = reason_of(d);
  d.same = d.reason.empty();
  return d;
}

}  // namespace kage
