// SPDX-License-Identifier: Apache-2.0
#include "extremes/fill_rule_checks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kage/frontend.hpp"
#include "oracle/oracle.hpp"

namespace kage::verif {
namespace {

/// The pixels of polygons, as kage scans them.
class Scanned {
 public:
  Scanned(int width, int height, const Context& context) : hits_(width, height), context_(&context) {}
  Scanned& add(const Outline& o) {
    hits_.add(o, context_->injected(Injection::wide_span) ? 1 : 0);
    return *this;
  }
  [[nodiscard]] const Hits& hits() const { return hits_; }

 private:
  Hits hits_;
  const Context* context_;
};

/// Box of an outline within a picture: columns from x0 up to but not x1, lines from y0 up to but not y1.
struct Box {
  int x0, y0, x1, y1;
};

Box box_of(const Outline& o, int width, int height) {
  const auto xs = std::minmax_element(o.begin(), o.end(), [](auto& a, auto& b) { return a.x < b.x; });
  const auto ys = std::minmax_element(o.begin(), o.end(), [](auto& a, auto& b) { return a.y < b.y; });
  const auto in = [](int v, int size) { return std::clamp(v, 0, size); };
  return {in((xs.first->x >> 8) - 1, width), in((ys.first->y >> 8) - 1, height), in((xs.second->x >> 8) + 2, width),
          in((ys.second->y >> 8) + 2, height)};
}

/// How often the oracle has each pixel in some outlines.
std::vector<int> owners(const std::vector<Outline>& outlines, int width, int height) {
  std::vector<int> count(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (const Outline& o : outlines) {
    const Box b = box_of(o, width, height);
    for (int y = b.y0; y < b.y1; ++y)
      for (int x = b.x0; x < b.x1; ++x)
        if (Oracle::winding(o, x, y) != 0) ++count[pixel_index(x, y, width)];
  }
  return count;
}

}  // namespace

Outcome parts_are_whole(const std::vector<Outline>& parts, const Outline& whole, int width, int height,
                        const Context& context) {
  Outcome o;
  Scanned scanned(width, height, context);
  for (const Outline& p : parts) scanned.add(p);
  const auto of_parts = owners(parts, width, height);
  const auto of_whole = owners({whole}, width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = pixel_index(x, y, width);
      if (of_whole[i] != of_parts[i])
        o.fail(fmt::format("pixel ({}, {}): the oracle has it in {} parts and in {} wholes", x, y, of_parts[i],
                           of_whole[i]));
      if (scanned.hits().at(x, y) != of_whole[i])
        o.fail(fmt::format("pixel ({}, {}) is hit {} times, not {}", x, y, scanned.hits().at(x, y), of_whole[i]));
    }
  o.pixels = of_whole.size();
  return o;
}

Outcome covers_what_the_oracle_says(const Outline& o, int width, int height, const Context& context) {
  Outcome out;
  Scanned scanned(width, height, context);
  const Hits& hits = scanned.add(o).hits();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int expected = Oracle::winding(o, x, y) != 0 ? 1 : 0;
      if (hits.at(x, y) != expected)
        out.fail(fmt::format("pixel ({}, {}) is hit {} times, not {}", x, y, hits.at(x, y), expected));
    }
  out.pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  return out;
}

Outcome draws_nothing(const Outline& given, int width, int height, const Context& context) {
  Outline flat = given;
  if (context.injected(Injection::moved_corner)) ++flat.back().x;
  Outcome o = covers_what_the_oracle_says(flat, width, height, context);
  Scanned scanned(width, height, context);
  if (scanned.add(flat).hits().unlike(0) != 0) o.fail("a pixel is hit");
  FrameBuilder frame(width, height);
  frame.add(rectangle(0, 0, 10, 10), plane(1000), {1, 2, 3});
  std::vector<std::uint32_t> plain;
  make_frame(frame.frame(), Config{}, 0, plain, {.threads = 1});
  frame.add(flat, plane(10), {255, 255, 255});
  std::vector<std::uint32_t> more;
  make_frame(frame.frame(), Config{}, 0, more, {.threads = 1});
  if (more != plain) o.fail("the frame has other words with the polygon than without");
  return o;
}

}  // namespace kage::verif
