// SPDX-License-Identifier: Apache-2.0
#include "cosim/model/model_cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "cosim/descriptor.hpp"
#include "cosim/model/lock.hpp"
#include "cosim/model/trust.hpp"
#include "file/output_file.hpp"
#include "json/foreign_json.hpp"
#include "json/json_text.hpp"
#include "kage/error.hpp"

namespace kage::cosim {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kManifestVersion = 1;

/// Length and CRC-32 of a file.
struct Sum {
  std::uint64_t bytes = 0;
  std::uint32_t crc = 0;
  bool operator==(const Sum&) const = default;
};

Sum sum_of(int fd, const fs::path& path) {
  Sum sum{0, static_cast<std::uint32_t>(crc32_z(0, nullptr, 0))};
  read_all(fd, path, [&](const unsigned char* data, std::size_t n) {
    sum.bytes += n;
    sum.crc = static_cast<std::uint32_t>(crc32_z(sum.crc, data, n));
  });
  return sum;
}

/// Null if there is none or it cannot be read as JSON.
Json manifest_of(const fs::path& path) {
  const Descriptor file(open_own_file(path));
  if (file.get() < 0) return nullptr;
  try {
    Json manifest = parse_json<Json>(text_of(file.get(), path), path.string());
    return manifest.is_object() ? manifest : Json();
  } catch (const Error&) {
    return nullptr;
  }
}

void sync(int fd, const fs::path& path) {
  if (fsync(fd) != 0) throw Error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
}

}  // namespace

ModelCache::ModelCache() : folder_(cache_folder("models")) {
  (void)cache_folder("verilator");  // objects that models are linked with: verif/cosim/model/driver/build.py
}

std::optional<std::string> ModelCache::damage(const std::string& key) const {
  const Descriptor file(open_own_file(library(key)));
  if (file.get() < 0) return std::nullopt;
  const Json about = manifest_of(manifest(key));
  if (!about.contains("bytes") || !about.contains("crc32") || !about["bytes"].is_number_unsigned() ||
      !about["crc32"].is_number_unsigned())
    return "it has no checksum";
  const Sum is = sum_of(file.get(), library(key));
  const Sum ought{about["bytes"].get<std::uint64_t>(), about["crc32"].get<std::uint32_t>()};
  if (is.bytes != ought.bytes) return fmt::format("it has {} bytes in place of {}", is.bytes, ought.bytes);
  if (is.crc != ought.crc) return "its checksum differs";
  return std::string();
}

void ModelCache::use(const std::string& key) const {
  // Only its age in `kage cache prune` hangs on it.
  (void)utimensat(AT_FDCWD, library(key).c_str(), nullptr, AT_SYMLINK_NOFOLLOW);
}

void ModelCache::keep(const std::string& key, const fs::path& built, const Json& about) const {
  Json whole{{"version", kManifestVersion}};
  {
    const Descriptor file(open(built.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
    if (file.get() < 0) throw Error(fmt::format("{}: cannot be read: {}", built.string(), std::strerror(errno)));
    if (fchmod(file.get(), 0600) != 0)
      throw Error(fmt::format("{}: cannot be written: {}", built.string(), std::strerror(errno)));
    sync(file.get(), built);
    const Sum sum = sum_of(file.get(), built);
    whole["bytes"] = sum.bytes;
    whole["crc32"] = sum.crc;
  }
  whole.update(about);
  fs::path text = built;
  text.replace_extension(".json");
  OutputFile out(text, manifest(key).string());
  out << json_text(whole, 2) << '\n';
  out.close();
  std::error_code ec;
  fs::permissions(text, fs::perms::owner_read | fs::perms::owner_write, ec);
  fs::rename(text, manifest(key), ec);
  if (!ec) fs::rename(built, library(key), ec);
  if (ec) throw Error(fmt::format("{}: cannot be written: {}", library(key).string(), ec.message()));
}

std::vector<CachedModel> ModelCache::list() const {
  std::vector<CachedModel> models;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    if (entry.path().extension() != ".so" || entry.is_symlink() || !entry.is_regular_file()) continue;
    std::error_code ec;
    CachedModel model{.key = entry.path().stem().string()};
    model.last_used = entry.last_write_time(ec);
    for (const fs::path& file : {library(model.key), manifest(model.key), log(model.key)}) {
      const std::uintmax_t size = fs::file_size(file, ec);
      if (!ec) model.bytes += size;
    }
    model.about = manifest_of(manifest(model.key));
    models.push_back(std::move(model));
  }
  std::sort(models.begin(), models.end(), [](const CachedModel& a, const CachedModel& b) {
    return a.last_used != b.last_used ? a.last_used > b.last_used : a.key < b.key;
  });
  return models;
}

bool ModelCache::remove(const std::string& key) const {
  Lock held(lock(key), O_RDWR | O_CREAT | O_NOFOLLOW);
  if (!held.try_lock()) return false;
  std::error_code ec;
  for (const fs::path& file : {library(key), manifest(key), log(key), lock(key)}) fs::remove(file, ec);
  return true;
}

std::vector<CachedModel> ModelCache::prune(const CacheLimits& limits) const {
  const auto now = fs::file_time_type::clock::now();
  std::vector<CachedModel> gone;
  std::uint64_t kept = 0;
  bool full = false;
  for (CachedModel& model : list()) {
    const bool old =
        limits.age && std::chrono::duration_cast<std::chrono::seconds>(now - model.last_used) > *limits.age;
    full = full || (limits.bytes && kept + model.bytes > *limits.bytes);
    if ((old || full) && remove(model.key))
      gone.push_back(std::move(model));
    else
      kept += model.bytes;
  }
  return gone;
}

std::vector<fs::path> ModelCache::others() const {
  std::vector<fs::path> all;
  std::error_code ec;
  for (const auto& entry : fs::directory_iterator(folder_, ec))
    if (entry.is_regular_file(ec) && !fs::exists(library(entry.path().stem().string()), ec))
      all.push_back(entry.path());
  for (const auto& entry : fs::recursive_directory_iterator(folder_.parent_path() / "verilator", ec))
    if (entry.is_regular_file(ec) && !entry.is_symlink(ec)) all.push_back(entry.path());
  return all;
}

std::uint64_t ModelCache::other_bytes() const {
  std::uint64_t bytes = 0;
  for (const fs::path& file : others()) {
    std::error_code ec;
    const std::uintmax_t size = fs::file_size(file, ec);
    if (!ec) bytes += size;
  }
  return bytes;
}

void ModelCache::prune_others(const CacheLimits& limits) const {
  std::uint64_t bytes = other_bytes();
  for (const CachedModel& model : list()) bytes += model.bytes;
  const bool full = limits.bytes && bytes > *limits.bytes;
  const auto now = fs::file_time_type::clock::now();
  for (const fs::path& file : others()) {
    std::error_code ec;
    const auto age = std::chrono::duration_cast<std::chrono::seconds>(now - fs::last_write_time(file, ec));
    if (ec || !(full || (limits.age && age > *limits.age))) continue;
    // A lock, and the log beside it, may be a build's that goes on.
    if (file.parent_path() == folder_)
      (void)remove(file.stem().string());
    else
      fs::remove(file, ec);
  }
  for (const auto& entry : fs::directory_iterator(folder_.parent_path() / "verilator")) {
    std::error_code ec;
    if (entry.is_directory(ec) && fs::is_empty(entry.path(), ec)) fs::remove(entry.path(), ec);
  }
}

}  // namespace kage::cosim
