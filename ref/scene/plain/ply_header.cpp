// SPDX-License-Identifier: Apache-2.0
#include "scene/plain/ply_header.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "scene/notes.hpp"

namespace kage::scene {
namespace {

PlyType type_of(std::string_view word) {
  // The format's names, and those with sizes that most programs write.
  constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{{{"char", PlyType::kInt8},
                                                                         {"uchar", PlyType::kUint8},
                                                                         {"short", PlyType::kInt16},
                                                                         {"ushort", PlyType::kUint16},
                                                                         {"int", PlyType::kInt32},
                                                                         {"uint", PlyType::kUint32},
                                                                         {"float", PlyType::kFloat},
                                                                         {"double", PlyType::kDouble},
                                                                         {"int8", PlyType::kInt8},
                                                                         {"uint8", PlyType::kUint8},
                                                                         {"int16", PlyType::kInt16},
                                                                         {"uint16", PlyType::kUint16},
                                                                         {"int32", PlyType::kInt32},
                                                                         {"uint32", PlyType::kUint32},
                                                                         {"float32", PlyType::kFloat},
                                                                         {"float64", PlyType::kDouble}}};
  const auto* const at =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& type) { return type.first == word; });
  return at == kTypes.end() ? PlyType::kNone : at->second;
}

class HeaderReader {
 public:
  explicit HeaderReader(TextLines& lines) : lines_(lines) {}

  PlyHeader run() {
    if (!lines_.next() || trimmed(lines_.line()) != "ply") lines_.fail("does not begin with 'ply'");
    const bool returns = lines_.ended_at_return();
    while (lines_.next()) {
      std::string_view rest = lines_.line();
      const std::string_view key = take_word(rest);
      if (key == "end_header") {
        if (!has_form_) lines_.fail("the header has no 'format'");
        return std::move(header_);
      }
      read(key, rest);
      // The first byte of binary data may be a line feed.
      if (returns && has_form_ && header_.form != PlyHeader::Form::kAscii) lines_.end_at_returns();
    }
    lines_.fail("the file ends within the header");
  }

 private:
  void read(std::string_view key, std::string_view rest) {
    if (key == "format")
      read_form(rest);
    else if (key == "element")
      read_element(rest);
    else if (key == "property")
      read_property(rest);
    else if (key == "comment")
      read_comment(rest);
    else if (!key.empty() && key != "obj_info")
      read_other(key);
  }

  void read_comment(std::string_view rest) {
    if (take_word(rest) == "TextureFile") header_.textures.emplace_back(trimmed(rest));
  }

  /// Blender 2.4 left out "comment". In text each element has a line, so that a property which was not understood shows
  /// there; in a binary file it would move all values behind it.
  void read_other(std::string_view key) {
    const std::string what =
        "'" + one_line(key, 40) + "' is none of format, comment, obj_info, element, property and end_header";
    if (!has_form_ || header_.form != PlyHeader::Form::kAscii) lines_.fail(what);
    header_.ignored.push_back("line " + std::to_string(lines_.at()) + " is ignored: " + what);
  }

  void read_form(std::string_view rest) {
    const std::string_view form = take_word(rest);
    if (form == "ascii")
      header_.form = PlyHeader::Form::kAscii;
    else if (form == "binary_little_endian")
      header_.form = PlyHeader::Form::kLittle;
    else if (form == "binary_big_endian")
      header_.form = PlyHeader::Form::kBig;
    else
      lines_.fail("format '" + one_line(form, 40) + "' is unknown");
    const std::string_view version = take_word(rest);
    if (version != "1.0") lines_.fail("version '" + one_line(version, 40) + "' is not 1.0");
    has_form_ = true;
  }

  void read_element(std::string_view rest) {
    PlyElement element;
    element.name = take_word(rest);
    element.count = lines_.whole(take_word(rest), "count of elements");
    const bool twice = std::any_of(header_.elements.begin(), header_.elements.end(),
                                   [&](const PlyElement& e) { return e.name == element.name; });
    if (twice) lines_.fail("there is a second element '" + one_line(element.name, 40) + "'");
    header_.elements.push_back(std::move(element));
  }

  void read_property(std::string_view rest) {
    if (header_.elements.empty()) lines_.fail("a property stands before the first element");
    PlyProperty property;
    std::string_view type = take_word(rest);
    if (type == "list") {
      const std::string_view count = take_word(rest);
      property.count = type_of(count);
      if (property.count == PlyType::kNone || !is_integer(property.count))
        lines_.fail("'" + one_line(count, 40) + "' is no type of a list's length");
      type = take_word(rest);
    }
    property.type = type_of(type);
    if (property.type == PlyType::kNone) lines_.fail("type '" + one_line(type, 40) + "' is unknown");
    property.name = take_word(rest);
    if (property.name.empty()) lines_.fail("a property has no name");
    std::vector<PlyProperty>& all = header_.elements.back().properties;
    if (std::any_of(all.begin(), all.end(), [&](const PlyProperty& p) { return p.name == property.name; }))
      lines_.fail("there is a second property '" + one_line(property.name, 40) + "'");
    all.push_back(std::move(property));
  }

  TextLines& lines_;
  PlyHeader header_;
  bool has_form_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 9> kSizes{0, 1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::size_t PlyElement::least_size() const {
  std::size_t size = 0;
  for (const PlyProperty& p : properties) size += size_of(p.count == PlyType::kNone ? p.type : p.count);
  return size;
}

PlyHeader read_ply_header(TextLines& lines) { return HeaderReader(lines).run(); }

}  // namespace kage::scene
