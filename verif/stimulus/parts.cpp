// SPDX-License-Identifier: Apache-2.0
#include "stimulus/parts.hpp"

#include <utility>

#include "stimulus/damage.hpp"

namespace kage::verif {

Parts apart(const Config& config, const Words& words) {
  const Layout layout(config);
  Parts p;
  TokenWalk walk(layout, words);
  p.header.assign(words.begin(), words.end() - static_cast<std::ptrdiff_t>(walk.rest().size()));
  for (auto token = walk.next(); !token.empty(); token = walk.next()) p.tokens.emplace_back(token.begin(), token.end());
  p.rest.assign(walk.rest().begin(), walk.rest().end());
  return p;
}

Words together(const Parts& parts) {
  Words words = parts.header;
  for (const Words& t : parts.tokens) words.insert(words.end(), t.begin(), t.end());
  words.insert(words.end(), parts.rest.begin(), parts.rest.end());
  return words;
}

SegmentPlaces::Place SegmentPlaces::next(const SegmentToken& s) {
  const auto unit = static_cast<std::size_t>(s.unit);
  if (units_.size() <= unit) units_.resize(unit + 1);
  Place& next = units_[unit];
  const Place place = next;
  next.x += static_cast<std::uint32_t>(s.dx);
  if (next.x >= width_) next = {place.line + 1, 0};
  return place;
}

Words only_lines(const Config& config, const Words& words, const std::function<bool(std::size_t line)>& keeps) {
  const Layout layout(config);
  Parts p = apart(config, words);
  std::vector<Words> left;
  std::size_t line = 0;
  std::size_t gone = 0;
  bool state = true;  // what stands before the first line stays
  SegmentPlaces segments(p.header);
  for (Words& t : p.tokens) {
    state = state && info_of(kind_of(t[0])).state;
    const std::size_t of = is(t, Kind::SEG) ? segments.next(decode(config, layout, t).segment).line : line;
    const bool goes = !state && !is(t, Kind::END) && !keeps(of);
    if (is(t, Kind::EOL)) {
      ++line;
      if (goes) ++gone;
    }
    if (!goes) left.push_back(std::move(t));
  }
  p.tokens = std::move(left);
  if (gone == 0 || p.header.size() < 2) return together(p);
  FrameHeader h = FrameHeader::read(p.header);
  if (static_cast<std::size_t>(h.height) <= gone) return words;
  h.height -= static_cast<int>(gone);
  h.write(p.header);
  Words made = together(p);
  TokenPlaces places(config, made);
  std::uint64_t y = 0;
  for (const TokenPlaces::At at : places.of(Kind::EOL)) places.put(at, layout.eol_y, y++);
  return made;
}

}  // namespace kage::verif
