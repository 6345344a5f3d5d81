// SPDX-License-Identifier: Apache-2.0
#include "mapped.hpp"

#include <cstdint>
#include <filesystem>
#include <system_error>
#include <vector>

#include "file/lost_pages.hpp"
#include "kage/error.hpp"

namespace kage::cli {
namespace {

struct Guarded {
  std::string name;
  std::uintmax_t size;
};
std::vector<Guarded> mapped_files;

std::uintmax_t size_now(const std::string& name) {
  std::error_code ec;
  return std::filesystem::file_size(name, ec);
}

}  // namespace

void guard_mapped(const std::string& name) {
  mapped_files.push_back({name, size_now(name)});
  guard_pages();
}

std::string lost_mapped() {
  if (lost_pages() == 0) return "";
  // The page that was lost does not say whose it was; the size does, if the file became shorter.
  std::string all;
  std::string changed;
  for (const Guarded& file : mapped_files) {
    all += (all.empty() ? "" : " or ") + file.name;
    if (size_now(file.name) != file.size) changed += (changed.empty() ? "" : " and ") + file.name;
  }
  return (changed.empty() ? all : changed) + ": became shorter, or could not be read, while it was open";
}

void check_mapped() {
  if (lost_pages() != 0) throw Error(lost_mapped());
}

}  // namespace kage::cli
