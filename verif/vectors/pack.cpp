// SPDX-License-Identifier: Apache-2.0
#include "vectors/pack.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <functional>
#include <limits>
#include <numeric>

#include "json/json_text.hpp"
#include "kage/defs.hpp"
#include "kage/error.hpp"
#include "kage/registers.h"
#include "vectors/texts.hpp"

namespace kage::vectors {
namespace {

constexpr std::uint32_t kAll = 0xFFFFFFFF;

template <class T, class F>
std::uint64_t sum(const std::vector<T>& list, F of) {
  return std::accumulate(list.begin(), list.end(), std::uint64_t{0},
                         [&](std::uint64_t s, const T& item) { return s + std::invoke(of, item); });
}

Json frame_json(const PackFrame& f) {
  Json j{{"what", f.what},
         {"words", f.words},
         {"beats", f.beats},
         {"width", f.status.width},
         {"height", f.status.height},
         {"error", kErrorNames.at(static_cast<std::size_t>(f.status.error))}};
  if (f.status.error != ErrorCode::NONE) {
    j["error_frame"] = f.status.frame;
    j["error_line"] = f.status.line;
    j["error_token"] = f.status.token;
    j["error_unit"] = f.status.unit;
  }
  j["source_lines"] = f.source_lines.empty() ? Json(nullptr) : Json(f.source_lines);
  j["registers_are_read"] = f.settles;
  j["clocks"] = f.clocks == 0 ? Json(nullptr) : Json(f.clocks);
  return j;
}

/// Reads values of a manifest, and knows their place for messages.
class Reader {
 public:
  Reader(const Json& json, std::string where) : json_(&json), where_(std::move(where)) {
    if (!json.is_object()) throw Error(where_ + ": not an object");
  }

