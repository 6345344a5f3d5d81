// SPDX-License-Identifier: Apache-2.0
//
// Stream files. The format is docs/stream-files.md; in short, all numbers little-endian:
//
//   8 bytes   "KAGESTRM"
//   sections, each: 4 bytes tag, u32 CRC-32 of the payload, u64 payload bytes, payload, zeros up to a multiple of 8
//     CONF    the configuration as YAML; first, once
//     FRAM    the words of one frame, as the port gets them without fill
//     PORT    likewise of a frame that may not be sound
//     ORIG    where the frames come from, as JSON; once at most
//     DONE    u64 number of frames, u32 CRC-32 over all sections' headers before it; last, once
//   Sections with other tags are checked and skipped.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>

#include "contract/config_text.hpp"
#include "file/plain_io.hpp"
#include "file/regular_file.hpp"
#include "file/temp_file.hpp"
#include "kage/config.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"
#include "stream/finish.hpp"

namespace kage {
namespace {

/// Text of section CONF. Late parameters are left out where they are 0, so that files have the same bytes as before.
std::string conf_text(const Config& config) {
  std::string text;
  for (const ParamInfo& p : kParams)
    if (!p.late || config.*(p.member) != 0) text += fmt::format("{}: {}\n", p.name, config.*(p.member));
  return text;
}

constexpr char kFileMagic[9] = "KAGESTRM";
constexpr std::size_t kSectionHeader = 16;

static_assert(std::endian::native == std::endian::little, "stream files are read and written in place");

std::uint32_t crc(std::uint32_t seed, const void* data, std::size_t size) {
  if (size == 0) return seed;  // zlib starts anew where there is no data to point to
  return static_cast<std::uint32_t>(crc32_z(seed, static_cast<const Bytef*>(data), size));
}

struct SectionHeader {
  char tag[4];
  std::uint32_t crc;
  std::uint64_t size;
};
static_assert(sizeof(SectionHeader) == kSectionHeader);

constexpr std::uint64_t padded(std::uint64_t size) { return (size + 7) / 8 * 8; }

}  // namespace

// ---- writing
// ------------------------------------------------------------------------------------------------------------

struct StreamFileWriter::Data {
  explicit Data(const std::filesystem::path& path) : name(path.string()) {
    if (is_device(path)) {
      own_device = device = ::open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
      if (device < 0) fail_write(name, errno);
      out = OutputFile::unnamed(name);
    } else {
      file = std::make_unique<TempFile>(path);
      out = std::make_unique<OutputFile>(file->temp(), name);
    }
  }
  Data(int fd, std::string fd_name) : name(std::move(fd_name)), out(OutputFile::unnamed(name)), device(fd) {}
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  ~Data() {
    if (own_device >= 0) (void)::close(own_device);
  }

  void write(const void* data, std::size_t size) const {
    out->write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  }

  void begin_section(const char* tag) {
    open_at = out->tellp();
    open_section = {};
    std::memcpy(open_section.tag, tag, 4);
    write(&open_section, sizeof open_section);
  }

  void add(const void* data, std::size_t size) {
    open_section.crc = crc(open_section.crc, data, size);
    open_section.size += size;
    write(data, size);
  }

  /// Size and checksum are known now: the header is written again.
  void end_section() {
    const SectionHeader& h = open_section;
    constexpr char zeros[8] = {};
    write(zeros, padded(h.size) - h.size);
    headers_crc = crc(headers_crc, &h, sizeof h);
    out->seekp(open_at);
    write(&h, sizeof h);
    out->seekp(0, std::ios::end);
    if (device >= 0) out->move_to(device, name);
  }

  void section(const char* tag, const void* data, std::size_t size) {
    begin_section(tag);
    add(data, size);
    end_section();
  }

