// SPDX-License-Identifier: Apache-2.0
#include "kage/diff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "image/flip_metric.hpp"
#include "image/memory.hpp"
#include "image/picture.hpp"
#include "image/picture_lines.hpp"
#include "image/regions.hpp"
#include "image/sample.hpp"
#include "image/views.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"

namespace kage {
namespace {

/// How the pixels of one line came out.
struct Line {
  std::vector<bool> compared;
  std::vector<bool> tolerated;       // differs, but not beyond the threshold
  std::vector<bool> nan;             // on either side
  std::vector<int> first;            // the first channel that is different or NaN, or -1
  std::vector<std::uint64_t> steps;  // the largest distance of all channels

  explicit Line(std::size_t width) : compared(width, true), tolerated(width), nan(width), first(width), steps(width) {}

  void clear() {
    tolerated.assign(tolerated.size(), false);
    nan.assign(nan.size(), false);
    std::fill(first.begin(), first.end(), -1);
    std::fill(steps.begin(), steps.end(), 0);
  }
};

class Comparison {
 public:
  /// `background`: of the heat map, if there is one.
  Comparison(PictureLines& a, PictureLines& b, const DiffOptions& options, DiffResult& result, Image* heat,
             const Picture* background)
      : a_(a.head()),
        lines_a_(a),
        lines_b_(b),
        options_(options),
        result_(result),
        heat_(heat),
        box_(options.region.value_or(Box{0, 0, a_.width, a_.height})),
        line_(static_cast<std::size_t>(a_.width)),
        finder_(a_.width, kMaxRegions) {
    if (heat == nullptr) return;
    background_ = view_of(*background);
    *heat = Image(a_.width, a_.height, 3);
  }

  void run() {
    for (const Picture::Channel& c : a_.channels) result_.floats = result_.floats || is_float(c.sample);
    const std::size_t bytes = static_cast<std::size_t>(a_.width) * a_.pixel_bytes;
    for (int y = 0; y < a_.height; ++y) {
      row_a_ = lines_a_.row(y);
      row_b_ = lines_b_.row(y);
      // A line of floats that is equal may hold a NaN.
      const bool look = result_.floats || std::memcmp(row_a_, row_b_, bytes) != 0;
      if (!look && heat_ == nullptr && options_.mask.data.empty()) {
        if (in_box(y)) result_.compared_pixels += static_cast<std::uint64_t>(box_.width);
        continue;
      }
      select(y);
      line_.clear();
      if (look)
        for (std::size_t c = 0; c < a_.channels.size(); ++c)
          with_sample(a_.channels[c].sample, [&](auto type) { channel<decltype(type)>(c); });
      gather(y);
    }
    result_.regions = finder_.regions();
    result_.region_count = finder_.count();
    finish();
  }

 private:
  [[nodiscard]] bool left_out(std::size_t channel) const {
    return options_.ignore_alpha && static_cast<int>(channel) == a_.alpha;
  }

  [[nodiscard]] bool in_box(int y) const { return y >= box_.y && y - box_.y < box_.height; }

  void select(int y) {
    const bool inside = in_box(y);
    for (std::size_t x = 0; x < line_.compared.size(); ++x) {
      const int column = static_cast<int>(x);
      line_.compared[x] = inside && column >= box_.x && column - box_.x < box_.width &&
                          (options_.mask.data.empty() || options_.mask.data[options_.mask.index(column, y)] != 0);
      result_.compared_pixels += line_.compared[x] ? 1 : 0;
    }
  }

