// SPDX-License-Identifier: Apache-2.0
// Draws the first frame of a stream file with the golden core: golden_consumer FILE.kage >picture.ppm
#include <cstdint>
#include <cstdio>
#include <exception>
#include <kage/core.hpp>
#include <kage/stream.hpp>
#include <span>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const kage::StreamFile file(argv[1]);
    const std::span<const std::uint32_t> words = file.frame(0);
    const kage::FrameHeader header = kage::FrameHeader::read(words);
    std::printf("P%c %d %d 255\n", file.config().channels == 3 ? '6' : '5', header.width, header.height);
    kage::GoldenCore core(file.config());
    const kage::FrameStatus status = core.frame(words, [](int, std::span<const std::uint8_t> pixels) {
      std::fwrite(pixels.data(), 1, pixels.size(), stdout);  // a line, top to bottom
    });
    return status.error == kage::ErrorCode::NONE ? 0 : 1;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