  std::string name;
  std::unique_ptr<TempFile> file;   // unless it goes to a device
  std::unique_ptr<OutputFile> out;  // the file, or the section at hand for a device, which knows no positions
  int device = -1;
  int own_device = -1;
  std::uint64_t frames = 0;
  std::uint32_t headers_crc = 0;
  SectionHeader open_section{};
  std::streamoff open_at = 0;
};

StreamFileWriter::StreamFileWriter(std::unique_ptr<Data> data, const Config& config) : data_(std::move(data)) {
  data_->write(kFileMagic, 8);
  const std::string text = conf_text(config);
  data_->section("CONF", text.data(), text.size());
  // A full disk is found here, before the work on the first frame, and not when a buffer has filled up.
  data_->out->flush();
}

StreamFileWriter::StreamFileWriter(const std::filesystem::path& path, const Config& config)
    : StreamFileWriter(std::make_unique<Data>(path), config) {}

StreamFileWriter::StreamFileWriter(int fd, const std::string& name, const Config& config)
    : StreamFileWriter(std::make_unique<Data>(fd, name), config) {}

StreamFileWriter::~StreamFileWriter() = default;

void StreamFileWriter::begin_frame() { data_->begin_section("FRAM"); }

void StreamFileWriter::begin_port_frame() { data_->begin_section("PORT"); }

void StreamFileWriter::words(std::span<const std::uint32_t> words) { data_->add(words.data(), words.size_bytes()); }

void StreamFileWriter::end_frame() {
  data_->end_section();
  ++data_->frames;
}

void StreamFileWriter::frame(std::span<const std::uint32_t> w) {
  begin_frame();
  words(w);
  end_frame();
}

void StreamFileWriter::origin(const std::string& json) { data_->section("ORIG", json.data(), json.size()); }

/// The library's way into a writer.
struct StreamFileWriterInside {
  static StreamFileWriter::Data& of(StreamFileWriter& writer) { return *writer.data_; }
};

void finish(StreamFileWriter& writer, TempFiles& files) {
  auto& data = StreamFileWriterInside::of(writer);
  std::array<char, 12> payload{};
  std::memcpy(payload.data(), &data.frames, 8);
  std::memcpy(payload.data() + 8, &data.headers_crc, 4);
  data.section("DONE", payload.data(), payload.size());
  data.out->close();
  if (data.file) files.add(std::move(data.file));
}

void StreamFileWriter::finish() {
  TempFiles files;
  kage::finish(*this, files);
  files.commit();
}

// ---- reading
// ------------------------------------------------------------------------------------------------------------

struct StreamFile::Data {
  struct Frame {
    std::uint64_t offset;  // of the payload
    std::uint64_t size;
    std::uint32_t crc;
    bool port;  // unchecked
  };

  std::string name;
  const char* base = nullptr;
  std::uint64_t size = 0;
  Config config;
  struct Section {
    std::string tag;
    int frames_before;
    std::uint64_t offset;  // of the payload
    std::uint64_t size;
  };
  std::vector<Frame> frames;
  std::vector<Section> sections;  // the others
  std::string origin;
  bool origin_seen = false;

  Data() = default;
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  ~Data() {
    if (base != nullptr) ::munmap(const_cast<char*>(base), size);
  }

  [[noreturn]] void fail(std::uint64_t at, const std::string& cause) const {
    throw Error(fmt::format("{}: byte {}: {}", name, at, cause));
  }

  void map(const std::filesystem::path& path) {
    name = path.string();
    check_regular(path);
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) throw Error(fmt::format("{}: {}", name, std::strerror(errno)));
    struct stat st {};
    if (::fstat(fd, &st) != 0 || !S_ISREG(st.st_mode)) {
      ::close(fd);
      throw Error(fmt::format("{}: not a file", name));
    }
    size = static_cast<std::uint64_t>(st.st_size);
    if (size < 8) {
      ::close(fd);
      throw Error(fmt::format("{}: byte 0: not a stream file", name));
    }
    void* p = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
    const int saved = errno;
    ::close(fd);
    if (p == MAP_FAILED) throw Error(fmt::format("{}: cannot be mapped: {}", name, std::strerror(saved)));
    base = static_cast<const char*>(p);
    if (std::memcmp(base, kFileMagic, 8) != 0) fail(0, "not a stream file");
  }

  void index() {
    std::uint64_t at = 8;
    std::uint32_t headers_crc = 0;
    bool first = true;
    for (bool done = false; !done; first = false) {
      if (size - at < kSectionHeader) fail(at, "the file ends before its last section");
      SectionHeader h{};
      std::memcpy(&h, base + at, sizeof h);
      const std::uint64_t payload = at + kSectionHeader;
      if (h.size > size - payload || padded(h.size) > size - payload)
        fail(at, "a section reaches past the end of the file");
      const std::string_view tag(h.tag, 4);
      for (std::uint64_t i = h.size; i < padded(h.size); ++i)
        if (base[payload + i] != 0) fail(payload + i, "padding is not zero");
      if (first != (tag == "CONF")) fail(at, first ? "the first section is not CONF" : "a second CONF section");
      // Frames are summed when they are asked for, so that opening a large file is quick.
      if (tag == "FRAM" || tag == "PORT") {
        if (h.size % 4 != 0) fail(at, "a frame is not of whole words");
        if (tag == "PORT" && h.size == 0) fail(at, "a frame without words, which no port can bring");
        if (origin_seen) fail(at, "a frame behind section ORIG");
        frames.push_back({payload, h.size, h.crc, tag == "PORT"});
      } else if (crc(0, base + payload, h.size) != h.crc) {
        fail(at, fmt::format("checksum of section {} is wrong", printable(tag)));
      }
      if (tag == "ORIG") {
        if (origin_seen) fail(at, "a second ORIG section");
        if (frames.empty()) fail(at, "section ORIG before the frames");
        origin_seen = true;
        origin.assign(base + payload, h.size);
      }
      if (tag != "CONF" && tag != "FRAM" && tag != "PORT" && tag != "DONE")
        sections.push_back({printable(tag), static_cast<int>(frames.size()), payload, h.size});
      if (tag == "CONF") {
        config = config_from_text(std::string(base + payload, h.size), name);
      } else if (tag == "DONE") {
        check_done(at, payload, h.size, headers_crc);
        done = true;
      }
      headers_crc = crc(headers_crc, &h, sizeof h);
      at = payload + padded(h.size);
    }
    if (at != size) fail(at, "bytes after the last section");
    if (frames.empty()) fail(at, "the file holds no frame");
  }