  template <typename Type>
  void channel(std::size_t c) {
    const std::byte* pa = row_a_ + a_.channels[c].offset;
    const std::byte* pb = row_b_ + a_.channels[c].offset;
    const bool ignored = left_out(c);
    for (std::size_t x = 0; x < line_.compared.size(); ++x, pa += a_.pixel_bytes, pb += a_.pixel_bytes) {
      if (Type::is_nan(pa) || Type::is_nan(pb)) {
        line_.nan[x] = true;
        if (line_.first[x] < 0) line_.first[x] = static_cast<int>(c);
        continue;
      }
      if (ignored || !line_.compared[x]) continue;
      in_range_ = in_range_ && Type::in_range(pa) && Type::in_range(pb);
      const std::uint64_t steps = Type::steps(pa, pb);
      if (steps == 0) continue;
      line_.steps[x] = std::max(line_.steps[x], steps);
      if (differs<Type>(steps, pa, pb)) {
        if (line_.first[x] < 0) line_.first[x] = static_cast<int>(c);
      } else {
        line_.tolerated[x] = true;
      }
    }
  }

  /// Two values with unequal bits, no NaN.
  template <typename Type>
  bool differs(std::uint64_t steps, const std::byte* pa, const std::byte* pb) {
    // Differences of distant 64-bit integers lose bits as doubles: only the measure needs them.
    const double apart = std::fabs(Type::number(pa) - Type::number(pb));
    squares_ += apart * apart;
    if constexpr (Type::kFloat) {
      max_ulp_ = std::max(max_ulp_, steps);
      max_abs_ = std::max(max_abs_, apart);
      if (options_.abs) return *options_.abs == 0 || !(apart <= *options_.abs);
      return steps > options_.ulp.value_or(0);
    } else {
      max_lsb_ = std::max(max_lsb_, steps);
      return steps > options_.lsb.value_or(0);
    }
  }

  void gather(int y) {
    for (std::size_t x = 0; x < line_.first.size(); ++x) {
      const int column = static_cast<int>(x);
      const bool different = line_.first[x] >= 0;
      if (different) {
        ++result_.different_pixels;
        result_.nan_pixels += line_.nan[x] ? 1 : 0;
        finder_.add(column, y);
        if (!result_.first) result_.first = DiffResult::Position{column, y, line_.first[x]};
      }
      if (heat_ == nullptr) continue;
      const PixelVerdict verdict = line_.nan[x]         ? PixelVerdict::nan
                                   : different          ? PixelVerdict::different
                                   : !line_.compared[x] ? PixelVerdict::left_out
                                   : line_.tolerated[x] ? PixelVerdict::tolerated
                                                        : PixelVerdict::same;
      const std::size_t at = heat_->index(column, y);
      const std::uint8_t* const p = &background_.data[at];
      paint(*heat_, at / 3, verdict, line_.steps[x], (p[0] + p[1] + p[2]) / 3);
    }
  }

  void finish() {
    std::uint64_t channels = 0;
    for (std::size_t c = 0; c < a_.channels.size(); ++c) {
      if (left_out(c)) continue;
      ++channels;
      if (is_float(a_.channels[c].sample)) {
        result_.max_abs = max_abs_;
        result_.max_ulp = max_ulp_;
      } else {
        result_.max_lsb = max_lsb_;
      }
    }
    if (channels == 0 || result_.compared_pixels == 0)
      throw Error("nothing is compared: region, mask and ignored alpha leave no value");
    const double mean = squares_ / (static_cast<double>(result_.compared_pixels) * static_cast<double>(channels));
    if (mean > 0 && in_range_ && result_.nan_pixels == 0) result_.psnr = -10 * std::log10(mean);
    judge();
  }

  void judge() {
    DiffResult& r = result_;
    const auto n = r.different_pixels;
    bool within = n == 0;
    if (options_.max_pixels || options_.max_percent)
      within = (!options_.max_pixels || n <= *options_.max_pixels) &&
               (!options_.max_percent ||
                static_cast<double>(n) * 100 <= *options_.max_percent * static_cast<double>(r.compared_pixels));
    r.same = within && r.nan_pixels == 0;
    if (r.nan_pixels != 0)
      r.reason = counted(r.nan_pixels, "pixel") + " with a NaN";
    else if (!within)
      r.reason = fmt::format("{} of {} pixels {}", n, r.compared_pixels, n == 1 ? "differs" : "differ");
  }

