// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/pnm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>

#include "file/one_line.hpp"
#include "kage/error.hpp"

namespace kage::picture_plugin {
namespace {

bool is_blank(int c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// A Netpbm file as it is read from its beginning on.
class Netpbm {
 public:
  explicit Netpbm(const std::filesystem::path& path) : path_(path), in_(path, std::ios::binary) {}

  /// P1 to P6, PF and Pf by their second letter; 0 if it is none of these.
  char kind() {
    char letters[3] = {};
    if (!in_.read(letters, 3) || letters[0] != 'P' || !(is_blank(letters[2]) || letters[2] == '#')) return 0;
    in_.seekg(2);
    return std::string("123456Ff").find(letters[1]) == std::string::npos ? '\0' : letters[1];
  }

  std::string check(char kind) {
    const std::uint64_t width = number("a width", kMostSide);
    const std::uint64_t height = number("a height", kMostSide);
    const bool floats = kind == 'F' || kind == 'f';
    const std::uint64_t channels = kind == '3' || kind == '6' || kind == 'F' ? 3 : 1;
    if (floats) {
      check_factor();
      binary(width * height * channels * 4, [](const char*, std::size_t) {});
      return "none";
    }
    const std::uint64_t most = kind == '1' || kind == '4' ? 1 : number("a largest value", 65535);
    if (most == 0) fail("its largest value is 0");
    if (kind == '1')
      bits(width * height);
    else if (kind == '2' || kind == '3')
      for (std::uint64_t i = 0; i < width * height * channels; ++i) (void)number("a value", most);
    if (kind <= '3') {
      check_rest();
    } else {
      blank();
      if (kind == '4')
        binary((width + 7) / 8 * height, [](const char*, std::size_t) {});
      else
        binary(width * height * channels * (most > 255 ? 2 : 1),
               [&](const char* data, std::size_t size) { check_values(data, size, most); });
    }
    return fmt::format("{}", most);
  }

 private:
  static constexpr std::uint64_t kMostSide = std::uint64_t{1} << 24;

  [[noreturn]] void fail(const std::string& cause) const { throw Error(fmt::format("{}: {}", path_.string(), cause)); }

  /// Passes over blanks and comments.
  int next() {
    while (true) {
      int c = in_.get();
      if (c == '#')
        while (c != '\n' && c != '\r' && in_) c = in_.get();
      if (!in_ || !is_blank(c)) return in_ ? c : -1;
    }
  }

  std::string word(const char* what) {
    const int first = next();
    if (first < 0) fail(fmt::format("ends where {} is to be", what));
    std::string text(1, static_cast<char>(first));
    while (in_.peek() >= 0 && !is_blank(in_.peek()) && in_.peek() != '#' && text.size() < 64)
      text += static_cast<char>(in_.get());
    in_.clear();
    return text;
  }

  std::uint64_t number(const char* what, std::uint64_t most) {
    const std::string text = word(what);
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value > most)
      fail(fmt::format("\"{}\" is not {} from 0 to {}", one_line(text), what, most));
    return value;
  }

  /// Nothing follows but blanks, comments and an old end of a file.
  bool ended() {
    constexpr int kOldEnd = 0x1A;
    int c = next();
    while (c == kOldEnd) c = next();
    return c < 0;
  }

  void check_factor() {
    const std::string text = word("a factor");
    double factor = 0;
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), factor);
    if (error != std::errc() || end != text.data() + text.size())
      fail(fmt::format("\"{}\" is no factor", one_line(text)));
    if (std::abs(factor) != 1)
      fail(fmt::format("its values are to be multiplied by {}, which is not read without loss", text));
    blank();
  }

  /// The one blank in front of binary values.
  void blank() {
    if (!is_blank(in_.get())) fail("has no blank between its head and its values");
  }

  void bits(std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i)
      if (const int c = next(); c != '0' && c != '1')
        fail(c < 0 ? "is cut off" : "has a value that is neither 0 nor 1");
  }

  template <class See>
  void binary(std::uint64_t bytes, See see) {
    char data[1 << 14];  // an even number: values of two bytes stay whole
    for (std::uint64_t left = bytes; left > 0;) {
      const auto some = static_cast<std::size_t>(std::min<std::uint64_t>(left, sizeof data));
      if (!in_.read(data, static_cast<std::streamsize>(some))) fail("is cut off");
      see(data, some);
      left -= some;
    }
    if (!ended()) fail("has bytes behind its picture, which are not read");
  }

  void check_values(const char* data, std::size_t size, std::uint64_t most) const {
    if (most == 255 || most == 65535) return;
    const auto byte = [&](std::size_t i) { return static_cast<std::uint64_t>(static_cast<unsigned char>(data[i])); };
    const std::size_t step = most > 255 ? 2 : 1;
    for (std::size_t i = 0; i < size; i += step) {
      const std::uint64_t value = step == 2 ? byte(i) << 8U | byte(i + 1) : byte(i);
      if (value > most) fail(fmt::format("has the value {}, and its largest is {}", value, most));
    }
  }

  void check_rest() {
    if (!ended()) fail("has words behind its picture, which are not read");
  }

  std::filesystem::path path_;
  std::ifstream in_;
};

}  // namespace

std::optional<std::string> largest_of_pnm(const std::filesystem::path& path) {
  Netpbm file(path);
  const char kind = file.kind();
  if (kind == 0) return {};
  return file.check(kind);
}

}  // namespace kage::picture_plugin
