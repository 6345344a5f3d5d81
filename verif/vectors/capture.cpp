// SPDX-License-Identifier: Apache-2.0
#include "vectors/capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>

#include "kage/error.hpp"
#include "kage/image.hpp"
#include "vectors/texts.hpp"

namespace kage::vectors {
namespace {

/// The pack's pixels, or signatures, one after the other, with their places.
class Expected {
 public:
  Expected(const std::filesystem::path& folder, const Pack& pack, std::optional<std::uint64_t> frame)
      : pack_(pack), pixels_(folder / kPixelsBin, std::ios::binary), signatures_(folder / kSignaturesHex), frame_(0) {
    if (frame) {
      for (; frame_ < *frame; ++frame_) {
        const PackFrame& f = pack_.frames[frame_];
        pixels_.seekg(static_cast<std::streamoff>(f.pixels()) * pack_.config.channels, std::ios::cur);
        signatures_.seekg(static_cast<std::streamoff>(f.lines()) * 9, std::ios::cur);
      }
      end_ = *frame + 1;
    } else {
      end_ = pack.frames.size();
    }
    settle();
  }

  [[nodiscard]] bool done() const { return frame_ == end_; }
  [[nodiscard]] std::uint64_t frame() const { return frame_; }
  [[nodiscard]] int line() const { return line_; }
  [[nodiscard]] int x() const { return x_; }
  [[nodiscard]] bool user() const { return line_ == 0 && x_ == 0; }
  [[nodiscard]] bool last() const { return x_ + 1 == pack_.frames[frame_].status.width; }

  void pixel(std::span<std::uint8_t> channels) {
    if (!pixels_.read(reinterpret_cast<char*>(channels.data()), static_cast<std::streamsize>(channels.size())))
      throw Error(std::string(kPixelsBin) + ": ends early");
  }
  std::uint32_t signature() {
    std::string text;
    if (!std::getline(signatures_, text)) throw Error(std::string(kSignaturesHex) + ": ends early");
    return static_cast<std::uint32_t>(std::stoul(text, nullptr, 16));
  }
  void next_pixel() {
    ++x_;
    if (x_ == pack_.frames[frame_].status.width) next_line();
  }
  void next_line() {
    x_ = 0;
    ++line_;
    if (line_ == pack_.frames[frame_].status.height) {
      line_ = 0;
      ++frame_;
      settle();
    }
  }

 private:
  /// Past frames that bring no pixels.
  void settle() {
    while (frame_ < end_ && pack_.frames[frame_].pixels() == 0) ++frame_;
  }

  const Pack& pack_;
  std::ifstream pixels_, signatures_;
  std::uint64_t frame_, end_ = 0;
  int line_ = 0, x_ = 0;
};

class Judge {
 public:
  Judge(const std::filesystem::path& folder, const Pack& pack, std::optional<std::uint64_t> frame,
        const std::function<void()>& wait)
      : expected_(folder, pack, frame), wanted_(static_cast<std::size_t>(pack.config.channels)), wait_(wait) {}

  /// The next pixel of the capture, none in a channel that is unknown; `flags`: 2 TUSER + TLAST, where it has them.
  void pixel(std::span<const std::optional<std::uint8_t>> got, std::optional<unsigned> flags) {
    if (judged_++ % 4096 == 0) wait_();
    if (expected_.done()) {
      ++extra_;
      return;
    }
    expected_.pixel(wanted_);
    bool good = true;
    const auto differ = [&](const char* what, std::uint32_t e, std::optional<std::uint32_t> a) {
      if (a == e) return;
      good = false;
      note(what, e, a, expected_.x());
    };
    static constexpr std::array kChannels{"channel 0", "channel 1", "channel 2"};
    for (std::size_t c = 0; c < wanted_.size(); ++c) differ(kChannels.at(c), wanted_[c], got[c]);
    if (flags) {
      differ("TUSER", expected_.user() ? 1 : 0, *flags >> 1);
      differ("TLAST", expected_.last() ? 1 : 0, *flags & 1);
    }
    count(good);
    expected_.next_pixel();
  }
  void signature(std::optional<std::uint32_t> got) {
    verdict_.signatures = true;
    if (expected_.done()) {
      ++extra_;
      return;
    }
    const std::uint32_t wanted = expected_.signature();
    if (got != wanted) note("signature", wanted, got, std::nullopt);
    count(got == wanted);
    expected_.next_line();
  }
  CaptureVerdict verdict() {
    if (extra_ > 0)
      verdict_.remark = fmt::format("goes on behind the last frame: {} more", extra_);
    else if (!expected_.done())
      verdict_.remark =
          verdict_.signatures
              ? fmt::format("ends before frame {}, line {}", expected_.frame(), expected_.line())
              : fmt::format("ends before frame {}, line {}, x {}", expected_.frame(), expected_.line(), expected_.x());
    return verdict_;
  }

