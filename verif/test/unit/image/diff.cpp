// SPDX-License-Identifier: Apache-2.0
// Laws of the picture comparison, over random pictures of integers and of floats.
#include "kage/diff.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "kage/error.hpp"
#include "test/support/catch.hpp"
#include "test/support/pictures.hpp"

namespace kage::verif {
namespace {

Image random_image(int w, int h, int c) {
  Image image(w, h, c);
  for (auto& v : image.data) v = *rc::gen::element<std::uint8_t>(0, 1, 2, 127, 254, 255);
  return image;
}

/// Two float pictures as files, many values of which are equal.
struct FloatPair {
  std::vector<float> a;
  std::vector<float> b;
  static constexpr int kWidth = 4;
  explicit FloatPair(Random& random) : a(std::size_t{kWidth} * 3), b(a.size()) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      a[i] = random_float(random);
      b[i] = random.chance(0.6) ? a[i] : random_float(random);
    }
  }
  void write(const std::filesystem::path& folder) const {
    write_floats(folder / "a.exr", kWidth, 1, a);
    write_floats(folder / "b.exr", kWidth, 1, b);
  }
};

std::uint32_t bits_of(float v) { return std::bit_cast<std::uint32_t>(v); }

/// The next float up; +0 comes after -0.
float next_up(float v) {
  return v == 0 && std::signbit(v) ? 0.0F : std::nextafter(v, std::numeric_limits<float>::infinity());
}

/// Representable numbers from one float to the other, counted by going there, up to limit + 1.
std::uint64_t steps_between(float a, float b, std::uint64_t limit) {
  const bool a_is_low = a < b || (a == b && std::signbit(a));
  float low = a_is_low ? a : b;
  const float high = a_is_low ? b : a;
  std::uint64_t n = 0;
  for (; n <= limit && bits_of(low) != bits_of(high); ++n) low = next_up(low);
  return n;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// How many groups pixels (of lines `width` long) make, if those at most `reach` columns and lines apart belong
/// together.
std::size_t groups(const std::set<std::size_t>& pixels, int width, int reach) {
  std::vector<std::size_t> left(pixels.begin(), pixels.end());
  std::size_t count = 0;
  const auto near = [&](std::size_t a, std::size_t b) {
    const int x = static_cast<int>(a) % width - static_cast<int>(b) % width;
    const int y = static_cast<int>(a) / width - static_cast<int>(b) / width;
    return std::max(std::abs(x), std::abs(y)) <= reach;
  };
  for (; !left.empty(); ++count) {
    std::vector<std::size_t> group{left.back()};
    left.pop_back();
    for (std::size_t i = 0; i < group.size(); ++i)
      for (std::size_t k = left.size(); k-- > 0;)
        if (near(group[i], left[k])) {
          group.push_back(left[k]);
          left[k] = left.back();
          left.pop_back();
        }
  }
  return count;
}

bool alike(const DiffResult& x, const DiffResult& y) {
  return x.same == y.same && x.reason == y.reason && x.different_pixels == y.different_pixels &&
         x.nan_pixels == y.nan_pixels && x.max_lsb == y.max_lsb && x.max_abs == y.max_abs && x.max_ulp == y.max_ulp &&
         x.psnr == y.psnr && x.region_count == y.region_count && x.first.has_value() == y.first.has_value() &&
         (!x.first || (x.first->x == y.first->x && x.first->y == y.first->y && x.first->channel == y.first->channel));
}

}  // namespace

TEST_CASE("same means equal bits, and nothing else does") {
  CHECK(rc::check([] {
    const Image a = random_image(*rc::gen::inRange(1, 5), *rc::gen::inRange(1, 5), *rc::gen::element(1, 3));
    Image b = a;
    RC_ASSERT(diff_images(a, b).same);
    b.data[*rc::gen::inRange<std::size_t>(0, b.data.size())] ^= 1;
    const auto r = diff_images(a, b);
    RC_ASSERT(!r.same && r.different_pixels == 1 && r.max_lsb == 1U && r.first.has_value());
  }));
}

