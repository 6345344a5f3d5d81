// SPDX-License-Identifier: Apache-2.0
//
// Parts of the library that are opened when they are first needed, because what they stand on is large: binding
// OpenImageIO alone takes a command longer than most commands run. A plugin is a shared library of this build, which
// shows one function: it returns a table of what the plugin can do.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace kage {

/// Head of every table: kage's version and a checksum of the headers that declare the tables (CMake makes it). A plugin
/// of another kage is refused.
struct PluginHead {
  const char* version;
};

/// Opens libNAME.so and returns the result of its function NAME_table(). It stays open. The file is taken from
/// $KAGE_PLUGIN_DIR if that is set, else from where it was built, else from lib/kage of where it was installed, else
/// from there beside kage's data. Unless it is in $KAGE_PLUGIN_DIR, it counts only if nobody but this user, root and
/// the program's owner could have put it there. Throws Error that names the missing file and what cannot be done
/// without it. Libraries that start threads end the program where a thread finds no memory. So a plugin is refused
/// unless `room` bytes of address space are free, and, if `room` is not 0, unless some threads can be started.
const PluginHead* open_plugin(const std::string& name, const std::string& what_for, std::size_t room);

/// Whether libNAME.so is where open_plugin() looks for it.
bool has_plugin(const std::string& name);

/// The version that both sides must have: PluginHead.
extern const char* const kPluginVersion;

/// The program `file`, which stands beside the plugins: in $KAGE_PLUGIN_DIR if it is there, else in the folders of
/// open_plugin(). A scene of plain formats takes no plugin, so a folder of plugins may lack it. Throws Error as
/// open_plugin().
std::filesystem::path helper_file(const std::string& file, const std::string& what_for);

/// The table of a plugin, opened once.
template <typename Table>
const Table& plugin_table() {
  static const auto* const table =
      static_cast<const Table*>(open_plugin(Table::kPlugin, Table::kWhatFor, Table::room()));
  return *table;
}

}  // namespace kage