  const Picture& a_;  // without data; b is like it
  PictureLines& lines_a_;
  PictureLines& lines_b_;
  const std::byte* row_a_ = nullptr;  // of the line at hand
  const std::byte* row_b_ = nullptr;
  const DiffOptions& options_;
  DiffResult& result_;
  Image* heat_;
  Box box_;
  Line line_;
  RegionFinder finder_;
  Image background_;
  double squares_ = 0;
  bool in_range_ = true;  // floats have no largest value of their own: beyond 1 there is nothing to measure against
  double max_abs_ = 0;
  std::uint64_t max_ulp_ = 0;
  std::uint64_t max_lsb_ = 0;
};

/// Refuses what would be judged by a threshold of another sort, or not at all.
void check_options(const Picture& picture, const DiffOptions& o) {
  for (const Picture::Channel& c : picture.channels) {
    if (is_float(c.sample) && o.lsb)
      throw Error(fmt::format("threshold lsb is for integers, and channel {} is {}: take abs or ulp", c.name,
                              name_of(c.sample)));
    if (!is_float(c.sample) && (o.abs || o.ulp))
      throw Error(fmt::format("thresholds abs and ulp are for floats, and channel {} is {}: take lsb", c.name,
                              name_of(c.sample)));
  }
  if (o.abs && o.ulp) throw Error("give a threshold abs or ulp, not both");
  if (o.abs && !(*o.abs >= 0 && std::isfinite(*o.abs)))
    throw Error(fmt::format("threshold abs is {}, not a finite number of at least 0", *o.abs));
  if (o.max_percent && !(*o.max_percent >= 0 && *o.max_percent <= 100))
    throw Error(fmt::format("{} percent of the pixels are not 0 .. 100", *o.max_percent));
  if (o.region) {
    const Box& r = *o.region;
    if (r.x < 0 || r.y < 0 || r.width < 1 || r.height < 1 || r.x > picture.width - r.width ||
        r.y > picture.height - r.height)
      throw Error(fmt::format("region {}x{}+{}+{} is not inside the picture of {}x{}", r.width, r.height, r.x, r.y,
                              picture.width, picture.height));
  }
  if (!o.mask.data.empty() && (o.mask.width != picture.width || o.mask.height != picture.height))
    throw Error(fmt::format("the mask is {}x{}, the picture {}x{}", o.mask.width, o.mask.height, picture.width,
                            picture.height));
}

/// `background`: of the heat map, if there is one.
DiffResult diff_lines(PictureLines& a, PictureLines& b, const DiffOptions& options, Image* heat,
                      const Picture* background) {
  const Picture& head = a.head();
  DiffResult r;
  r.reason = unlike(head, b.head());
  if (!r.reason.empty()) return r;
  check_options(head, options);
  r.width = head.width;
  r.height = head.height;
  r.channels = static_cast<int>(head.channels.size());
  Comparison(a, b, options, r, heat, background).run();
  return r;
}

DiffResult diff_pictures(const Picture& a, const Picture& b, const DiffOptions& options, Image* heat) {
  PictureLines lines_a(a);
  PictureLines lines_b(b);
  DiffResult r = diff_lines(lines_a, lines_b, options, heat, &a);
  if (r.width != 0 && options.perceptual) {
    r.perceptual_pixels = perceptual_pixels(a, b, options.region.value_or(Box{0, 0, a.width, a.height}));
    r.flip = flip_metric(view_of(a), view_of(b));
  }
  return r;
}

Picture picture_of(const Image& image) {
  Picture p;
  p.width = image.width;
  p.height = image.height;
  p.pixel_bytes = static_cast<std::size_t>(image.channels);
  for (std::size_t c = 0; c < p.pixel_bytes; ++c) p.channels.push_back({fmt::format("{}", c), Sample::kU8, c});
  const std::byte* const bytes = reinterpret_cast<const std::byte*>(image.data.data());
  p.data.assign(bytes, bytes + image.data.size());
  return p;
}

/// The memory that it takes to compare one of two files, in bytes.
std::uint64_t bytes_of(const PictureReader& reader, bool whole, const DiffOptions& options) {
  const Picture& head = reader.head();
  const auto height = static_cast<std::uint64_t>(head.height);
  const auto width = static_cast<std::uint64_t>(head.width);
  if (!whole)
    return reader.own_bytes() +
           reader.line_bytes() * std::min<std::uint64_t>(static_cast<std::uint64_t>(reader.step()), height);
  constexpr std::uint64_t kViews = 3 + 3;         // bytes a pixel: its view, and half of heat map and its background
  constexpr std::uint64_t kPerceptual = 12 + 60;  // three linear floats, and FLIP's planes of doubles
  return reader.own_bytes() + reader.line_bytes() * height +
         width * height * (kViews + (options.perceptual ? kPerceptual : 0));
}

/// Also of pictures that are unlike all lines are read: a file that is damaged is trouble, whatever the other is.
DiffResult diff_by_lines(PictureReader& a, PictureReader& b, const DiffOptions& options) {
  PictureLines lines_a(a);
  PictureLines lines_b(b);
  DiffResult r = diff_lines(lines_a, lines_b, options, nullptr, nullptr);
  if (r.width == 0)
    for (PictureLines* lines : {&lines_a, &lines_b})
      for (int y = 0; y < lines->head().height; ++y) (void)lines->row(y);
  return r;
}

}  // namespace

DiffResult diff_files(const std::filesystem::path& a, const std::filesystem::path& b, const DiffOptions& options,
                      DiffViews* views) {
  const auto reader_a = open_picture(a, options.part, options.max_bytes);
  const auto reader_b = open_picture(b, options.part, options.max_bytes);
  const bool whole = views != nullptr || options.perceptual;
  check_memory(fmt::format("{}, {}: to compare them takes", a.string(), b.string()).c_str(),
               bytes_of(*reader_a, whole, options) + bytes_of(*reader_b, whole, options), options.max_bytes);
  try {
    if (!whole) return diff_by_lines(*reader_a, *reader_b, options);
    const Picture pa = whole_picture(*reader_a);
    const Picture pb = whole_picture(*reader_b);
    if (views != nullptr) *views = {{}, view_of(pa), view_of(pb)};
    DiffResult r = diff_pictures(pa, pb, options, views == nullptr ? nullptr : &views->heat);
    if (views != nullptr) frame_regions(views->heat, r.regions);
    return r;
  } catch (const Error& e) {
    const std::string_view said = e.what();  // by a reader, with its file's name, or by the comparison, without one
    if (said.starts_with(a.string() + ": ") || said.starts_with(b.string() + ": ")) throw;
    throw Error(fmt::format("{}: {}", a.string(), said));
  }
}

DiffResult diff_images(const Image& a, const Image& b, const DiffOptions& options, Image* heat) {
  return diff_pictures(picture_of(a), picture_of(b), options, heat);
}

Image load_mask(const std::filesystem::path& path, std::optional<std::uint64_t> max_bytes) {
  const Picture picture = load_picture(path, -1, max_bytes);
  Image mask(picture.width, picture.height, 1);
  bool some = false;
  for (std::size_t c = 0; c < picture.channels.size(); ++c) {
    // Alpha of a mask is rarely meant: an opaque one would compare everything.
    if (static_cast<int>(c) == picture.alpha && picture.channels.size() > 1) continue;
    with_sample(picture.channels[c].sample, [&](auto type) {
      const std::byte* at = picture.data.data() + picture.channels[c].offset;
      for (std::uint8_t& pixel : mask.data) {
        const double value = decltype(type)::number(at);
        if (std::isnan(value)) throw Error(fmt::format("{}: a NaN says neither compared nor not", path.string()));
        if (value != 0) pixel = 255;
        some = some || pixel != 0;
        at += picture.pixel_bytes;
      }
    });
  }
  if (!some) throw Error(fmt::format("{}: the mask is 0 everywhere: nothing would be compared", path.string()));
  return mask;
}

}  // namespace kage