  template <class T>
  T get(const char* key) const {
    try {
      return at(key).get<T>();
    } catch (const Json::exception&) {
      throw Error(fmt::format("{}: {} is {}, which cannot be", where_, key, json_text(at(key))));
    }
  }
  [[nodiscard]] std::uint64_t number(const char* key, std::uint64_t most) const { return number(key, at(key), most); }
  [[nodiscard]] std::uint64_t number(const char* key, const Json& j, std::uint64_t most) const {
    if (!j.is_number_unsigned() || j.get<std::uint64_t>() > most)
      throw Error(fmt::format("{}: {} is {}, not a whole number of 0 .. {}", where_, key, json_text(j), most));
    return j.get<std::uint64_t>();
  }
  [[nodiscard]] std::vector<std::size_t> numbers(const char* key, std::uint64_t most) const {
    const Json& list = at(key);
    if (!list.is_array()) throw Error(fmt::format("{}: {} is no list", where_, key));
    std::vector<std::size_t> all;
    for (const Json& j : list) all.push_back(number(key, j, most));
    return all;
  }
  [[nodiscard]] std::vector<Reader> list(const char* key) const {
    const Json& j = at(key);
    if (!j.is_array()) throw Error(fmt::format("{}: {} is no list", where_, key));
    std::vector<Reader> all;
    for (std::size_t i = 0; i < j.size(); ++i) all.emplace_back(j[i], fmt::format("{}: {}[{}]", where_, key, i));
    return all;
  }
  [[nodiscard]] const Json& at(const char* key) const {
    const auto found = json_->find(key);
    if (found == json_->end()) throw Error(fmt::format("{}: {} is missing", where_, key));
    return *found;
  }
  [[nodiscard]] bool has(const char* key) const { return json_->contains(key); }
  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  const Json* json_;
  std::string where_;
};

ErrorCode error_of(const Reader& r) {
  const auto name = r.get<std::string>("error");
  for (std::size_t i = 0; i < kErrorNames.size(); ++i)
    if (kErrorNames.at(i) == name) return static_cast<ErrorCode>(i);
  throw Error(fmt::format("{}: error is {}, which this kage does not know", r.where(), name));
}

PackFrame frame_of(const Reader& r) {
  constexpr std::uint64_t most = std::uint64_t{1} << 40;
  PackFrame f;
  f.what = r.get<std::string>("what");
  f.words = r.number("words", most);
  f.beats = r.number("beats", most);
  f.status.width = static_cast<int>(r.number("width", kMaxSize));
  f.status.height = static_cast<int>(r.number("height", kMaxSize));
  f.status.error = error_of(r);
  if (f.status.error != ErrorCode::NONE) {
    f.status.frame = static_cast<std::uint32_t>(r.number("error_frame", kAll));
    f.status.line = static_cast<std::uint32_t>(r.number("error_line", kAll));
    f.status.token = static_cast<std::uint32_t>(r.number("error_token", kAll));
    f.status.unit = static_cast<std::uint32_t>(r.number("error_unit", kAll));
  }
  if (!r.at("source_lines").is_null()) f.source_lines = r.numbers("source_lines", most);
  f.settles = r.get<bool>("registers_are_read");
  if (!r.at("clocks").is_null()) f.clocks = r.number("clocks", most);
  return f;
}

/// Checks the manifest's sums against the frames' own.
void check_sums(const Reader& r, const Pack& pack) {
  const auto check = [&](const char* key, std::uint64_t come_to) {
    const std::uint64_t said = r.number(key, ~std::uint64_t{0});
    if (said != come_to)
      throw Error(fmt::format("{}: {} is {}, and the frames come to {}", r.where(), key, said, come_to));
  };
  check("beats", pack.beats());
  check("lines", pack.lines());
  check("pixels", pack.pixels());
  if (pack.clocks() != 0 || !r.at("clocks").is_null()) check("clocks", pack.clocks());
}

}  // namespace

std::uint64_t Pack::beats() const { return sum(frames, &PackFrame::beats); }
std::uint64_t Pack::lines() const { return sum(frames, &PackFrame::lines); }
std::uint64_t Pack::pixels() const { return sum(frames, &PackFrame::pixels); }
std::uint64_t Pack::clocks() const { return sum(frames, &PackFrame::clocks); }
std::uint64_t Pack::malformed() const {
  return sum(frames, [](const PackFrame& f) { return f.status.error == ErrorCode::NONE ? 0U : 1U; });
}

std::vector<std::string> files_of(const std::filesystem::path& folder, const Pack& pack) {
  std::vector<std::string> all{(folder / kManifest).string()};
  for (const PackFile& f : pack.files) all.push_back((folder / f.name).string());
  return all;
}

std::vector<RegisterRead> register_reads(const Config& config, std::span<const PackFrame> frames) {
  std::vector<RegisterRead> reads;
  std::uint32_t errors = 0;
  const auto field = [](int value) { return static_cast<std::uint32_t>(value); };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameStatus& s = frames[i].status;
    const bool wrong = s.error != ErrorCode::NONE;
    errors += wrong ? 1 : 0;
    if (!frames[i].settles) continue;
    const auto read = [&](const char* name, std::uint32_t address, std::uint32_t value) {
      reads.push_back({i, name, address, kAll, value});
    };
    if (i + 1 == frames.size()) {
      read("ID", KAGE_REG_ID, KAGE_ID_VALUE);
      read("VERSION", KAGE_REG_VERSION, kStreamVersion);
      read("PARAM_HASH", KAGE_REG_PARAM_HASH, param_hash(config));
      read("SHAPE", KAGE_REG_SHAPE,
           KAGE_FIELD_IS(KAGE_SHAPE_ARRANGEMENT, field(config.arrangement)) |
               KAGE_FIELD_IS(KAGE_SHAPE_BEAT_WORDS, field(config.beat_words)) |
               KAGE_FIELD_IS(KAGE_SHAPE_LANES, field(config.lanes)) |
               KAGE_FIELD_IS(KAGE_SHAPE_MAX_WIDTH, field(config.max_width)));
      read("IRQ", KAGE_REG_IRQ, KAGE_IRQ_FRAME_END_MASK | (errors > 0 ? KAGE_IRQ_ERROR_MASK : 0));
      read("TREE", KAGE_REG_TREE, 0);
    }
    read("FRAMES", KAGE_REG_FRAMES, static_cast<std::uint32_t>(i + 1));
    read("ERRORS", KAGE_REG_ERRORS, errors);
    read("STATUS", KAGE_REG_STATUS, 0);
    if (!wrong) continue;
    read("ERROR", KAGE_REG_ERROR,
         KAGE_FIELD_IS(KAGE_ERROR_LINE, s.line) | KAGE_FIELD_IS(KAGE_ERROR_CODE, static_cast<std::uint32_t>(s.error)));
    read("ERROR_FRAME", KAGE_REG_ERROR_FRAME, s.frame);
    read("ERROR_TOKEN", KAGE_REG_ERROR_TOKEN, s.token);
    if (is_of_unit(s.error)) read("ERROR_UNIT", KAGE_REG_ERROR_UNIT, s.unit);
  }
  return reads;
}

