// SPDX-License-Identifier: Apache-2.0
//
// A pack of test vectors: what goes into a core and what must come out, for those who have a simulator or a board but
// no kage. docs/vectors.md says what each file holds.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cosim/report/run_record.hpp"
#include "kage/config.hpp"
#include "kage/core.hpp"

namespace kage::vectors {

using report::Json;

/// Rises when a file of a pack changes its form or meaning: then an older kage must refuse the pack, and says so.
inline constexpr std::string_view kPackSchema = "kage.pack/1";
inline constexpr const char* kManifest = "manifest.json";

/// A frame of a pack.
struct PackFrame {
  std::string what;         ///< where it comes from: "courtyard, frame 0", "malformed: ORDER"
  std::uint64_t words = 0;  ///< of 32 bits, without those that fill the last beat
  std::uint64_t beats = 0;
  std::vector<std::size_t> source_lines;  ///< that --budget took of the scene's frame; empty: all
  FrameStatus status;                     ///< as the golden core ends it: error, and the size that leaves
  bool settles = false;                   ///< the registers are read behind it, before the next frame comes
  std::uint64_t clocks = 0;               ///< that the RTL took for it alone, without stalls; 0: it was not asked

  [[nodiscard]] std::uint64_t lines() const { return static_cast<std::uint64_t>(status.height); }
  [[nodiscard]] std::uint64_t pixels() const { return lines() * static_cast<std::uint64_t>(status.width); }
};

/// A register to be read: behind a frame that settles, once its pixels have come.
struct RegisterRead {
  std::uint64_t frame = 0;    ///< of the pack, from 0
  std::string name;           ///< "ERRORS"
  std::uint32_t address = 0;  ///< in bytes
  std::uint32_t mask = 0;     ///< bits that are known
  std::uint32_t value = 0;    ///< those bits
};

/// A file of a pack.
struct PackFile {
  std::string name;
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// All that a manifest says.
struct Pack {
  std::string scene;  ///< name of a built-in scene, or a file
  std::string config_name;
  Config config;
  std::string made_by;             ///< "kage 0.1.0 (1234abc)"
  std::optional<bool> rtl_agrees;  ///< the RTL has played it and drew the same; none: it was not asked
  std::uint64_t seed = 0;          ///< of what is random: the malformed frames
  std::vector<PackFrame> frames;
  std::vector<RegisterRead> reads;
  std::vector<PackFile> files;  ///< all but the manifest

  [[nodiscard]] std::uint64_t beats() const;
  [[nodiscard]] std::uint64_t lines() const;
  [[nodiscard]] std::uint64_t pixels() const;
  [[nodiscard]] std::uint64_t clocks() const;
  [[nodiscard]] std::uint64_t malformed() const;  ///< frames with an error
};

/// The paths of all files of the pack in that folder, the manifest among them.
std::vector<std::string> files_of(const std::filesystem::path& folder, const Pack& pack);

/// Expected values of the registers behind the frames that settle, by how the frames end; behind the last one all
/// constants too. The registers are those of a core that got nothing but these frames since reset.
std::vector<RegisterRead> register_reads(const Config& config, std::span<const PackFrame> frames);

/// The bytes of each file that grows with the frames, before anything is written; the others have some 30 kB, and
/// kage_pack.h 12 bytes a line besides.
std::vector<PackFile> file_sizes(const Config& config, std::span<const PackFrame> frames);

/// The CRC-32 of a line, as zlib has it: of each pixel its channels, and a byte with TLAST in bit 0 and TUSER in bit 1.
class LineSignature {
 public:
  void pixel(std::span<const std::uint8_t> channels, bool user, bool last);
  [[nodiscard]] std::uint32_t value() const { return crc_; }

 private:
  std::uint32_t crc_ = 0;
};

/// The manifest as JSON, and back. Throws Error that names `where` and the key.
Json to_json(const Pack& pack);
Pack pack_of(const Json& manifest, const std::string& where);

}  // namespace kage::vectors
