// SPDX-License-Identifier: Apache-2.0
//
// The JSON of a glTF 2.0 file with checked access, which takes note of everything that is read. Keys that were never
// read have not gone into the picture. unread() finds them, so that no key of a file is passed over in silence because
// nobody thought of it. Everything that breaks the rules of the format is an Error that names file and place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <unordered_set>
#include <vector>

namespace kage::scene {

class GltfJson {
 public:
  using Json = nlohmann::json;

  /// `name` is how messages call the file.
  explicit GltfJson(std::string name) : name_(std::move(name)) {}

  [[nodiscard]] const Json& root() const { return root_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  [[noreturn]] void fail(const std::string& place, const std::string& cause) const;

  /// Number of elements of a top-level array such as "meshes".
  [[nodiscard]] std::size_t count(const char* array) const;
  /// Element of a top-level array, an object. `place` is who asks.
  [[nodiscard]] const Json& item(const char* array, std::uint64_t index, const std::string& place) const;
  /// The same of any array: messages call it `what`.
  [[nodiscard]] const Json& item_of(const Json& array, std::uint64_t index, const char* what,
                                    const std::string& place) const;

  // Members of an object. An absent member gives the default; one of another type is an Error. All count as read.
  [[nodiscard]] bool has(const Json& object, const char* key) const { return find(object, key) != nullptr; }
  [[nodiscard]] std::optional<std::uint64_t> integer(const Json& object, const char* key,
                                                     const std::string& place) const;
  [[nodiscard]] std::optional<double> number(const Json& object, const char* key, const std::string& place) const;
  [[nodiscard]] bool boolean(const Json& object, const char* key, bool otherwise, const std::string& place) const;
  [[nodiscard]] std::string text(const Json& object, const char* key, const std::string& place) const;
  /// `size` numbers, or none where the key is absent.
  [[nodiscard]] std::vector<double> numbers(const Json& object, const char* key, std::size_t size,
                                            const std::string& place) const;
  /// An array or object, or an empty one where the key is absent. The elements of an array do not count as read.
  [[nodiscard]] const Json& array(const Json& object, const char* key, const std::string& place) const;
  [[nodiscard]] const Json& object(const Json& parent, const char* key, const std::string& place) const;
  /// The parent's `extensions`.`name`, or an empty object.
  [[nodiscard]] const Json& extension(const Json& parent, const char* name, const std::string& place) const;
  [[nodiscard]] bool has_extension(const Json& parent, const char* name, const std::string& place) const;
  /// The parent's `extras`.`kage`, or an empty object: other programs' extras may be anything.
  [[nodiscard]] const Json& own_extras(const Json& parent) const;

  /// Counts all that an object holds as read: for one that is ignored as a whole, with a note of its own.
  void pass_over(const Json& object) const;

  /// Keys that nobody has read, of objects that somebody has: how often each, by the array that the object stands in
  /// and the way down to the key, "materials/pbrMetallicRoughness/metallicFactor". Objects that nothing refers to, as a
  /// material that no mesh has, are passed over; so are extras.
  [[nodiscard]] std::map<std::string, std::size_t> unread() const;

  /// Whether the file says that it uses an extension.
  [[nodiscard]] bool uses(const char* extension) const;

  /// Names of all extensions that the file says it uses, or that stand anywhere in it.
  [[nodiscard]] std::set<std::string> extensions() const;

 protected:
  void set_root(Json root) { root_ = std::move(root); }

 private:
  const Json* find(const Json& object, const char* key) const;
  void unread_of(const Json& object, const std::string& way, std::map<std::string, std::size_t>& found) const;
  void descend(const Json& value, const std::string& way, bool indexed,
               std::map<std::string, std::size_t>& found) const;

  std::string name_;
  Json root_;
  // Values that were read: they stay where they are, in the nodes of maps and the storage of arrays, when this moves.
  mutable std::unordered_set<const Json*> read_;
};

}  // namespace kage::scene
