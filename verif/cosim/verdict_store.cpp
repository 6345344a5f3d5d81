// SPDX-License-Identifier: Apache-2.0
#include "cosim/verdict_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <sstream>
#include <utility>

#include "cosim/descriptor.hpp"
#include "cosim/model/sha256.hpp"
#include "cosim/model/trust.hpp"
#include "kage/error.hpp"

namespace kage::cosim {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFirstLine = "kage verdict 2";

constexpr std::size_t kKeyDigits = 64;

/// No verdict's file has as many bytes.
constexpr off_t kTooLong = 4096;

bool is_key(const std::string& name) {
  return name.size() == kKeyDigits && name.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::string seal(const std::string& key, const std::string& text) {
  Sha256 hash;
  hash.add(key);
  hash.add(text);
  return hash.take();
}

std::string to_text(const std::string& key, const Verdict& verdict) {
  std::string text = fmt::format("{}\n{}\n{}\n", kFirstLine, verdict.output, verdict.cycles);
  for (const Stalls& s : verdict.phase_stalls) text += fmt::format("{} {}\n", s.starved, s.blocked);
  return text + seal(key, text) + "\n";
}

std::optional<Verdict> of_text(const std::string& key, const std::string& whole) {
  if (whole.size() <= kKeyDigits) return std::nullopt;
  const std::string text = whole.substr(0, whole.size() - kKeyDigits - 1);
  if (whole != text + seal(key, text) + "\n") return std::nullopt;
  std::istringstream in(text);
  std::string first;
  Verdict verdict;
  std::getline(in, first);
  in >> verdict.output >> verdict.cycles;
  for (Stalls& s : verdict.phase_stalls) in >> s.starved >> s.blocked;
  // One of another format has another first line.
  return in && first == kFirstLine ? std::optional(verdict) : std::nullopt;
}

/// Writes a new file; what lies there under its name goes. 0, or errno.
int write_new(const fs::path& path, const std::string& text) {
  if (unlink(path.c_str()) != 0 && errno != ENOENT) return errno;
  const Descriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (file.get() < 0) return errno == EEXIST ? 0 : errno;  // another program has just kept the same
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = write(file.get(), text.data() + at, text.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int error = errno;
      (void)unlink(path.c_str());
      return error;
    }
    at += static_cast<std::size_t>(n);
  }
  return 0;
}

}  // namespace

VerdictStore::VerdictStore(std::size_t most) : folder_(cache_folder("verdicts")), most_(most) {}

std::optional<Verdict> VerdictStore::read(const std::string& key) const {
  try {
    const Descriptor file(open_own_file(folder_ / key));
    struct stat status {};
    if (file.get() < 0 || fstat(file.get(), &status) != 0 || status.st_size >= kTooLong) return std::nullopt;
    return of_text(key, text_of(file.get(), folder_ / key));
  } catch (const Error&) {
    return std::nullopt;  // it cannot be read or trusted: the frame is run
  }
}

std::optional<Verdict> VerdictStore::find(const std::string& key) const {
  std::optional<Verdict> verdict = read(key);
  // Only its place in the order in which verdicts go hangs on the time.
  if (verdict) (void)utimensat(AT_FDCWD, (folder_ / key).c_str(), nullptr, AT_SYMLINK_NOFOLLOW);
  return verdict;
}

bool VerdictStore::keep(const std::string& key, const Verdict& verdict) {
  {
    const std::lock_guard lock(mutex_);
    if (!trouble_.empty()) return false;
  }
  const int error = write_new(folder_ / key, to_text(key, verdict));
  bool sweep = false;
  {
    const std::lock_guard lock(mutex_);
    if (error != 0 && trouble_.empty())
      trouble_ = fmt::format("{}: cannot be written to: {}", folder_.string(), std::strerror(error));
    if (error != 0) return false;
    sweep = kept_++ % sweep_every() == 0;
  }
  if (sweep) this->sweep();
  return true;
}

std::size_t VerdictStore::sweep_every() const { return std::max<std::size_t>(most_ / 20, 1); }

void VerdictStore::sweep() const {
  const std::vector<StoredVerdict> all = list();
  // There is room for those that are kept until the next sweep; an eighth goes, so that not every sweep removes some.
  if (all.size() + sweep_every() <= most_) return;
  std::error_code ec;
  for (std::size_t i = most_ - most_ / 8; i < all.size(); ++i) fs::remove(folder_ / all[i].key, ec);
}

std::string VerdictStore::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

std::vector<StoredVerdict> VerdictStore::list() const {
  std::vector<StoredVerdict> all;
  std::error_code ec;
  for (fs::directory_iterator entry(folder_, ec), end; !ec && entry != end; entry.increment(ec)) {
    struct stat status {};
    StoredVerdict v{.key = entry->path().filename().string()};
    // Another program may remove it just now.
    if (!is_key(v.key) || lstat(entry->path().c_str(), &status) != 0 || S_ISDIR(status.st_mode)) continue;
    v.bytes = static_cast<std::uint64_t>(status.st_size);
    std::error_code gone;
    v.last_used = fs::last_write_time(entry->path(), gone);
    all.push_back(std::move(v));
  }
  std::sort(all.begin(), all.end(), [](const StoredVerdict& a, const StoredVerdict& b) {
    return a.last_used != b.last_used ? a.last_used > b.last_used : a.key < b.key;
  });
  return all;
}

std::vector<StoredVerdict> VerdictStore::prune(const CacheLimits& limits) const {
  const auto now = fs::file_time_type::clock::now();
  std::vector<StoredVerdict> gone;
  std::uint64_t bytes = 0;
  for (StoredVerdict& v : list()) {
    const auto age = std::chrono::duration_cast<std::chrono::seconds>(now - v.last_used);
    const bool stays = (!limits.age || age <= *limits.age) && (!limits.bytes || bytes + v.bytes <= *limits.bytes) &&
                       read(v.key).has_value();
    std::error_code ec;
    if (stays)
      bytes += v.bytes;
    else if (fs::remove(folder_ / v.key, ec))
      gone.push_back(std::move(v));
  }
  return gone;
}

}  // namespace kage::cosim