  static std::string printable(std::string_view tag) {
    std::string s(tag);
    for (char& c : s)
      if (c < ' ' || c > '~') c = '?';
    return s;
  }

  void check_done(std::uint64_t at, std::uint64_t payload, std::uint64_t bytes, std::uint32_t headers_crc) const {
    std::uint64_t count = 0;
    std::uint32_t sum = 0;
    if (bytes != 12) fail(at, "section DONE has the wrong size");
    std::memcpy(&count, base + payload, 8);
    std::memcpy(&sum, base + payload + 8, 4);
    if (sum != headers_crc) fail(at, "checksum of the section headers is wrong");
    if (count != frames.size()) fail(at, fmt::format("{} frames announced, {} found", count, frames.size()));
  }
};

StreamFile::StreamFile(const std::filesystem::path& path) : data_(std::make_unique<Data>()) {
  data_->map(path);
  data_->index();
}
StreamFile::~StreamFile() = default;
StreamFile::StreamFile(StreamFile&&) noexcept = default;
StreamFile& StreamFile::operator=(StreamFile&&) noexcept = default;

const Config& StreamFile::config() const { return data_->config; }
int StreamFile::frame_count() const { return static_cast<int>(data_->frames.size()); }
bool StreamFile::is_port_frame(int index) const { return data_->frames.at(static_cast<std::size_t>(index)).port; }
const std::string& StreamFile::origin() const { return data_->origin; }
std::uint64_t StreamFile::bytes() const { return data_->size; }

std::vector<StreamSection> StreamFile::sections() const {
  std::vector<StreamSection> sections;
  for (const Data::Section& s : data_->sections)
    sections.push_back({s.tag, s.frames_before, std::string_view(data_->base + s.offset, s.size)});
  return sections;
}

void StreamFile::leave(int index) const {
  const Data::Frame& f = data_->frames.at(static_cast<std::size_t>(index));
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  const std::uint64_t begin = f.offset / page * page;
  // Advice: where it is not taken, nothing is wrong.
  (void)::madvise(const_cast<char*>(data_->base) + begin, f.offset + f.size - begin, MADV_DONTNEED);
}

std::span<const std::uint32_t> StreamFile::frame(int index, TokenCounts* counts) const {
  const Data::Frame& f = data_->frames.at(static_cast<std::size_t>(index));
  const char* payload = data_->base + f.offset;
  // Payloads start at multiples of 8 in a page-aligned map.
  const std::span<const std::uint32_t> words(reinterpret_cast<const std::uint32_t*>(payload), f.size / 4);
  if (crc(0, payload, f.size) != f.crc) {
    // Say where, if the damage can be seen in the tokens; the checksum is the verdict all the same.
    if (!f.port)
      (void)check_frame(data_->config, words, fmt::format("{}: section {}: checksum is wrong", data_->name, index),
                        f.offset);
    data_->fail(f.offset, fmt::format("checksum of frame {} is wrong", index));
  }
  const TokenCounts c =
      f.port ? count_tokens(data_->config, words) : check_frame(data_->config, words, data_->name, f.offset);
  if (counts != nullptr) *counts += c;
  return words;
}

bool is_stream_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::FILE* f = std::fopen(path.c_str(), "rb");
  if (f == nullptr) return false;
  char head[8] = {};
  const bool yes = std::fread(head, 1, 8, f) == 8 && std::memcmp(head, kFileMagic, 8) == 0;
  (void)std::fclose(f);
  return yes;
}

}  // namespace kage
