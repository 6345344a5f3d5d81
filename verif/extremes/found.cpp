// SPDX-License-Identifier: Apache-2.0
#include "extremes/found.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "file/temp_file.hpp"
#include "kage/error.hpp"

namespace kage::verif {
namespace {

constexpr const char* kFamily = "family";

// FNV-1a: short names that do not change with the compiler.
std::uint32_t hash_of(const std::string& text) {
  std::uint32_t h = 2166136261U;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 16777619U;
  return h;
}

// Each line of a text as a comment.
std::string commented(const std::string& text) {
  std::string all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) all += "# " + line + "\n";
  return all;
}

}  // namespace

std::filesystem::path write_found(const std::filesystem::path& folder, const Family& family, const std::string& text,
                                  const std::string& wrong, const std::string& case_name) {
  const FamilyInfo& info = family.info();
  std::string name = info.name;
  std::replace(name.begin(), name.end(), ' ', '-');
  const auto path = folder / fmt::format("{}-{:08x}.txt", name, hash_of(text));
  TempFiles files;
  write_text(files, path.string(),
             fmt::format("# {}\n# Shrunk from case {}. What was wrong:\n{}{} {}\n{}", info.what, case_name,
                         commented(wrong), kFamily, info.name, text));
  files.commit();
  return path;
}

FoundCase read_found(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::stringstream all;
  all << in.rdbuf();
  if (!in) throw Error(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
  FoundCase found;
  std::string line;
  for (int number = 1; std::getline(all, line); ++number) {
    if (found.family == nullptr && line.rfind(kFamily, 0) == 0) {
      const std::string name = line.size() > std::string(kFamily).size() ? line.substr(7) : "";
      found.family = family_named(name);
      if (found.family == nullptr)
        throw Error(fmt::format("{}:{}: there is no family \"{}\"", file.string(), number, name));
      line.clear();  // the fields keep their lines' numbers
    }
    found.text += line + "\n";
  }
  if (found.family == nullptr) throw Error(fmt::format("{}: no line says \"{} NAME\"", file.string(), kFamily));
  return found;
}

std::vector<std::filesystem::path> found_files(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".txt") files.push_back(entry.path());
  if (error) throw Error(fmt::format("{}: {}", folder.string(), error.message()));
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace kage::verif