TEST_CASE("comparison is symmetric, whatever the thresholds") {
  CHECK(rc::check([] {
    const Image a = random_image(4, 3, 3);
    const Image b = random_image(4, 3, 3);
    DiffOptions o;
    o.lsb = *rc::gen::inRange<std::uint64_t>(0, 300);
    o.max_percent = *rc::gen::inRange(0, 101);
    o.region = Box{*rc::gen::inRange(0, 2), 0, 3, *rc::gen::inRange(1, 4)};
    RC_ASSERT(alike(diff_images(a, b, o), diff_images(b, a, o)));
  }));
}

TEST_CASE("a wider threshold never finds more, and never turns same into different") {
  CHECK(rc::check([] {
    const Image a = random_image(5, 4, 1);
    const Image b = random_image(5, 4, 1);
    DiffOptions o;
    o.lsb = *rc::gen::inRange<std::uint64_t>(0, 256);
    o.max_pixels = *rc::gen::inRange<std::uint64_t>(0, 20);
    o.max_percent = *rc::gen::inRange(0, 100);
    const auto narrow = diff_images(a, b, o);
    const auto wider = [&](auto change) {
      DiffOptions w = o;
      change(w);
      const auto r = diff_images(a, b, w);
      RC_ASSERT(r.different_pixels <= narrow.different_pixels);
      RC_ASSERT(!narrow.same || r.same);
    };
    wider([](DiffOptions& w) { ++*w.lsb; });
    wider([](DiffOptions& w) { ++*w.max_pixels; });
    wider([](DiffOptions& w) { *w.max_percent += 1; });
    wider([](DiffOptions& w) {
      w.region = Box{1, 1, 3, 2};
      w.max_percent.reset();
      w.max_pixels.reset();
      w.lsb = 255;
    });
    o.lsb = 255;
    o.max_pixels.reset();
    o.max_percent.reset();
    RC_ASSERT(diff_images(a, b, o).same);
  }));
}

TEST_CASE("a part that is compared differs only if the whole does, and the parts' pixels add up") {
  CHECK(rc::check([] {
    const Image a = random_image(6, 5, 1);
    const Image b = random_image(6, 5, 1);
    const int cut = *rc::gen::inRange(1, 6);
    DiffOptions left;
    left.region = Box{0, 0, cut, 5};
    DiffOptions right;
    right.region = Box{cut, 0, 6 - cut, 5};
    const auto whole = diff_images(a, b);
    const auto l = diff_images(a, b, left);
    const auto r = diff_images(a, b, right);
    RC_ASSERT(l.different_pixels + r.different_pixels == whole.different_pixels);
    RC_ASSERT(whole.same == (l.same && r.same));
    DiffOptions masked;
    masked.mask = Image(6, 5, 1);
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < cut; ++x) masked.mask.data[masked.mask.index(x, y)] = 1;
    RC_ASSERT(alike(diff_images(a, b, masked), l));
  }));
}

