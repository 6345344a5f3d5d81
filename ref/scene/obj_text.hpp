// SPDX-License-Identifier: Apache-2.0
//
// The text of an OBJ file as Assimp reads all of it. Assimp leaves out what it does not recognise without a word: a
// vertex with ".5" in it, an indented line, a vertex with numbers in its comment. The vertices after it move up, and
// faces get other corners than the file's.
#pragma once

#include <istream>
#include <set>
#include <string>
#include <vector>

namespace kage::scene {

struct ObjText {
  /// The same statements, one to a line, with neither indent nor continued lines. Those of numbers (v, vt, vn, vp, f,
  /// l, p) have no comment either, and a 0 before a leading point.
  std::string text;
  std::vector<std::string> libraries;  ///< the files that mtllib names, each once, in the file's order
  std::set<std::string> materials;     ///< the names that usemtl asks for
};

/// Throws Error with the line's number where a vertex has other than 3, 4 or 6 numbers (x y z, w or r g b), or a word
/// that is no number, or where a face, line or point names a vertex that is not there. `name` is for messages.
ObjText plain_obj(std::istream& in, const std::string& name);

/// The names that newmtl gives in the text of a material library.
std::set<std::string> material_names(std::istream& in);

}  // namespace kage::scene
