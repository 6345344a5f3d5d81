// SPDX-License-Identifier: Apache-2.0
//
// Parts of the library that are opened when they are first needed, because what they stand on is large: binding
// OpenImageIO alone takes a command longer than most commands run. A module is a shared library of this build, which
// shows one function: it returns a table of what the module can do.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace kage {

/// What every table begins with: kage's version and a checksum of what both sides take a table to be (CMake makes it of
/// the headers). A module of another kage is refused.
struct ModuleHead {
  const char* version;
};

/// Opens libNAME.so from $KAGE_MODULE_DIR if that is set, else from where it was built, else from lib/kage of where it
/// was installed, else from there beside kage's data, unless others than this user and root may write there, and
/// returns what its function NAME_table() gives. It stays open. Throws Error that names the file that is missing and
/// what cannot be done without it. Libraries that start threads end the program where one finds no memory, so a module
/// is refused unless `room` bytes of address space are free; and unless some threads can be started, if `room` is not
/// 0.
const ModuleHead* open_module(const std::string& name, const std::string& what_for, std::size_t room);

/// The version that both sides must have: ModuleHead.
extern const char* const kModuleVersion;

/// The program `file`, which stands beside the modules: in $KAGE_MODULE_DIR if it is there, else in the folders of
/// open_module(). A scene of plain formats takes no module, so a folder of modules may lack it. Throws Error as
/// open_module().
std::filesystem::path helper_file(const std::string& file, const std::string& what_for);

/// The table of a module, opened once.
template <typename Table>
const Table& module_table() {
  static const auto* const table =
      static_cast<const Table*>(open_module(Table::kModule, Table::kWhatFor, Table::room()));
  return *table;
}

}  // namespace kage
