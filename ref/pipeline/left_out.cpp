// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "contract/kinds.hpp"
#include "kage/provenance.hpp"

namespace kage {
namespace {

/// A token of a pixel, as both frames have it: its place among the others differs, and its range may.
using Name = std::pair<Kind, std::string>;

Name name_of(const PixelTouch& t, const ToldHistory& of) {
  if (t.what.kind == Kind::ES) return {t.what.kind, std::to_string(t.what.table.light)};
  const auto from = of.from->find(t.nth);
  return {t.what.kind, from == of.from->end() ? std::string() : from->second.text()};
}

int volume_of(const PixelTouch& t, const ToldHistory& of) {
  const auto from = of.from->find(t.nth);
  return from == of.from->end() ? -1 : from->second.volume;
}

bool is_front(Kind kind) { return info_of(kind).volume && !info_of(kind).depth && kind != Kind::EV; }

std::string why_left_out(const PixelTouch& t, bool in_front) {
  const bool nearer = t.z && *t.z < t.before.z;
  switch (t.what.kind) {
    case Kind::OP:
      return nearer ? "hidden by one that follows" : "hidden by one before, or by the tree";
    case Kind::TP:
      return "not before what is drawn";
    case Kind::SP:
      if (!nearer) return "not before what is drawn";
      break;
    default:
      break;
  }
  if (in_front) return "before all that receives this shadow: part of its front";
  return "no pixel of the line that takes this shadow is changed";
}

}  // namespace

std::string LeftOut::text() const {
  return fmt::format("{} {}: {}", tokens, kKindNames[static_cast<std::size_t>(kind)], why);
}

std::vector<LeftOut> left_out(const ToldHistory& all, const ToldHistory& kept) {
  std::map<Name, std::uint32_t> there;
  std::set<int> fronts;
  for (const PixelTouch& t : kept.history->touches) {
    ++there[name_of(t, kept)];
    if (is_front(t.what.kind)) fronts.insert(volume_of(t, kept));
  }
  std::vector<LeftOut> found;
  for (const PixelTouch& t : all.history->touches) {
    const auto same = there.find(name_of(t, all));
    if (same != there.end() && same->second > 0) {
      --same->second;
      continue;
    }
    const std::string why = why_left_out(t, fronts.contains(volume_of(t, all)));
    const auto alike = std::find_if(found.begin(), found.end(),
                                    [&](const LeftOut& l) { return l.kind == t.what.kind && l.why == why; });
    if (alike != found.end())
      ++alike->tokens;
    else
      found.push_back({t.what.kind, 1, why});
  }
  return found;
}

}  // namespace kage
