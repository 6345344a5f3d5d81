// SPDX-License-Identifier: Apache-2.0
#include "vectors/check.hpp"

#include <fmt/format.h>

#include "cosim/model/sha256.hpp"
#include "file/plain_io.hpp"
#include "json/foreign_json.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "vectors/capture.hpp"
#include "vectors/texts.hpp"
#include "vectors/write.hpp"

namespace kage::vectors {
namespace {

std::string hash_of(const std::filesystem::path& path, const std::function<void()>& wait) {
  const ReadOnly in(path);
  cosim::Sha256 hash;
  std::vector<char> piece(1 << 20);
  while (const std::size_t n = in.read(piece.data(), piece.size())) {
    wait();
    hash.add_piece(std::span<const char>(piece.data(), n));
  }
  return hash.take();
}

void check_file(const std::filesystem::path& path, const PackFile& file, const std::function<void()>& wait) {
  std::error_code e;
  if (!std::filesystem::is_regular_file(path, e))
    throw Error(path.string() + ": the manifest names it, and it is not there");
  if (const auto bytes = std::filesystem::file_size(path); bytes != file.bytes)
    throw Error(fmt::format("{}: has {} bytes, the manifest says {}", path.string(), bytes, file.bytes));
  if (hash_of(path, wait) != file.sha256)
    throw Error(path.string() + ": is not the file that was written: its SHA-256 differs from the manifest's");
}

/// The pack is made once more of its words, and is the same.
void check_answers(const std::filesystem::path& folder, const Pack& pack, const std::function<void()>& wait) {
  PackWriter writer(pack.config);
  Pack again = pack;
  again.files.clear();
  for (std::size_t i = 0; i < pack.frames.size(); ++i) {
    const PackFrame& f = pack.frames[i];
    wait();
    const std::vector<std::uint32_t> words = words_of(folder, pack, i);
    const FrameStatus status = writer.frame(f.what, [&](const WordSink& sink) { sink(words); }).status;
    if (status != f.status)
      throw Error(fmt::format("{}: frame {}: the golden core ends it with {}, {} x {}, the manifest says {}, {} x {}",
                              (folder / kManifest).string(), i, describe(status), status.width, status.height,
                              describe(f.status), f.status.width, f.status.height));
  }
  again.reads = register_reads(pack.config, pack.frames);
  writer.finish(again);
  for (const PackFile& file : pack.files) {
    if (file.name == kReadme || file.name == kBench) continue;  // text, which another kage may put otherwise
    for (const PackFile& made : again.files)
      if (made.name == file.name && made.sha256 != file.sha256)
        throw Error(fmt::format("{}: is not what the pack's frames come to", (folder / file.name).string()));
  }
}

/// The words and pixels that the frames have, against the files, before any of it is read.
void check_sizes(const std::filesystem::path& manifest, const Pack& pack) {
  const auto bytes = [&](const char* name) {
    for (const PackFile& f : pack.files)
      if (f.name == name) return f.bytes;
    throw Error(fmt::format("{}: {} is missing among its files", manifest.string(), name));
  };
  const std::vector<PackFile> sizes = file_sizes(pack.config, pack.frames);
  for (const PackFile& f : sizes)
    if (f.name != kRegistersHex && bytes(f.name.c_str()) != f.bytes)
      throw Error(fmt::format("{}: its frames have {} bytes of {}, and the file {}", manifest.string(), f.bytes, f.name,
                              bytes(f.name.c_str())));
  for (const char* name : {kRegistersHex, kVerilogHeader, kCHeader, kReadme, kBench}) (void)bytes(name);
  for (const PackFrame& f : pack.frames)
    if (f.words > f.beats * static_cast<std::uint64_t>(pack.config.beat_words))
      throw Error(fmt::format("{}: {}: more words than its beats hold", manifest.string(), f.what));
}

}  // namespace

Pack checked_pack(const std::filesystem::path& folder, Check what, const std::function<void()>& wait) {
  const std::filesystem::path manifest = folder / kManifest;
  std::error_code e;
  if (!std::filesystem::is_regular_file(manifest, e)) throw Error(manifest.string() + ": is not there: no pack");
  Pack pack = pack_of(read_json(manifest), manifest.string());
  for (const PackFile& file : pack.files)
    if (std::filesystem::path(file.name).filename() != file.name)
      throw Error(fmt::format("{}: {} is a file outside the pack", manifest.string(), file.name));
  check_sizes(manifest, pack);
  const auto answer = [](const std::string& name) {
    return name == kStimulusBin || name == kPixelsBin || name == kSignaturesHex;
  };
  for (const PackFile& file : pack.files)
    if (what == Check::all || answer(file.name)) check_file(folder / file.name, file, wait);
  if (what == Check::all) check_answers(folder, pack, wait);
  return pack;
}

}  // namespace kage::vectors