 private:
  void note(const std::string& what, std::uint32_t e, std::optional<std::uint32_t> a, std::optional<int> x) {
    if (!verdict_.first) verdict_.first = WrongPlace{expected_.frame(), expected_.line(), x, what, e, a};
  }
  void count(bool good) {
    ++verdict_.compared;
    if (!good) ++verdict_.wrong;
  }

  Expected expected_;
  std::vector<std::uint8_t> wanted_;
  CaptureVerdict verdict_;
  std::uint64_t extra_ = 0;
  std::uint64_t judged_ = 0;
  const std::function<void()>& wait_;
};

/// Hexadecimal digits; none if one is unknown.
std::optional<std::uint32_t> number_of(const std::string& digits) {
  if (digits.find_first_of("xXzZ") != std::string::npos) return std::nullopt;
  return static_cast<std::uint32_t>(std::stoul(digits, nullptr, 16));
}

void judge_hex(Judge& judge, const Pack& pack, const std::filesystem::path& path) {
  std::ifstream in(path);
  const std::size_t digits = std::size_t{2} * static_cast<std::size_t>(pack.config.channels);
  std::vector<std::optional<std::uint8_t>> pixel(static_cast<std::size_t>(pack.config.channels));
  std::string line;
  std::optional<std::size_t> length;
  for (std::uint64_t number = 1; std::getline(in, line); ++number) {
    line = line.substr(0, line.find("//"));
    line.erase(
        std::remove_if(line.begin(), line.end(), [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '_'; }),
        line.end());
    if (line.empty() || line[0] == '@') continue;  // $writememh tells addresses so
    const bool hex = line.find_first_not_of("0123456789abcdefABCDEFxXzZ") == std::string::npos;
    const bool fits = line.size() == digits || line.size() == 8 || (line.size() == digits + 1 && line[0] <= '3');
    if (!hex || !fits || (length && *length != line.size()))
      throw Error(
          fmt::format("{}:{}: '{}' is no pixel of {} hexadecimal digits, with or without one in front for TUSER and "
                      "TLAST, nor a signature of 8; all lines are alike",
                      path.string(), number, line.substr(0, 40), digits));
    length = line.size();
    if (line.size() == 8) {
      judge.signature(number_of(line));
      continue;
    }
    const std::size_t from = line.size() - digits;
    for (std::size_t c = 0; c < pixel.size(); ++c) {
      const std::optional<std::uint32_t> value = number_of(line.substr(from + digits - 2 * c - 2, 2));
      pixel[c] = value ? std::optional(static_cast<std::uint8_t>(*value)) : std::nullopt;
    }
    judge.pixel(pixel, from == 1 ? number_of(line.substr(0, 1)) : std::nullopt);
  }
  if (in.bad()) throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
}

void judge_raw(Judge& judge, const Pack& pack, const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<char> bytes(static_cast<std::size_t>(pack.config.channels));
  std::vector<std::optional<std::uint8_t>> pixel(bytes.size());
  while (in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    std::transform(bytes.begin(), bytes.end(), pixel.begin(), [](char c) { return static_cast<std::uint8_t>(c); });
    judge.pixel(pixel, std::nullopt);
  }
  if (in.bad()) throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  if (in.gcount() != 0) throw Error(fmt::format("{}: ends within a pixel of {} bytes", path.string(), bytes.size()));
}

void judge_picture(Judge& judge, const PackFrame& frame, const Pack& pack, const std::filesystem::path& path) {
  const Image image = load_image(path);
  if (image.width != frame.status.width || image.height != frame.status.height ||
      image.channels != pack.config.channels)
    throw Error(fmt::format("{}: is {} x {} with {} channels, the frame {} x {} with {}", path.string(), image.width,
                            image.height, image.channels, frame.status.width, frame.status.height,
                            pack.config.channels));
  const auto channels = static_cast<std::size_t>(image.channels);
  std::vector<std::optional<std::uint8_t>> pixel(channels);
  for (std::size_t at = 0; at < image.data.size(); at += channels) {
    for (std::size_t c = 0; c < channels; ++c) pixel[c] = image.data[at + c];
    judge.pixel(pixel, std::nullopt);
  }
}

bool is_picture(const std::filesystem::path& path) {
  std::string end = path.extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return end == ".png" || end == ".exr" || end == ".ppm" || end == ".pgm" || end == ".tif" || end == ".tiff" ||
         end == ".bmp";
}

}  // namespace

CaptureVerdict judge(const std::filesystem::path& folder, const Pack& pack, const std::filesystem::path& capture,
                     std::optional<std::uint64_t> frame, const std::function<void()>& wait) {
  std::error_code e;
  if (!std::filesystem::is_regular_file(capture, e)) throw Error(capture.string() + ": no file");
  if (std::filesystem::file_size(capture, e) == 0) throw Error(capture.string() + ": is empty: no capture");
  if (frame && *frame >= pack.frames.size())
    throw Error(fmt::format("--frame {}: the pack has frames 0 to {}", *frame, pack.frames.size() - 1));
  const bool picture = is_picture(capture);
  if (picture && !frame) {
    const auto has_pixels = [](const PackFrame& f) { return f.pixels() > 0; };
    if (std::count_if(pack.frames.begin(), pack.frames.end(), has_pixels) != 1)
      throw Error(
          fmt::format("{}: a picture is one frame, and the pack has several: name it by --frame", capture.string()));
    frame = static_cast<std::uint64_t>(std::find_if(pack.frames.begin(), pack.frames.end(), has_pixels) -
                                       pack.frames.begin());
  }
  Judge judge(folder, pack, frame, wait);
  if (picture)
    judge_picture(judge, pack.frames[*frame], pack, capture);
  else if (capture.extension() == ".hex")
    judge_hex(judge, pack, capture);
  else if (capture.extension() == ".bin" || capture.extension() == ".raw")
    judge_raw(judge, pack, capture);
  else
    throw Error(fmt::format("{}: a capture ends with .hex, .bin, .raw, or as a picture does: {} is none",
                            capture.string(),
                            capture.has_extension() ? capture.extension().string() : "a name without a dot"));
  return judge.verdict();
}

std::vector<std::uint32_t> words_of(const std::filesystem::path& folder, const Pack& pack, std::uint64_t frame) {
  std::ifstream in(folder / kStimulusBin, std::ios::binary);
  std::uint64_t beats = 0;
  for (std::uint64_t i = 0; i < frame; ++i) beats += pack.frames[i].beats;
  in.seekg(static_cast<std::streamoff>(4 * beats * static_cast<std::uint64_t>(pack.config.beat_words)));
  std::vector<std::uint32_t> words(pack.frames[frame].words);
  std::vector<char> bytes(4 * words.size());
  if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    throw Error(fmt::format("{}: frame {} is not there whole", (folder / kStimulusBin).string(), frame));
  for (std::size_t w = 0; w < words.size(); ++w)
    for (std::size_t b = 4; b-- > 0;) words[w] = words[w] << 8 | static_cast<std::uint8_t>(bytes[4 * w + b]);
  return words;
}

}  // namespace kage::vectors
