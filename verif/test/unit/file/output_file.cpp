// SPDX-License-Identifier: Apache-2.0
// Bytes that are written in pieces of any size are in the file, in order: also when pieces fill the buffer to its
// last byte.
#include "file/output_file.hpp"

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "file/read_file.hpp"
#include "test/support/catch.hpp"
#include "test/support/temp_directory.hpp"

using namespace kage;

namespace {

/// Writes pieces of these sizes to a file, and returns what is in it; `all`: what it must be.
std::string written(const std::vector<std::size_t>& sizes, std::string& all) {
  const kage::test::TempDirectory folder;
  const std::filesystem::path path = folder.path() / "file";
  {
    OutputFile out(path, path.string());
    char next = 0;
    for (const std::size_t size : sizes) {
      std::string piece(size, 0);
      for (char& c : piece) c = next = static_cast<char>(next * 5 + 3);
      all += piece;
      out.write(piece.data(), static_cast<std::streamsize>(piece.size()));
    }
    out.close();
  }
  return read_file(path);
}

}  // namespace

TEST_CASE("Pieces come out in order", "[output_file]") {
  constexpr std::size_t kBuffer = std::size_t{1} << 16;
  // The last piece fills what is left, or is one byte more or less.
  for (const std::size_t first : {std::size_t{1}, std::size_t{16}, kBuffer / 2, kBuffer - 1, kBuffer}) {
    for (const int more : {-1, 0, 1}) {
      std::string all;
      const std::size_t rest = kBuffer - first % kBuffer;
      const bool same = written({first, rest + static_cast<std::size_t>(more), 7}, all) == all;
      CHECK(same);
    }
  }
  for (const std::size_t size : {std::size_t{16}, std::size_t{1} << 10, kBuffer, 3 * kBuffer}) {
    std::string all;
    const bool same = written(std::vector<std::size_t>(5000 / (size / 16) + 3, size), all) == all;
    CHECK(same);
  }
  std::mt19937 dice(20261126);
  std::vector<std::size_t> sizes;
  for (int i = 0; i < 3000; ++i) sizes.push_back(dice() % 4 == 0 ? dice() % (2 * kBuffer) : dice() % 300);
  std::string all;
  const bool same = written(sizes, all) == all;
  CHECK(same);
}
