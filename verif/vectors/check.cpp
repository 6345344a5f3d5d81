// SPDX-License-Identifier: Apache-2.0
#include "vectors/check.hpp"

#include <fmt/format.h>

#include <fstream>

#include "cosim/model/sha256.hpp"
#include "file/read_file.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "vectors/texts.hpp"

namespace kage::vectors {
namespace {

std::string hash_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path.string() + ": cannot be read");
  cosim::Sha256 hash;
  std::vector<char> piece(1 << 20);
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0)
    hash.add_piece(std::span<const char>(piece.data(), static_cast<std::size_t>(in.gcount())));
  return hash.take();
}

void check_file(const std::filesystem::path& path, const PackFile& file) {
  std::error_code e;
  if (!std::filesystem::is_regular_file(path, e))
    throw Error(path.string() + ": the manifest names it, and it is not there");
  if (const auto bytes = std::filesystem::file_size(path); bytes != file.bytes)
    throw Error(fmt::format("{}: has {} bytes, the manifest says {}", path.string(), bytes, file.bytes));
  if (hash_of(path) != file.sha256)
    throw Error(path.string() + ": is not the file that was written: its SHA-256 differs from the manifest's");
}

/// The golden core plays the pack once more.
void check_pixels(const std::filesystem::path& folder, const Pack& pack) {
  GoldenCore golden(pack.config);
  std::ifstream words(folder / kStimulusBin, std::ios::binary);
  std::ifstream pixels(folder / kPixelsBin, std::ios::binary);
  std::vector<char> bytes;
  for (std::size_t i = 0; i < pack.frames.size(); ++i) {
    const PackFrame& f = pack.frames[i];
    const auto place = [&](int y) {
      return fmt::format("{}: frame {}, line {}", (folder / kPixelsBin).string(), i, y);
    };
    const LineSink sink = [&](int y, std::span<const std::uint8_t> line) {
      bytes.resize(line.size());
      pixels.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      if (pixels.gcount() != static_cast<std::streamsize>(line.size())) throw Error(place(y) + " is not there");
      for (std::size_t at = 0; at < line.size(); ++at)
        if (static_cast<std::uint8_t>(bytes[at]) != line[at])
          throw Error(fmt::format("{}, x {}, channel {}: {} is not what the golden core draws, {}", place(y),
                                  at / static_cast<std::size_t>(pack.config.channels),
                                  at % static_cast<std::size_t>(pack.config.channels),
                                  static_cast<int>(static_cast<std::uint8_t>(bytes[at])), static_cast<int>(line[at])));
    };
    std::vector<std::uint32_t> frame(f.beats * static_cast<std::uint64_t>(pack.config.beat_words));
    bytes.resize(4 * frame.size());
    words.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (words.gcount() != static_cast<std::streamsize>(bytes.size()) || f.words > frame.size())
      throw Error(fmt::format("{}: frame {} is not there whole", (folder / kStimulusBin).string(), i));
    for (std::size_t w = 0; w < frame.size(); ++w)
      for (std::size_t b = 4; b-- > 0;) frame[w] = frame[w] << 8 | static_cast<std::uint8_t>(bytes[4 * w + b]);
    frame.resize(f.words);
    golden.feed(frame, sink);
    if (const FrameStatus status = golden.finish(sink); status != f.status)
      throw Error(fmt::format("{}: frame {}: the golden core ends it with {}, {} x {}, the manifest says {}, {} x {}",
                              (folder / kManifest).string(), i, describe(status), status.width, status.height,
                              describe(f.status), f.status.width, f.status.height));
  }
  if (pixels.peek() != std::ifstream::traits_type::eof() || words.peek() != std::ifstream::traits_type::eof())
    throw Error(folder.string() + ": words or pixels go on behind the last frame");
}

}  // namespace

Pack checked_pack(const std::filesystem::path& folder) {
  const std::filesystem::path manifest = folder / kManifest;
  std::error_code e;
  if (!std::filesystem::is_regular_file(manifest, e)) throw Error(manifest.string() + ": is not there: no pack");
  Json json;
  try {
    json = Json::parse(read_file(manifest));
  } catch (const Json::exception& wrong) {
    throw Error(fmt::format("{}: not JSON: {}", manifest.string(), wrong.what()));
  }
  Pack pack = pack_of(json, manifest.string());
  for (const PackFile& file : pack.files) {
    if (std::filesystem::path(file.name).filename() != file.name)
      throw Error(fmt::format("{}: {} is a file outside the pack", manifest.string(), file.name));
    check_file(folder / file.name, file);
  }
  for (const char* name : {kStimulusHex, kStimulusBin, kPixelsHex, kPixelsBin, kSignaturesHex, kFramesHex,
                           kRegistersHex, kVerilogHeader, kCHeader, kReadme, kBench}) {
    bool there = false;
    for (const PackFile& file : pack.files) there = there || file.name == name;
    if (!there) throw Error(fmt::format("{}: {} is missing among its files", manifest.string(), name));
  }
  check_pixels(folder, pack);
  return pack;
}

}  // namespace kage::vectors
