// SPDX-License-Identifier: Apache-2.0
// Reading pictures of any format, by OpenImageIO.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <system_error>
#include <thread>

#include "file/read_file.hpp"
#include "image/file_bytes.hpp"
#include "image/plugin/lossless.hpp"
#include "image/plugin/pnm.hpp"
#include "image/plugin/table.hpp"
#include "image/plugin/tiff.hpp"
#include "image/plugin/webp.hpp"
#include "image/png_chunks.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"

namespace kage::picture_plugin {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& cause) {
  // OpenImageIO's messages may repeat the name and take several lines.
  std::string text = cause;
  for (const std::string& prefix : {path.string() + ": ", "\"" + path.string() + "\": "})
    if (const auto at = text.find(prefix); at != std::string::npos) text.erase(at, prefix.size());
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  if (text.rfind("OpenImageIO could not find a format reader", 0) == 0) text = "no format of pictures that is read";
  throw Error(fmt::format("{}: {}", path.string(), text.empty() ? "cannot be read" : text));
}

/// Calls `body`. OpenImageIO may let through what its own library throws; that becomes an Error with the file's name.
template <class Body>
auto without_foreign_throw(const std::filesystem::path& path, Body body) -> decltype(body()) {
  try {
    return body();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    fail(path, fmt::format("its reader ends by an error ({})", e.what()));
  }
}

Sample sample_of(const OIIO::TypeDesc& type, const std::filesystem::path& path) {
  switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
      return Sample::kU8;
    case OIIO::TypeDesc::INT8:
      return Sample::kI8;
    case OIIO::TypeDesc::UINT16:
      return Sample::kU16;
    case OIIO::TypeDesc::INT16:
      return Sample::kI16;
    case OIIO::TypeDesc::UINT32:
      return Sample::kU32;
    case OIIO::TypeDesc::INT32:
      return Sample::kI32;
    case OIIO::TypeDesc::UINT64:
      return Sample::kU64;
    case OIIO::TypeDesc::INT64:
      return Sample::kI64;
    case OIIO::TypeDesc::HALF:
      return Sample::kHalf;
    case OIIO::TypeDesc::FLOAT:
      return Sample::kFloat;
    case OIIO::TypeDesc::DOUBLE:
      return Sample::kDouble;
    default:
      fail(path, fmt::format("pixels of type {} cannot be compared", type.c_str()));
  }
}

/// One of the file's notes as text. Numbers are exact; what is long, as an ICC profile, is its size and checksum.
std::string note_text(const OIIO::ImageSpec& spec, const char* name) {
  const OIIO::ParamValue* const value = spec.find_attribute(name);
  if (value == nullptr) return "";
  if (value->datasize() > 256)
    return fmt::format(
        "{} bytes, CRC-32 {:08x}", value->datasize(),
        crc32_z(0, static_cast<const Bytef*>(value->data()), static_cast<std::size_t>(value->datasize())));
  if (value->type().basetype == OIIO::TypeDesc::FLOAT)
    return fmt::format("{}", fmt::join(static_cast<const float*>(value->data()),
                                       static_cast<const float*>(value->data()) + value->type().basevalues(), " "));
  return value->get_string();
}

/// Notes of a file's own head that OpenImageIO does not tell. A format that has no such note has none.
struct HeadNotes {
  std::string largest;  ///< PNM: the largest value
  std::string extra;    ///< TIFF: what the values beside the colours are
  std::string light;    ///< Radiance: lines that say how bright and of which colour a value is
  std::string space;    ///< BMP: a colour space other than that of a display
};

std::string light_of_radiance(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string all;
  for (std::string line; std::getline(in, line) && !line.empty();)
    for (const std::string_view name : {"EXPOSURE=", "COLORCORR=", "PRIMARIES=", "PIXASPECT="})
      if (line.starts_with(name)) all += (all.empty() ? "" : " ") + line;
  return all;
}

std::string space_of_bmp(const std::filesystem::path& path) {
  FileBytes file(path);
  constexpr std::uint32_t kVersion4 = 108;
  constexpr std::uint32_t kSrgb = 0x73524742;
  constexpr std::uint32_t kDisplay = 0x57696E20;
  const std::uint32_t size = file.little(14, 4);
  const std::uint32_t space = file.little(70, 4);
  if (size < kVersion4 || space == kSrgb || space == kDisplay) return "";
  const std::string numbers = file.text(74, 48);  // end points and gamma
  if (space == 0 && numbers == std::string(48, '\0')) return "";
  const std::string profile =
      size > kVersion4 ? file.text(std::uint64_t{14} + file.little(126, 4), file.little(130, 4)) : "";
  const std::string all = numbers + profile;
  return fmt::format("{:08x}, CRC-32 {:08x}", space,
                     crc32_z(0, reinterpret_cast<const Bytef*>(all.data()), all.size()));
}