TEST_CASE("the laws hold for floats: bits, symmetry, monotone; ULP and absolute distances are those counted here") {
  const TempFolder folder("image-laws");
  Random random(test_seed());
  CAPTURE(test_seed());
  const auto a = folder.path / "a.exr";
  const auto b = folder.path / "b.exr";
  int same = 0;
  int zeros = 0;
  for (int round = 0; round < 400; ++round) {
    const FloatPair pair(random);
    pair.write(folder.path);
    const auto exact = diff_files(a, b);
    CHECK(exact.same == same_bits(pair.a, pair.b));
    CHECK(alike(exact, diff_files(b, a)));
    CHECK(diff_files(a, a).same);
    CHECK_FALSE(exact.max_lsb);

    DiffOptions by_ulp;
    by_ulp.ulp = static_cast<std::uint64_t>(random.in(0, 5));
    DiffOptions by_abs;
    by_abs.abs = random.chance(0.2) ? 0.0 : random.chance(0.5) ? random.real(0, 1e-7) : random.real(0, 3);
    std::uint64_t beyond_ulp = 0;
    std::uint64_t beyond_abs = 0;
    for (std::size_t i = 0; i < pair.a.size(); ++i) {
      if (bits_of(pair.a[i]) == bits_of(pair.b[i])) continue;
      beyond_ulp += steps_between(pair.a[i], pair.b[i], *by_ulp.ulp) > *by_ulp.ulp ? 1 : 0;
      const double apart = std::abs(static_cast<double>(pair.a[i]) - static_cast<double>(pair.b[i]));
      beyond_abs += *by_abs.abs == 0 || !(apart <= *by_abs.abs) ? 1 : 0;
      zeros += apart == 0 ? 1 : 0;
    }
    const auto u = diff_files(a, b, by_ulp);
    const auto d = diff_files(a, b, by_abs);
    CHECK(u.different_pixels == beyond_ulp);
    CHECK(d.different_pixels == beyond_abs);
    CHECK(alike(u, diff_files(b, a, by_ulp)));
    CHECK(alike(d, diff_files(b, a, by_abs)));
    ++*by_ulp.ulp;
    *by_abs.abs += 0.1;
    CHECK(diff_files(a, b, by_ulp).different_pixels <= u.different_pixels);
    CHECK(diff_files(a, b, by_abs).different_pixels <= d.different_pixels);
    same += exact.same ? 1 : 0;
  }
  CHECK(zeros > 0);  // +0 against -0 was among them
  CHECK(same < 400);
}

TEST_CASE("regions hold each differing pixel, fit closely, and part what is far apart") {
  CHECK(rc::check([] {
    const int w = *rc::gen::inRange(1, 70);
    const int h = *rc::gen::inRange(1, 50);
    const Image a(w, h, 1);
    Image b = a;
    const auto pixels = *rc::gen::container<std::set<std::size_t>>(rc::gen::inRange<std::size_t>(0, b.data.size()));
    for (const std::size_t p : pixels) b.data[p] = 9;
    const auto r = diff_images(a, b);
    RC_ASSERT(r.region_count == r.regions.size() || r.regions.size() == kMaxRegions);
    if (r.region_count > kMaxRegions) return;
    std::uint64_t total = 0;
    for (const auto& region : r.regions) total += region.pixels;
    RC_ASSERT(total == pixels.size());
    // Pixels 8 apart lie in tiles that touch, those 16 apart do not.
    RC_ASSERT(r.region_count <= groups(pixels, w, 8));
    RC_ASSERT(r.region_count >= groups(pixels, w, 15));
    const auto inside = [&](const Box& box, std::size_t p) {
      const int x = static_cast<int>(p) % w;
      const int y = static_cast<int>(p) / w;
      return x >= box.x && x < box.x + box.width && y >= box.y && y < box.y + box.height;
    };
    for (const std::size_t p : pixels)
      RC_ASSERT(std::any_of(r.regions.begin(), r.regions.end(), [&](const auto& g) { return inside(g.box, p); }));
    for (const auto& region : r.regions) {
      const Box& box = region.box;
      const auto touched = [&](Box side) {
        return std::any_of(pixels.begin(), pixels.end(), [&](std::size_t p) { return inside(side, p); });
      };
      RC_ASSERT(touched({box.x, box.y, 1, box.height}) && touched({box.x, box.y, box.width, 1}));
      RC_ASSERT(touched({box.x + box.width - 1, box.y, 1, box.height}));
      RC_ASSERT(touched({box.x, box.y + box.height - 1, box.width, 1}));
    }
  }));
}

TEST_CASE("a line of pixels is one region, whichever way it goes") {
  for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}}) {
    const Image a(60, 60, 1);
    Image b = a;
    for (int i = 0; i < 60; ++i) b.data[b.index(dx == 1 ? i : dx == 0 ? 30 : 59 - i, dy == 1 ? i : 30)] = 1;
    const auto r = diff_images(a, b);
    REQUIRE(r.region_count == 1);
    CHECK(r.regions[0].pixels == 60);
    CHECK(r.regions[0].box == Box{dx == 0 ? 30 : 0, dy == 0 ? 30 : 0, dx == 0 ? 1 : 60, dy == 0 ? 1 : 60});
  }
}

