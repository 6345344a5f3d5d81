// SPDX-License-Identifier: Apache-2.0
#include "image/save.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "kage/error.hpp"

namespace kage {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string cause) {
  for (char& c : cause)
    if (c == '\n' || c == '\r') c = ' ';
  throw Error(fmt::format("{}: cannot be written{}{}", path.string(), cause.empty() ? "" : ": ", cause));
}

}  // namespace

void save_image(TempFiles& files, const std::filesystem::path& path, const Image& image) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool exr = extension == ".exr";
  if (!exr && extension != ".png") throw Error(fmt::format("{}: pictures are written as .png or .exr", path.string()));
  if (image.width <= 0 || image.height <= 0 || (image.channels != 1 && image.channels != 3) ||
      image.data.size() != image.index(0, image.height))
    throw Error(fmt::format("{}: a picture of {}x{} with {} channels cannot be written", path.string(), image.width,
                            image.height, image.channels));

  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::error_code ec;
  if (!std::filesystem::is_directory(folder, ec)) fail(path, "no such folder");

  const std::filesystem::path& temp = files.add(path);
  const auto output = OIIO::ImageOutput::create(extension.substr(1));
  if (!output) fail(path, OIIO::geterror());
  OIIO::ImageSpec spec(image.width, image.height, image.channels, exr ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  if (image.channels == 1) spec.channelnames = {"Y"};
  if (!output->open(temp.string(), spec)) fail(path, output->geterror());
  if (!output->write_image(OIIO::TypeDesc::UINT8, image.data.data())) fail(path, output->geterror());
  if (!output->close()) fail(path, output->geterror());
}

void save_image(const std::filesystem::path& path, const Image& image) {
  TempFiles file;
  save_image(file, path, image);
  file.commit();
}

}  // namespace kage
