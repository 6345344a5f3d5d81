// SPDX-License-Identifier: Apache-2.0
#include "scene/plain/obj_libraries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "file/read_file.hpp"
#include "kage/error.hpp"
#include "scene/notes.hpp"
#include "scene/plain/statements.hpp"

namespace kage::scene {
namespace {

constexpr std::size_t kNamedMaterials = 5;  // so many materials that are not there are named

void add_once(std::vector<std::string>& to, std::string name) {
  if (std::find(to.begin(), to.end(), name) == to.end()) to.push_back(std::move(name));
}

}  // namespace

ObjLibraries::ObjLibraries(std::filesystem::path file, std::string name, bool allow_outside)
    : file_(std::move(file)), name_(std::move(name)), side_files_(file_, allow_outside) {}

void ObjLibraries::read(const SideFiles::Found& file, std::vector<std::string>& notes) {
  if (!read_.insert(file.path.string()).second) return;
  const std::string name = file.path.filename().string();
  read_mtl(read_file(file.path, name), name, materials_, notes);
}

std::vector<std::string> ObjLibraries::files() const {
  for (const auto& [material, m] : materials_)
    for (const std::string& texture : m.textures) {
      side_files_.note_texture(texture);
      side_files_.note_texture(without_comment(texture));
    }
  return side_files_.files();
}

void ObjLibraries::add(std::string_view names, std::vector<std::string>& notes) {
  const auto take = [&](const std::string& name) {
    const SideFiles::Found file = side_files_.find_moved(name);
    if (file.exists && file.refused) throw Error(name_ + ": " + SideFiles::refusal(name));
    if (file.exists) read(file, notes);
    return file.exists;
  };
  if (names.size() > 2 && names.front() == '"' && names.back() == '"') names = names.substr(1, names.size() - 2);
  const std::string whole(names);
  if (whole.empty() || take(whole)) return;
  if (const std::string name(without_comment(names)); name != whole && !name.empty() && take(name)) return;
  std::vector<std::string> missing;
  std::size_t found = 0;
  std::string_view rest = without_comment(names);
  for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest))
    if (const std::string name(word); take(name))
      ++found;
    else
      missing.push_back(name);
  // Where none of the words is a file, all of them are the name of one.
  if (found == 0) missing = {std::string(without_comment(names))};
  for (std::string& name : missing) add_once(missing_, std::move(name));
}

const MtlMaterial* ObjLibraries::find(const std::string& name) {
  auto at = materials_.find(name);
  if (at == materials_.end()) at = materials_.find(without_comment(name));
  if (at != materials_.end()) return &at->second;
  if (!name.empty()) unknown_.push_back(name);
  return nullptr;
}

void ObjLibraries::fall_back(std::vector<std::string>& notes) {
  if (missing_.empty() || !read_.empty()) return;
  const SideFiles::Found own = side_files_.find_named(file_.stem().string() + ".mtl");
  if (!own.exists || own.refused) return;
  read(own, notes);
  instead_ = own.path.filename().string();
}

void ObjLibraries::note_missing(std::vector<std::string>& notes) const {
  for (const std::string& library : missing_)
    notes.push_back(fmt::format(
        "no file {}: {}", one_line(library, 120),
        instead_.empty() ? "its materials are drawn grey" : "the materials are those of " + one_line(instead_, 120)));
  if (unknown_.empty() || (!missing_.empty() && read_.empty())) return;  // no material is there, and the notes say it
  std::string names;
  for (std::size_t i = 0; i < std::min(unknown_.size(), kNamedMaterials); ++i)
    names += fmt::format("{}'{}'", i == 0 ? "" : ", ", one_line(unknown_[i], 60));
  if (unknown_.size() > kNamedMaterials) names += fmt::format(" and {} more", unknown_.size() - kNamedMaterials);
  notes.push_back(fmt::format("no material{} {}: drawn grey", unknown_.size() == 1 ? "" : "s", names));
}

}  // namespace kage::scene
