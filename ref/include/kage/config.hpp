// SPDX-License-Identifier: Apache-2.0
//
// Configurations of the core: reading, checking, naming. The parameters themselves come from rtl/defs/kage.yaml by
// defs.hpp.
#pragma once

#include <string>
#include <vector>

#include "kage/defs.hpp"

namespace kage {

/// A configuration and its name: that of the list, or the file it came from.
struct NamedConfig {
  std::string name;
  Config config;
};

/// Throws Error if a parameter is out of its range or two do not fit together (docs/stream.md, Parameters).
/// `where` opens the message: "my.yaml: Z_BITS is 40, legal are 4 .. 28".
void validate(const Config& config, const std::string& where);

/// The named configurations of rtl/defs/configs.yaml, in listed order, all valid.
std::vector<NamedConfig> named_configs();

/// The configuration with this name, or the one in this file: YAML, one `PARAMETER: value` a line, others at their
/// defaults.
NamedConfig load_config(const std::string& name_or_file);

/// The parameters as YAML, one a line, in the order of the definition file.
std::string to_yaml(const Config& config);

/// What a scene asks of a core, as far as it decides which named configuration can draw it.
struct Needs {
  int width = 1;
  int height = 1;
  bool shadows = false;
  bool several_volumes = false;  ///< by parity more than one volume; with DSF_BITS > 1 one may do
  bool smooth = false;           ///< colour varies within a polygon
  bool color = false;            ///< some colour is not grey
  bool translucency = false;     ///< something is translucent
  int lights = 1;                ///< that cast shadows
  int samples = 1;               ///< of a light, at most
};

/// What `config` lacks of `needs`: one word or phrase each ("SMOOTH", "MAX_WIDTH >= 1280"), empty if nothing.
std::vector<std::string> lacks(const Config& config, const Needs& needs);

/// The first named configuration that lacks nothing; if there is none, Error names the one that lacks the fewest
/// things, and those.
NamedConfig choose_config(const Needs& needs);

/// The first named configuration that lacks only width, or some of its several lights or their samples, with as much of
/// them as asked: the line of YAML that a file for load_config() would hold. Empty if there is none.
std::string widened_config(const Needs& needs);

}  // namespace kage
