// SPDX-License-Identifier: Apache-2.0

/// @file
/// The exception of the library.
#pragma once

#include <stdexcept>
#include <string>

/// The library.
namespace kage {

/// The exception that every function of the library throws on bad input. The message is one line and names file, place
/// and cause, in that order, as far as they are known: "scene.gltf: node 'lamp': position is not finite".
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kage
