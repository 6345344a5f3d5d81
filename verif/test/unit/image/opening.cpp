// SPDX-License-Identifier: Apache-2.0
// A small file of a large picture is refused before its reader has any of it, or after its head alone.
#include "image/opening.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "kage/diff.hpp"
#include "kage/error.hpp"
#include "test/support/catch.hpp"
#include "test/support/pictures.hpp"

using namespace kage;
using namespace kage::verif;

namespace {

namespace fs = std::filesystem;

std::string big(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = bytes; i-- > 0;) text += static_cast<char>(value >> 8 * i);
  return text;
}

fs::path put(const fs::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

constexpr std::uint64_t kMost = std::uint64_t{100} << 20;

std::string said(const fs::path& path) {
  try {
    DiffOptions options;
    options.max_bytes = kMost;
    (void)diff_files(path, path, options);
    return "read";
  } catch (const Error& e) {
    return e.what();
  }
}

}  // namespace

TEST_CASE("what decodes a picture as it opens it is asked for its size before") {
  const TempFolder folder("opening");
  const std::string codestream = "\xFF\x4F\xFF\x51" + big(41, 2) + big(0, 2) + big(8000, 4) + big(8000, 4) + big(0, 8) +
                                 big(8000, 4) + big(8000, 4) + big(0, 8) + big(1, 2) + std::string("\x07\x01\x01", 3);
  const std::pair<std::string, std::string> files[] = {
      {"a.gif", "GIF89a" + std::string("\xE0\x2E\xE0\x2E\0\0\0", 7)},
      {"a.jpg",
       "\xFF\xD8\xFF\xFF\xC2" + big(17, 2) + "\x08" + big(8000, 2) + big(8000, 2) + "\x03" + std::string(9, '\1')},
      {"a.j2k", codestream},
      {"a.jp2", std::string("\0\0\0\x0CjP  \r\n\x87\n", 12) + big(8 + (1U << 21U), 4) + "xml " +
                    std::string(std::size_t{1} << 21U, ' ') + big(0, 4) + "jp2c" + codestream},
      {"b.jpg", "\xFF\xD8\xFF\xCA" + big(17, 2) + "\x08" + big(8000, 2) + big(8000, 2) + "\x03" + std::string(9, '\1')},
      {"c.jpg", "\xFF\xD8\xFF\xC0" + big(17, 2) + "\x08" + big(8000, 2) + big(8000, 2) + "\x03" + std::string(9, '\1') +
                    "\xFF\xDA" + big(8, 2) + "\x01" + std::string(5, '\0')}};
  const std::uint64_t least[] = {std::uint64_t{4} * 12000 * 12000,   std::uint64_t{2} * 3 * 8000 * 8000,
                                 std::uint64_t{4} * 8000 * 8000,     std::uint64_t{4} * 8000 * 8000,
                                 std::uint64_t{2} * 3 * 8000 * 8000, std::uint64_t{2} * 3 * 8000 * 8000};
  std::size_t i = 0;
  for (const auto& [name, content] : files) {
    CAPTURE(name);
    const fs::path path = put(folder.path / name, content);
    CHECK(bytes_of_opening(path) >= least[i]);
    CHECK(bytes_of_opening(path) <= 4 * least[i]);
    CHECK_THAT(said(path), Catch::Matchers::StartsWith(path.string() + ": opening it takes "));
    ++i;
  }
  // A picture that comes in lines, a head that is cut off, and no picture at all.
  for (const std::string& content : {std::string("\x89PNG\r\n\x1a\n"), std::string("GIF89a"),
                                     std::string("\xFF\xD8\xFF\xC2"), std::string("\xFF\x4F\xFF\x51"), std::string()})
    CHECK(bytes_of_opening(put(folder.path / "b", content)) == 0);
}

TEST_CASE("blocks of an EXR's lines count, which its library keeps") {
  const TempFolder folder("opening-exr");
  constexpr int kWide = 8192;
  constexpr int kHigh = 256;
  OIIO::ImageSpec spec(kWide, kHigh, 4, OIIO::TypeDesc::FLOAT);
  const std::vector<float> values(std::size_t{4} * kWide * kHigh, 0.5F);
  spec.attribute("compression", "dwab");
  CHECK_THAT(said(write_picture(folder.path / "a.exr", spec, values.data())),
             Catch::Matchers::ContainsSubstring("to compare them takes"));
  spec.attribute("compression", "none");
  CHECK(said(write_picture(folder.path / "b.exr", spec, values.data())) == "read");
}
