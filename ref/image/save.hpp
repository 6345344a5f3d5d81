// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "file/temp_file.hpp"
#include "kage/image.hpp"

namespace kage {

/// Writes a picture line by line, as PNG, or as EXR (float, 255 is 1.0), by the extension of `path`. Other extensions
/// are refused. The file has another name until it is committed; without that it is removed with the object. Throws
/// Error that names the file.
class ImageWriter {
 public:
  ImageWriter(const std::filesystem::path& path, int width, int height, int channels);
  ~ImageWriter();
  ImageWriter(const ImageWriter&) = delete;
  ImageWriter& operator=(const ImageWriter&) = delete;

  /// The next line from the top: width x channels bytes.
  void line(std::span<const std::uint8_t> pixels);

  /// All lines are written: the file is complete, and on the disk.
  void close();

  /// Where the complete file lies.
  [[nodiscard]] const std::filesystem::path& temp() const;

  /// The complete file is to get its name with the others of `files`.
  void hand_over(TempFiles& files);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// As save_image() of kage/image.hpp, but the picture gets its name with the others of `files`.
void save_image(TempFiles& files, const std::filesystem::path& path, const Image& image);

}  // namespace kage