/// The largest value that the format's integers can have.
std::string largest_value(const OIIO::ImageSpec& spec, int bits) {
  if (spec.format.is_floating_point()) return "none";
  const int all = bits == 0 ? static_cast<int>(spec.format.size() * 8) : bits;
  return fmt::format("{}", all >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << all) - 1);
}

constexpr int kCmyk = 5;
constexpr int kYcbcr = 6;

/// TIFF's number for what its values stand for; -1 for other formats.
int photometric(const OIIO::ImageSpec& spec) { return spec.get_int_attribute("tiff:PhotometricInterpretation", -1); }

/// In words. A palette's colours and those of JPEG compression come as red, green and blue, and are compared so.
std::string photometric_words(int number) {
  if (number == 0) return "white is 0";
  if (number == 1) return "black is 0";
  return number == kCmyk ? "CMYK" : "RGB";
}

/// Notes that change the meaning of the same numbers.
std::vector<Picture::Note> notes_of(const OIIO::ImageSpec& spec, const PngChunks& png, const HeadNotes& head,
                                    std::string_view format) {
  const int bits = spec.get_int_attribute("oiio:BitsPerSample", png.bits);
  const std::string chromaticities = note_text(spec, "chromaticities");
  const auto only = [&](std::string_view has, const std::string& text) {
    return format == has ? text : Picture::kNoPlace;
  };
  const auto all_but_pnm = [&](const std::string& text) { return format == "pnm" ? Picture::kNoPlace : text; };
  std::vector<Picture::Note> notes{
      {"display window", fmt::format("{}x{} at {},{}", spec.full_width, spec.full_height, spec.full_x, spec.full_y)},
      {"number of bits", fmt::format("{}", bits == 0 ? static_cast<int>(spec.format.size() * 8) : bits)},
      {"largest value", head.largest.empty() ? largest_value(spec, bits) : head.largest},
      {"extra samples", only("tiff", head.extra)},
      {"exposure", only("hdr", head.light)},
      {"BMP colour space", only("bmp", head.space)},
      {"photometric interpretation", only("tiff", photometric_words(photometric(spec)))},
      {"orientation", all_but_pnm(fmt::format("{}", spec.get_int_attribute("Orientation", 1)))},
      {"chromaticity", all_but_pnm(chromaticities.empty() ? png.chromaticities : chromaticities)},
      {"white luminance", all_but_pnm(note_text(spec, "whiteLuminance"))}};
  for (const auto& [words, name] :
       {std::pair{"colour space", "oiio:ColorSpace"}, {"gamma", "oiio:Gamma"}, {"ICC profile", "ICCProfile"}})
    notes.emplace_back(words, all_but_pnm(note_text(spec, name)));
  notes.emplace_back("gAMA", only("png", png.gamma));
  notes.emplace_back("rendering intent", only("png", png.intent));
  for (const auto& [words, text] : png.more) notes.emplace_back(words, all_but_pnm(text));
  notes.emplace_back("unassociated alpha", spec.alpha_channel < 0 ? "" : note_text(spec, "oiio:UnassociatedAlpha"));
  return notes;
}

/// Opens the file so that its values come as they are stored, or refuses it.
std::unique_ptr<OIIO::ImageInput> open_input(const std::filesystem::path& path) {
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  errno = 0;
  auto input = OIIO::ImageInput::open(path.string(), &hints);
  if (!input) {
    const int why = errno;  // which OpenImageIO leaves out
    const std::string said = OIIO::geterror();
    fail(path, why == EMFILE || why == ENFILE ? std::generic_category().message(why) : said);
  }
  refuse_lossy_format(path, input->format_name());
  const OIIO::ImageSpec& spec = input->spec();
  const int interpretation = photometric(spec);
  if (interpretation == kCmyk) {
    // Not for all files: of JPEG 2000 it would leave out which space the numbers are of.
    hints.attribute("oiio:RawColor", 1);
    input = OIIO::ImageInput::open(path.string(), &hints);
    if (!input) fail(path, OIIO::geterror());
    return input;
  }
  if (interpretation > kCmyk && !(interpretation == kYcbcr && spec.get_int_attribute("tiff:Compression") == 7)) {
    fail(path, fmt::format("has the photometric interpretation {}, which is not read without loss", interpretation));
  }
  const std::string jpeg(spec.get_string_attribute("jpeg:ColorSpace"));
  if (jpeg == "CMYK" || jpeg == "YCbCrK") fail(path, "is CMYK in a JPEG file, which is not read without loss");
  return input;
}

