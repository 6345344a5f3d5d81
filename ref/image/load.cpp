// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "file/regular_file.hpp"
#include "image/encoder.hpp"
#include "image/memory.hpp"
#include "image/opening.hpp"
#include "image/picture.hpp"
#include "image/plugin/table.hpp"
#include "image/png_reader.hpp"
#include "kage/error.hpp"
#include "kage/image.hpp"
#include "plugin/foreign_code.hpp"

namespace kage {

std::size_t size_of(Sample sample) {
  switch (sample) {
    case Sample::kU8:
    case Sample::kI8:
      return 1;
    case Sample::kU16:
    case Sample::kI16:
    case Sample::kHalf:
      return 2;
    case Sample::kU32:
    case Sample::kI32:
    case Sample::kFloat:
      return 4;
    case Sample::kU64:
    case Sample::kI64:
    case Sample::kDouble:
      return 8;
  }
  return 0;
}

const char* name_of(Sample sample) {
  static constexpr const char* kNames[] = {"uint8",  "int8",  "uint16", "int16", "uint32", "int32",
                                           "uint64", "int64", "half",   "float", "double"};
  return kNames[static_cast<std::size_t>(sample)];
}

bool is_float(Sample sample) { return sample >= Sample::kHalf; }

std::string channel_names(const Picture& picture) {
  std::vector<std::string> names;
  for (const Picture::Channel& c : picture.channels)
    names.push_back(c.name.find_first_of(",\"\n\r") == std::string::npos && !c.name.empty()
                        ? c.name
                        : nlohmann::json(c.name).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  return fmt::format("{}", fmt::join(names, ","));
}

std::string sample_names(const Picture& picture) {
  std::vector<std::string> names;
  for (const Picture::Channel& c : picture.channels) names.emplace_back(name_of(c.sample));
  if (std::adjacent_find(names.begin(), names.end(), std::not_equal_to<>()) == names.end()) names.resize(1);
  return fmt::format("{}", fmt::join(names, ","));
}

std::string unlike(const Picture& a, const Picture& b) {
  const auto both = [](const std::string& what, const std::string& in_a, const std::string& in_b) {
    const auto said = [](const std::string& text) { return text.empty() ? "none" : text; };
    return fmt::format("{} unlike: {} and {}", what, said(in_a), said(in_b));
  };
  if (a.width != b.width || a.height != b.height)
    return both("sizes are", fmt::format("{}x{}", a.width, a.height), fmt::format("{}x{}", b.width, b.height));
  if (a.x != b.x || a.y != b.y)
    return both("origins are", fmt::format("{},{}", a.x, a.y), fmt::format("{},{}", b.x, b.y));
  // Channel by channel: names may hold what the words join them by, and types that are all alike are said once.
  const auto alike = [&](const auto& part) {
    return std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(), b.channels.end(),
                      [&](const Picture::Channel& x, const Picture::Channel& y) { return part(x) == part(y); });
  };
  if (!alike([](const Picture::Channel& c) -> const std::string& { return c.name; }))
    return both("channels are", channel_names(a), channel_names(b));
  if (!alike([](const Picture::Channel& c) { return c.sample; }))
    return both("pixel types are", sample_names(a), sample_names(b));
  for (std::size_t i = 0; i < a.notes.size(); ++i)
    if (a.notes[i] != b.notes[i] && a.notes[i].second != Picture::kNoPlace && b.notes[i].second != Picture::kNoPlace)
      return both(a.notes[i].first + " is", a.notes[i].second, b.notes[i].second);
  return "";
}

std::unique_ptr<PictureReader> open_picture(const std::filesystem::path& path, int part,
                                            std::optional<std::uint64_t> max_bytes) {
  check_regular(path);
  if (const std::uint64_t bytes = bytes_of_opening(path); bytes > 0)
    check_memory(fmt::format("{}: opening it takes", path.string()).c_str(), bytes, max_bytes);
  const ForeignCode mark(path.string() + ": reading it");
  if (!has_plugin(PicturePlugin::kPlugin) && is_png(path)) return open_png(path, part, max_bytes);
  return plugin_table<PicturePlugin>().open(path, part);
}

Picture whole_picture(PictureReader& reader) {
  Picture picture = reader.head();
  const std::uint64_t line = reader.line_bytes();
  const ForeignCode mark("reading a picture");
  picture.data.resize(line * static_cast<std::uint64_t>(picture.height));
  for (int y = 0; y < picture.height; y += reader.step())
    reader.read(y, std::min(reader.step(), picture.height - y),
                picture.data.data() + line * static_cast<std::uint64_t>(y));
  return picture;
}

Picture load_picture(const std::filesystem::path& path, int part, std::optional<std::uint64_t> max_bytes) {
  const auto reader = open_picture(path, part, max_bytes);
  const Picture& head = reader->head();
  check_memory(fmt::format("{}: {}x{} pixels take", path.string(), head.width, head.height).c_str(),
               reader->own_bytes() + reader->line_bytes() * static_cast<std::uint64_t>(head.height), max_bytes);
  return whole_picture(*reader);
}

std::unique_ptr<ImageEncoder> encode_exr(OutputFile& out, const std::string& name, int width, int height,
                                         int channels) {
  return plugin_table<PicturePlugin>().encode_exr(out, name, width, height, channels);
}

Image load_image(const std::filesystem::path& path) {
  const Picture picture = load_picture(path);
  const std::size_t channels = picture.channels.size();
  if (sample_names(picture) != name_of(Sample::kU8) || (channels != 1 && channels != 3))
    throw Error(
        fmt::format("{}: has {} channels of {}, not 1 or 3 of uint8", path.string(), channels, sample_names(picture)));
  Image image(picture.width, picture.height, static_cast<int>(channels));
  std::memcpy(image.data.data(), picture.data.data(), image.data.size());
  return image;
}

}  // namespace kage