TEST_CASE("the first difference is the first in reading order") {
  Image a(4, 3, 3);
  Image b = a;
  b.data[b.index(2, 1) + 1] = 7;
  b.data[b.index(1, 2)] = 200;
  const auto r = diff_images(a, b);
  REQUIRE(r.first);
  CHECK(r.first->x == 2);
  CHECK(r.first->y == 1);
  CHECK(r.first->channel == 1);
  CHECK(r.different_pixels == 2);
  CHECK(r.max_lsb == 200U);
  DiffOptions o;
  o.lsb = 7;
  const auto tolerant = diff_images(a, b, o);
  REQUIRE(tolerant.first);
  CHECK(tolerant.first->y == 2);
}

TEST_CASE("limits on pixels and on percent both hold when both are given, and a share is never rounded away") {
  Image a(10, 10, 1);
  Image b = a;
  for (int i = 0; i < 5; ++i) b.data[static_cast<std::size_t>(i)] = 1;
  const auto same = [&](std::optional<std::uint64_t> pixels, std::optional<double> percent) {
    DiffOptions o;
    o.max_pixels = pixels;
    o.max_percent = percent;
    return diff_images(a, b, o).same;
  };
  CHECK(same(5, {}));
  CHECK_FALSE(same(4, {}));
  CHECK(same({}, 5.0));
  CHECK_FALSE(same({}, 4.9));
  CHECK_FALSE(same(5, 4.9));
  CHECK_FALSE(same(4, 5.0));
  a = Image(3000, 2000, 1);
  b = a;
  b.data[4'321'000] = 1;
  CHECK_FALSE(same({}, 0.0));
  CHECK_FALSE(same({}, 0.00001));
  CHECK(same({}, 100.0 / 6'000'000));
}

TEST_CASE("unlike sizes and channels are different, whatever the threshold") {
  DiffOptions all;
  all.lsb = 255;
  all.max_percent = 100;
  CHECK_FALSE(diff_images(Image(2, 3, 1), Image(3, 2, 1), all).same);
  CHECK_FALSE(diff_images(Image(2, 2, 1), Image(2, 2, 3), all).same);
}

TEST_CASE("what would compare nothing, or by the wrong sort of threshold, is refused") {
  const Image a(4, 3, 1);
  DiffOptions o;
  const auto refused = [&] { CHECK_THROWS_AS(diff_images(a, a, o), Error); };
  for (const Box& box : {Box{0, 0, 5, 1}, Box{0, 0, 1, 4}, Box{-1, 0, 1, 1}, Box{4, 0, 1, 1}, Box{0, 0, 0, 1},
                         Box{0, std::numeric_limits<int>::max(), 1, 1}}) {
    o.region = box;
    refused();
  }
  o = {};
  o.mask = Image(4, 3, 1);
  refused();
  o.mask.data[0] = 1;
  CHECK(diff_images(a, a, o).compared_pixels == 1);
  o.region = Box{1, 0, 3, 3};
  refused();  // the mask's pixel is not in it
  o = {};
  o.mask = Image(3, 4, 1);
  refused();
  o = {};
  o.ulp = 1;
  refused();
  o = {};
  o.abs = 0.5;
  refused();
  o = {};
  o.max_percent = std::nan("");
  refused();
}

TEST_CASE("PSNR is that of the textbook, and decides nothing") {
  Image a(8, 8, 1);
  Image b = a;
  CHECK_FALSE(diff_images(a, b).psnr);
  b.data[3] = 255;
  const auto r = diff_images(a, b);
  REQUIRE(r.psnr);
  CHECK(*r.psnr == Approx(10 * std::log10(64.0)));
  b.data[3] = 1;
  DiffOptions o;
  o.lsb = 1;
  CHECK(diff_images(a, b, o).same);
  CHECK(diff_images(a, b, o).psnr.has_value());
}

}  // namespace kage::verif
