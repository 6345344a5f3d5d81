// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "file/temp_file.hpp"
#include "kage/stream.hpp"
#include "vectors/pack.hpp"

namespace kage::vectors {

/// Writes a pack, frame by frame; memory does not grow with a frame. The files appear in `folder` with the others of
/// `files`. Throws Error where one cannot be written.
class PackWriter {
 public:
  PackWriter(const std::filesystem::path& folder, const Config& config, TempFiles& files);
  /// Writes nothing: finish() tells the lengths and hashes that the files would have.
  explicit PackWriter(const Config& config);
  ~PackWriter();
  PackWriter(const PackWriter&) = delete;
  PackWriter& operator=(const PackWriter&) = delete;

  /// A frame: `words_of` hands its words to the sink that it is given, in pieces of any size. Returns what it is.
  PackFrame frame(const std::string& what, const std::function<void(const WordSink&)>& words_of);

  /// Ends the pack: `pack` has all frames and reads; its files are filled in.
  void finish(Pack& pack);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kage::vectors
