// SPDX-License-Identifier: Apache-2.0
#include "fuzz/target.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "kage/error.hpp"

namespace kage::fuzz {

std::span<const Target> targets() {
  static const std::vector<Target> all = [] {
    std::vector<Target> list;
    for (const auto& some : {frame_targets(), scene_targets(), text_targets(), store_targets(), picture_targets()})
      list.insert(list.end(), some.begin(), some.end());
    return list;
  }();
  return all;
}

const Target& target_named(const std::string& name) {
  std::vector<std::string> names;
  for (const Target& t : targets()) {
    if (t.name == name) return t;
    names.emplace_back(t.name);
  }
  throw Error(fmt::format("{}: no such target; there are {}", name, fmt::join(names, ", ")));
}

void run(const Target& target, Bytes bytes) {
  try {
    target.run(bytes);
  } catch (const Error& e) {
    const std::string_view message = e.what();
    if (message.find('\n') != std::string_view::npos) fmt::print(stderr, "{}\n", message);
    require(message.find('\n') == std::string_view::npos, "a message is one line");
  }
}

std::filesystem::path file_of(const std::string& name, Bytes bytes) {
  static const std::filesystem::path folder = [] {
    std::error_code ec;
    const std::filesystem::path memory = "/dev/shm";
    std::filesystem::path f = std::filesystem::is_directory(memory, ec) && access(memory.c_str(), W_OK) == 0
                                  ? memory
                                  : std::filesystem::temp_directory_path();
    f /= fmt::format("kage-fuzz-{}", getpid());
    std::filesystem::create_directories(f);
    std::atexit([] {
      std::error_code ignored;
      for (const char* parent : {"/dev/shm", "/tmp"})
        std::filesystem::remove_all(std::filesystem::path(parent) / fmt::format("kage-fuzz-{}", getpid()), ignored);
    });
    return f;
  }();
  std::filesystem::path path = folder / name;
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return path;
}

void require(bool holds, const char* what) {
  if (holds) return;
  (void)std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

std::string_view text_of(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

Bytes bytes_of(std::string_view text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }

}  // namespace kage::fuzz