std::vector<PackFile> file_sizes(const Config& config, std::span<const PackFrame> frames) {
  std::uint64_t beats = 0;
  std::uint64_t lines = 0;
  std::uint64_t pixels = 0;
  for (const PackFrame& f : frames) {
    beats += f.beats;
    lines += f.lines();
    pixels += f.pixels();
  }
  const auto words = static_cast<std::uint64_t>(config.beat_words);
  const auto channels = static_cast<std::uint64_t>(config.channels);
  constexpr std::uint64_t row = 4 * 8 + 1;  // of four words in hexadecimal
  return {{kStimulusHex, beats * (8 * words + 2), {}},
          {kStimulusBin, beats * 4 * words, {}},
          {kPixelsHex, pixels * (2 * channels + 2), {}},
          {kPixelsBin, pixels * channels, {}},
          {kSignaturesHex, lines * 9, {}},
          {kFramesHex, frames.size() * row, {}},
          {kRegistersHex, register_reads(config, frames).size() * row, {}}};
}

void LineSignature::pixel(std::span<const std::uint8_t> channels, bool user, bool last) {
  const std::uint8_t flags = static_cast<std::uint8_t>((user ? 2 : 0) | (last ? 1 : 0));
  crc_ = static_cast<std::uint32_t>(crc32_z(crc_, channels.data(), channels.size()));
  crc_ = static_cast<std::uint32_t>(crc32_z(crc_, &flags, 1));
}

Json to_json(const Pack& pack) {
  Json j{{"schema", kPackSchema}, {"scene", pack.scene}, {"config_name", pack.config_name}};
  j["config"] = report::to_json(pack.config);
  j["seed"] = pack.seed;
  j["made_by"] = pack.made_by;
  j["rtl_agrees"] = pack.rtl_agrees ? Json(*pack.rtl_agrees) : Json(nullptr);
  j["beats"] = pack.beats();
  j["lines"] = pack.lines();
  j["pixels"] = pack.pixels();
  j["clocks"] = pack.clocks() == 0 ? Json(nullptr) : Json(pack.clocks());
  j["frames"] = Json::array();
  for (const PackFrame& f : pack.frames) j["frames"].push_back(frame_json(f));
  j["registers"] = Json::array();
  for (const RegisterRead& r : pack.reads)
    j["registers"].push_back(
        {{"frame", r.frame}, {"name", r.name}, {"address", r.address}, {"mask", r.mask}, {"value", r.value}});
  j["files"] = Json::array();
  for (const PackFile& f : pack.files)
    j["files"].push_back({{"name", f.name}, {"bytes", f.bytes}, {"sha256", f.sha256}});
  j["run"] = "README.md";
  j["license"] = "Apache-2.0";
  return j;
}

Pack pack_of(const Json& manifest, const std::string& where) {
  const Reader r(manifest, where);
  if (const auto schema = r.get<std::string>("schema"); schema != kPackSchema)
    throw Error(fmt::format("{}: its format is {}, this kage reads {}", where, schema, kPackSchema));
  Pack p;
  p.scene = r.get<std::string>("scene");
  p.config_name = r.get<std::string>("config_name");
  const Reader config(r.at("config"), where + ": config");
  for (const ParamInfo& info : kParams) {
    const std::string name(info.name);
    constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
    p.config.*info.member =
        config.has(name.c_str()) ? static_cast<int>(config.number(name.c_str(), most)) : info.default_value;
  }
  validate(p.config, where + ": config");
  p.seed = r.number("seed", ~std::uint64_t{0});
  p.made_by = r.get<std::string>("made_by");
  if (!r.at("rtl_agrees").is_null()) p.rtl_agrees = r.get<bool>("rtl_agrees");
  for (const Reader& f : r.list("frames")) p.frames.push_back(frame_of(f));
  check_sums(r, p);
  for (const Reader& f : r.list("registers"))
    p.reads.push_back(
        {f.number("frame", kAll), f.get<std::string>("name"), static_cast<std::uint32_t>(f.number("address", 0xFF)),
         static_cast<std::uint32_t>(f.number("mask", kAll)), static_cast<std::uint32_t>(f.number("value", kAll))});
  for (const Reader& f : r.list("files"))
    p.files.push_back({f.get<std::string>("name"), f.number("bytes", ~std::uint64_t{0}), f.get<std::string>("sha256")});
  return p;
}

}  // namespace kage::vectors
