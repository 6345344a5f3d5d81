// SPDX-License-Identifier: Apache-2.0

/// @file
/// Configurations of the core: reading, checking, naming. The parameters themselves come from rtl/defs/kage.yaml by
/// defs.hpp.
#pragma once

#include <string>
#include <vector>

#include "kage/defs.hpp"

namespace kage {

/// A configuration and its name.
struct NamedConfig {
  std::string name;  ///< that of the list, or the file it came from
  Config config;     ///< the parameters, legal
};

/// Judges a configuration. Throws Error if a parameter is out of its range or two do not fit together (docs/stream.md,
/// Parameters).
/// @param config what is judged
/// @param where opens the message: "my.yaml: Z_BITS is 40, legal are 4 .. 28"
void validate(const Config& config, const std::string& where);

/// The list of rtl/defs/configs.yaml. Throws Error if kage's data is not there.
/// @return the named configurations, in listed order, all legal
std::vector<NamedConfig> named_configs();

/// Finds a configuration. Throws Error that names the file, or the names there are.
/// @param name_or_file a name of the list, or a file: YAML, one `PARAMETER: value` a line, others at their defaults
/// @return the configuration, legal
NamedConfig load_config(const std::string& name_or_file);

/// Writes a configuration as load_config() reads it.
/// @param config what is written
/// @return YAML, one parameter a line, in the order of the definition file
std::string to_yaml(const Config& config);

/// A scene's needs that decide which named configuration can draw it.
struct Needs {
  int width = 1;                 ///< of the picture, in pixels
  int height = 1;                ///< of the picture, in lines
  bool shadows = false;          ///< something opaque may cast a shadow that is seen
  bool several_volumes = false;  ///< by parity more than one volume; with DSF_BITS > 1 one may do
  bool smooth = false;           ///< colour varies within a polygon
  bool color = false;            ///< some colour in view is not grey
  bool translucency = false;     ///< something translucent is in view
  int lights = 1;                ///< that cast shadows
  int samples = 1;               ///< of a light, at most
  /// How far colours in shadow are off, in steps of 255, where all shadows take one share (LightDemand).
  double share_error = 0;
  /// Likewise within a polygon that has one colour.
  double color_spread = 0;

  /// Whether light is more than a step off without a table of what shadows take.
  /// @return so it is
  [[nodiscard]] bool light_table() const { return shadows && share_error > 1; }
  /// Whether it is without colour that varies within a polygon.
  /// @return so it is
  [[nodiscard]] bool near_light() const { return color_spread > 1; }
};

/// Compares a configuration with what is asked of it.
/// @param config a legal configuration
/// @param needs what is asked
/// @return what it lacks, one word or phrase each ("SMOOTH", "MAX_WIDTH >= 1280"), empty if nothing
std::vector<std::string> lacks(const Config& config, const Needs& needs);

/// Compares a configuration with what light asks of it, without which a picture is drawn with less accurate light.
/// @param config a legal configuration
/// @param needs what is asked
/// @return what it approximates, one phrase each ("what shadows take (CLASS_BITS)"), empty if nothing
std::vector<std::string> approximates(const Config& config, const Needs& needs);

/// Chooses among the named configurations. Throws Error if none has all; it names the one that lacks the fewest things,
/// and those.
/// @param needs what is asked
/// @return the first that lacks nothing
NamedConfig choose_config(const Needs& needs);

/// Suggests a configuration file where no named configuration suffices, but one would with greater width, more lights
/// or more samples.
/// @param needs what is asked
/// @return YAML of the first named configuration that suffices once width, lights and samples are raised; empty if none
std::string widened_config(const Needs& needs);

}  // namespace kage
