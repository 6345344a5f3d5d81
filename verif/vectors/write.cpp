// SPDX-License-Identifier: Apache-2.0
#include "vectors/write.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cosim/model/sha256.hpp"
#include "file/output_file.hpp"
#include "file/read_file.hpp"
#include "json/json_text.hpp"
#include "kage/core.hpp"
#include "kage/paths.hpp"
#include "vectors/texts.hpp"

namespace kage::vectors {
namespace {

/// A file of the pack that is being written, with its hash.
class Counted {
 public:
  /// Without `files` nothing is written but the hash.
  Counted(TempFiles* files, const std::filesystem::path& folder, std::string name) : name_(std::move(name)) {
    if (files != nullptr) out_ = std::make_unique<OutputFile>(*files, folder / name_);
  }

  void write(std::string_view bytes) {
    if (out_) out_->write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    hash_.add_piece(std::span<const char>(bytes.data(), bytes.size()));
    bytes_ += bytes.size();
  }
  PackFile close() {
    if (out_) out_->close();
    return {name_, bytes_, hash_.take()};
  }

 private:
  std::string name_;
  std::unique_ptr<OutputFile> out_;
  cosim::Sha256 hash_;
  std::uint64_t bytes_ = 0;
};

}  // namespace

struct PackWriter::Data {
  Data(const std::filesystem::path& to, const Config& c, TempFiles* f)
      : folder(to),
        config(c),
        files(f),
        golden(c),
        stimulus_hex(f, to, kStimulusHex),
        stimulus_bin(f, to, kStimulusBin),
        pixels_hex(f, to, kPixelsHex),
        pixels_bin(f, to, kPixelsBin),
        signatures_hex(f, to, kSignaturesHex) {}

  /// Beats as far as they are whole; `last`: the frame ends, so the one at hand is filled with zeros.
  void put_beats(bool last) {
    const auto width = static_cast<std::size_t>(config.beat_words);
    if (last) held.resize((held.size() + width - 1) / width * width);
    // The frame's last beat has TLAST, so one is kept back until it is known not to be that.
    std::size_t beats = held.size() / width;
    if (!last && beats > 0) --beats;
    text.clear();
    for (std::size_t b = 0; b < beats; ++b) {
      const std::span<const std::uint32_t> beat = std::span(held).subspan(b * width, width);
      text += last && b + 1 == beats ? '1' : '0';
      for (std::size_t w = width; w-- > 0;) text += fmt::format("{:08x}", beat[w]);
      text += '\n';
    }
    stimulus_hex.write(text);
    text.clear();
    for (const std::uint32_t word : std::span(held).first(beats * width))
      for (int byte = 0; byte < 4; ++byte) text += static_cast<char>(word >> 8 * byte & 0xFF);
    stimulus_bin.write(text);
    held.erase(held.begin(), held.begin() + static_cast<std::ptrdiff_t>(beats * width));
    frame.beats += beats;
  }

  void put_line(int y, std::span<const std::uint8_t> pixels) {
    const auto channels = static_cast<std::size_t>(config.channels);
    LineSignature signature;
    text.clear();
    for (std::size_t at = 0; at < pixels.size(); at += channels) {
      const std::span<const std::uint8_t> pixel = pixels.subspan(at, channels);
      const bool user = y == 0 && at == 0;
      const bool last = at + channels == pixels.size();
      signature.pixel(pixel, user, last);
      text += static_cast<char>('0' + (user ? 2 : 0) + (last ? 1 : 0));
      for (std::size_t c = channels; c-- > 0;) text += fmt::format("{:02x}", pixel[c]);
      text += '\n';
    }
    pixels_hex.write(text);
    pixels_bin.write({reinterpret_cast<const char*>(pixels.data()), pixels.size()});
    signatures.push_back(signature.value());
    signatures_hex.write(fmt::format("{:08x}\n", signature.value()));
  }

  std::filesystem::path folder;
  Config config;
  TempFiles* files;
  GoldenCore golden;
  Counted stimulus_hex, stimulus_bin, pixels_hex, pixels_bin, signatures_hex;
  std::vector<std::uint32_t> held;  // words of the beats that have not been written
  std::vector<std::uint32_t> signatures;
  std::string text;
  PackFrame frame;
};

PackWriter::PackWriter(const std::filesystem::path& folder, const Config& config, TempFiles& files)
    : data_(std::make_unique<Data>(folder, config, &files)) {}
PackWriter::PackWriter(const Config& config) : data_(std::make_unique<Data>("", config, nullptr)) {}
PackWriter::~PackWriter() = default;

PackFrame PackWriter::frame(const std::string& what, const std::function<void(const WordSink&)>& words_of) {
  Data& d = *data_;
  d.frame = {};
  d.frame.what = what;
  d.held.clear();
  const LineSink lines = [&](int y, std::span<const std::uint8_t> pixels) { d.put_line(y, pixels); };
  words_of([&](std::span<const std::uint32_t> words) {
    d.frame.words += words.size();
    d.held.insert(d.held.end(), words.begin(), words.end());
    d.put_beats(false);
    d.golden.feed(words, lines);
  });
  d.put_beats(true);
  d.frame.status = d.golden.finish(lines);
  return d.frame;
}

void PackWriter::finish(Pack& pack) {
  Data& d = *data_;
  for (Counted* file : {&d.stimulus_hex, &d.stimulus_bin, &d.pixels_hex, &d.pixels_bin, &d.signatures_hex})
    pack.files.push_back(file->close());
  const auto put = [&](const char* name, const std::string& text) {
    Counted file(d.files, d.folder, name);
    file.write(text);
    pack.files.push_back(file.close());
  };
  put(kFramesHex, frames_hex(pack));
  put(kRegistersHex, registers_hex(pack));
  put(kVerilogHeader, verilog_header(pack));
  put(kCHeader, c_header(pack, d.signatures));
  put(kReadme, readme(pack));
  put(kBench, read_file(data_directory() / "verif/vectors/bench" / kBench));
  if (d.files != nullptr) write_text(*d.files, (d.folder / kManifest).string(), json_text(to_json(pack), 2) + "\n");
}

}  // namespace kage::vectors
