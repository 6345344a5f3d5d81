// SPDX-License-Identifier: Apache-2.0
#include "gltf_json.hpp"

#include <array>
#include <string_view>

#include "kage/error.hpp"
#include "notes.hpp"

namespace kage::scene {
namespace {

using Json = nlohmann::json;

const Json kNoObject = Json::object();
const Json kNoArray = Json::array();

/// Where a file says which extensions it uses.
constexpr std::array kLists{"extensionsUsed", "extensionsRequired"};

/// Arrays below the top level that others refer to by number: an element that nobody has asked for draws nothing.
bool is_indexed(std::string_view key) { return key == "samplers" || key == "lights"; }

std::string below(const std::string& way, const std::string& key) {
  std::string text = way;
  if (!text.empty()) text += '/';
  text += key;
  return text;
}

// With a stack of its own: a file may nest as deeply as it likes.
void collect_extensions(const Json& root, std::set<std::string>& names) {
  std::vector<const Json*> waiting{&root};
  while (!waiting.empty()) {
    const Json& value = *waiting.back();
    waiting.pop_back();
    if (value.is_array())
      for (const Json& element : value) waiting.push_back(&element);
    if (!value.is_object()) continue;
    for (const auto& [key, member] : value.items()) {
      if (key == "extras") continue;
      if (key == "extensions" && member.is_object())
        for (const auto& extension : member.items()) names.insert(extension.key());
      waiting.push_back(&member);
    }
  }
}

}  // namespace

void GltfJson::fail(const std::string& place, const std::string& cause) const {
  throw Error(name_ + ": " + one_line(place, 120) + ": " + cause);
}

const Json* GltfJson::find(const Json& object, const char* key) const {
  if (!object.is_object()) return nullptr;
  const auto it = object.find(key);
  if (it == object.end()) return nullptr;
  read_.insert(&*it);
  return &*it;
}

std::size_t GltfJson::count(const char* array_name) const { return array(root_, array_name, "JSON").size(); }

const Json& GltfJson::item(const char* array_name, std::uint64_t index, const std::string& place) const {
  return item_of(array(root_, array_name, "JSON"), index, array_name, place);
}

const Json& GltfJson::item_of(const Json& array, std::uint64_t index, const char* what,
                              const std::string& place) const {
  if (index >= array.size())
    fail(place, "asks for number " + std::to_string(index) + " of " + std::to_string(array.size()) + " " + what);
  const Json& found = array[static_cast<std::size_t>(index)];
  if (!found.is_object()) fail(std::string(what) + " " + std::to_string(index), "not an object");
  read_.insert(&found);
  return found;
}

std::optional<std::uint64_t> GltfJson::integer(const Json& object, const char* key, const std::string& place) const {
  const Json* const v = find(object, key);
  if (v == nullptr) return std::nullopt;
  const bool whole = v->is_number_unsigned() || (v->is_number_integer() && v->get<std::int64_t>() >= 0);
  if (whole && v->get<std::uint64_t>() < (std::uint64_t{1} << 53)) return v->get<std::uint64_t>();
  if (v->is_number_float()) {
    const double d = v->get<double>();
    if (d >= 0 && d < 0x1p53 && d == static_cast<double>(static_cast<std::uint64_t>(d)))
      return static_cast<std::uint64_t>(d);
  }
  fail(place, std::string("'") + key + "' is not a whole number");
}

std::optional<double> GltfJson::number(const Json& object, const char* key, const std::string& place) const {
  const Json* const v = find(object, key);
  if (v == nullptr) return std::nullopt;
  if (!v->is_number()) fail(place, std::string("'") + key + "' is not a number");
  return v->get<double>();
}

bool GltfJson::boolean(const Json& object, const char* key, bool otherwise, const std::string& place) const {
  const Json* const v = find(object, key);
  if (v == nullptr) return otherwise;
  if (!v->is_boolean()) fail(place, std::string("'") + key + "' is not true or false");
  return v->get<bool>();
}

std::string GltfJson::text(const Json& object, const char* key, const std::string& place) const {
  const Json* const v = find(object, key);
  if (v == nullptr) return {};
  if (!v->is_string()) fail(place, std::string("'") + key + "' is not a text");
  return v->get<std::string>();
}

std::vector<double> GltfJson::numbers(const Json& object, const char* key, std::size_t size,
                                      const std::string& place) const {
  const Json* const all = find(object, key);
  if (all == nullptr) return {};
  if (!all->is_array() || all->size() != size)
    fail(place, std::string("'") + key + "' is not " + std::to_string(size) + " numbers");
  std::vector<double> values;
  for (const Json& v : *all) {
    if (!v.is_number()) fail(place, std::string("'") + key + "' holds what is not a number");
    values.push_back(v.get<double>());
  }
  return values;
}

const Json& GltfJson::array(const Json& object, const char* key, const std::string& place) const {
  const Json* const v = find(object, key);
  if (v == nullptr) return kNoArray;
  if (!v->is_array()) fail(place, std::string("'") + key + "' is not an array");
  return *v;
}

const Json& GltfJson::object(const Json& parent, const char* key, const std::string& place) const {
  const Json* const v = find(parent, key);
  if (v == nullptr) return kNoObject;
  if (!v->is_object()) fail(place, std::string("'") + key + "' is not an object");
  return *v;
}

const Json& GltfJson::extension(const Json& parent, const char* name, const std::string& place) const {
  return object(object(parent, "extensions", place), name, place);
}

bool GltfJson::has_extension(const Json& parent, const char* name, const std::string& place) const {
  return has(object(parent, "extensions", place), name);
}

const Json& GltfJson::own_extras(const Json& parent) const {
  const Json* const extras = find(parent, "extras");
  const Json* const own = extras == nullptr ? nullptr : find(*extras, "kage");
  return own == nullptr || !own->is_object() ? kNoObject : *own;
}

void GltfJson::pass_over(const Json& object) const {
  std::vector<const Json*> waiting{&object};
  while (!waiting.empty()) {
    const Json& value = *waiting.back();
    waiting.pop_back();
    for (const Json& member : value) {
      read_.insert(&member);
      if (member.is_structured()) waiting.push_back(&member);
    }
  }
}

void GltfJson::descend(const Json& value, const std::string& way, bool indexed,
                       std::map<std::string, std::size_t>& found) const {
  if (value.is_object()) unread_of(value, way, found);
  if (!value.is_array()) return;
  for (const Json& element : value)
    if (element.is_object() && (!indexed || read_.count(&element) != 0)) unread_of(element, way, found);
}

void GltfJson::unread_of(const Json& object, const std::string& way, std::map<std::string, std::size_t>& found) const {
  const bool top = &object == &root_;
  for (const auto& [key, value] : object.items()) {
    if (key == "extras") continue;
    const std::string here = below(way, key);
    if (key == "extensions") {
      for (const auto& [name, extension] : value.items()) {
        if (read_.count(&extension) != 0)
          descend(extension, below(here, name), false, found);
        else
          ++found[below(here, name)];
      }
    } else if (read_.count(&value) != 0) {
      descend(value, here, top || is_indexed(key), found);
    } else {
      ++found[here];
    }
  }
}

std::map<std::string, std::size_t> GltfJson::unread() const {
  std::map<std::string, std::size_t> found;
  unread_of(root_, "", found);
  return found;
}

bool GltfJson::uses(const char* extension) const {
  for (const char* list : kLists)
    for (const Json& e : array(root_, list, "JSON"))
      if (e.is_string() && e.get_ref<const std::string&>() == extension) return true;
  return false;
}

std::set<std::string> GltfJson::extensions() const {
  std::set<std::string> names;
  collect_extensions(root_, names);
  for (const char* list : kLists)
    for (const Json& e : array(root_, list, "JSON"))
      if (e.is_string()) names.insert(e.get<std::string>());
  return names;
}

}  // namespace kage::scene