/// How many pictures the file holds.
int count_parts(OIIO::ImageInput& input) {
  int count = 1;
  while (input.seek_subimage(count, 0)) ++count;
  (void)input.geterror();
  (void)input.seek_subimage(0, 0);
  return count;
}

/// Goes to a picture of the file: its only one, or the one that was asked for.
void choose_part(OIIO::ImageInput& input, const std::filesystem::path& path, int part) {
  const int count = count_parts(input);
  if (part < 0 && count > 1)
    fail(path, fmt::format("holds {} pictures: choose one by its number, 0 to {}", count, count - 1));
  if (part >= count) fail(path, fmt::format("holds {}, and there is no number {}", counted(count, "picture"), part));
  if (part > 0 && !input.seek_subimage(part, 0)) fail(path, input.geterror());
}

/// The file's first picture, or the one that was asked for, described; its pixels are left out.
Picture described(OIIO::ImageInput& input, const std::filesystem::path& path, const PngChunks& png,
                  const HeadNotes& head) {
  const OIIO::ImageSpec& spec = input.spec();
  if (spec.deep || spec.depth > 1) fail(path, "is not a flat picture");
  Picture picture;
  picture.x = spec.x;
  picture.y = spec.y;
  picture.width = spec.width;
  picture.height = spec.height;
  for (int c = 0; c < spec.nchannels; ++c) {
    const Sample sample = sample_of(spec.channelformat(c), path);
    picture.channels.push_back({std::string(spec.channel_name(c)), sample, picture.pixel_bytes});
    picture.pixel_bytes += size_of(sample);
  }
  picture.alpha = spec.alpha_channel;
  // In a GIF it is a number behind the last channel.
  if (picture.alpha >= spec.nchannels) picture.alpha = spec.channelindex("A");
  picture.notes = notes_of(spec, png, head, input.format_name());
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0)
    fail(path, fmt::format("size {}x{} with {} channels is refused", spec.width, spec.height, spec.nchannels));
  return picture;
}

/// Formats that OpenImageIO reads line by line, and keeps nothing of what it has read.
bool comes_in_lines(std::string_view format, const OIIO::ImageSpec& spec, const PngChunks& png) {
  if (format == "png") return !png.interlaced;
  return (format == "openexr" || format == "hdr" || format == "dpx") && spec.tile_width == 0;
}

/// Bytes that OpenEXR has for blocks of lines, some of them in work at a time: as they are stored, decoded, and
/// between.
std::uint64_t bytes_of_blocks(const OIIO::ImageSpec& spec) {
  const std::string kind(spec.get_string_attribute("compression"));
  std::uint64_t lines = 1;
  if (kind == "zip" || kind == "pxr24") lines = 16;
  if (kind == "piz" || kind == "b44" || kind == "b44a" || kind == "dwaa") lines = 32;
  if (kind == "dwab") lines = 256;
  const std::uint64_t height = static_cast<std::uint64_t>(std::max(spec.height, 1));
  const std::uint64_t at_once =
      std::min<std::uint64_t>((height + lines - 1) / lines, std::uint64_t{2} * std::thread::hardware_concurrency());
  constexpr std::uint64_t kForms = 4;
  return kForms * at_once * std::min(lines, height) * spec.scanline_bytes(true);
}

/// Any file that OpenImageIO reads without loss.
class FileReader : public PictureReader {
 public:
  FileReader(const std::filesystem::path& path, int part) : path_(path), part_(std::max(part, 0)) {
    const std::optional<std::string> largest = largest_of_pnm(path);
    input_ = open_input(path);
    choose_part(*input_, path, part);
    const std::string_view format = input_->format_name();
    const PngChunks png = read_png_chunks(path);
    if (png.animated) fail(path, "is animated: only files of one picture are compared");
    HeadNotes notes;
    if (largest) notes.largest = *largest;
    if (format == "pnm" && !largest) fail(path, "is a Netpbm file of no kind that is read");
    if (format == "tiff") notes.extra = check_tiff_head(path, part_);
    if (format == "hdr") notes.light = light_of_radiance(path);
    if (format == "bmp") notes.space = space_of_bmp(path);
    head_ = described(*input_, path, png, notes);
    spec_ = input_->spec();
    if (png.profile && spec_.find_attribute("ICCProfile") == nullptr) fail(path, "has an ICC profile that is damaged");
    if (input_->seek_subimage(part_, 1))
      fail(path, "holds several sizes (a mipmap): only files of one picture are compared");
    (void)input_->geterror();
    if (!input_->seek_subimage(part_, 0)) fail(path, input_->geterror());
    if (!comes_in_lines(format, spec_, png)) own_bytes_ = spec_.image_bytes(true);
    if (format == "openexr" && spec_.tile_width == 0) own_bytes_ = bytes_of_blocks(spec_);
    constexpr int kJpeg = 7;  // comes as a whole, with alpha
    if (spec_.get_int_attribute("tiff:Compression") == kJpeg) own_bytes_ += 5 * spec_.image_pixels();
    constexpr std::uint64_t kStepBytes = std::uint64_t{1} << 20;
    step_ = static_cast<int>(std::clamp<std::uint64_t>(kStepBytes / std::max<std::uint64_t>(line_bytes(), 1), 1, 1024));
    if (spec_.tile_height > 0) step_ = (step_ + spec_.tile_height - 1) / spec_.tile_height * spec_.tile_height;
    // OpenImageIO reads zeros for one line of doubles of a TIFF, so there is never one left alone.
    if (format == "tiff" && spec_.format == OIIO::TypeDesc::DOUBLE) step_ = spec_.height;
  }

  void read(int y, int count, std::byte* to) override {
    if (y == 0 && input_->format_name() == std::string_view("tiff")) check_tiff_lines(path_, part_);
    const int from = spec_.y + y;
    // Without a type each channel keeps its own: one for all would round the integers of a file that has floats too.
    const OIIO::TypeDesc own = OIIO::TypeDesc::UNKNOWN;
    const bool done = without_foreign_throw(path_, [&] {
      return spec_.tile_width > 0
                 ? input_->read_tiles(part_, 0, spec_.x, spec_.x + spec_.width, from, from + count, spec_.z,
                                      spec_.z + 1, 0, spec_.nchannels, own, to)
                 : input_->read_scanlines(part_, 0, from, from + count, spec_.z, 0, spec_.nchannels, own, to);
    });
    if (!done) fail(path_, input_->geterror());
  }

 private:
  std::filesystem::path path_;
  int part_;
  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec spec_;
};

/// A WebP file, all of it at once: OpenImageIO says what it holds, and its own library gives the pixels.
class WebpReader : public PictureReader {
 public:
  WebpReader(const std::filesystem::path& path, int part) : path_(path), file_(read_file(path)) {
    webp_ = webp_head(path, bytes());
    const auto input = open_input(path);
    choose_part(*input, path, part);
    OIIO::ImageSpec spec(webp_.width, webp_.height, webp_.alpha ? 4 : 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    if (webp_.alpha) spec.attribute("oiio:UnassociatedAlpha", 1);
    if (!webp_.profile.empty())
      spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(webp_.profile.size())),
                     webp_.profile.data());
    spec.attribute("Orientation", webp_.orientation);
    head_.width = webp_.width;
    head_.height = webp_.height;
    head_.pixel_bytes = static_cast<std::size_t>(spec.nchannels);
    for (std::size_t c = 0; c < head_.pixel_bytes; ++c) head_.channels.push_back({{"RGBA"[c]}, Sample::kU8, c});
    head_.alpha = webp_.alpha ? 3 : -1;
    head_.notes = notes_of(spec, {}, {}, "webp");
    step_ = webp_.height;
    own_bytes_ = (line_bytes() + (webp_.alpha ? 0U : 4U * static_cast<std::uint64_t>(webp_.width))) *
                 static_cast<std::uint64_t>(webp_.height);
  }

  void read(int y, int count, std::byte* to) override {
    if (y != 0 || count != webp_.height) fail(path_, "is read as a whole");
    webp_pixels(path_, bytes(), webp_, {to, line_bytes() * static_cast<std::size_t>(count)});
  }

 private:
  [[nodiscard]] std::span<const unsigned char> bytes() const {
    return {reinterpret_cast<const unsigned char*>(file_.data()), file_.size()};
  }

  std::filesystem::path path_;
  std::string file_;
  WebpHead webp_;
};

bool is_webp(const std::filesystem::path& path) {
  std::array<char, 12> begin{};
  std::ifstream in(path, std::ios::binary);
  return in.read(begin.data(), begin.size()) && std::string_view(begin.data(), 4) == "RIFF" &&
         std::string_view(begin.data() + 8, 4) == "WEBP";
}

}  // namespace

std::unique_ptr<PictureReader> open(const std::filesystem::path& path, int part) {
  refuse_lossy_file(path);
  return without_foreign_throw(path, [&]() -> std::unique_ptr<PictureReader> {
    if (is_webp(path)) return std::make_unique<WebpReader>(path, part);
    return std::make_unique<FileReader>(path, part);
  });
}

}  // namespace kage::picture_plugin
