// SPDX-License-Identifier: Apache-2.0
//
// Files in kage's cache are trusted: RTL models are run, and verdicts stand in for runs. So nobody but this user (and
// root, who can do anything) may be able to put them there.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

namespace kage::cosim {

/// The folder `inner` below `base`, each level made with mode 0700 if it is missing. Throws Error, with the way to mend
/// it, if somebody else could change what lies there. A level of `inner` must belong to this user or root and be
/// writable to nobody else. A link to such a folder is as good, if it is this user's or root's and nobody else can put
/// another folder where it leads. `base` and the folders above it may besides be writable to a group of this user's
/// own, as Debian gives each user one. They may be writable to all where the sticky bit keeps them from other people's
/// files, as in /tmp.
std::filesystem::path own_folder(const std::filesystem::path& base, std::initializer_list<const char*> inner);

/// The folder ${XDG_CACHE_HOME:-~/.cache}/kage/NAME, as own_folder() makes and checks it. Throws Error besides if
/// neither XDG_CACHE_HOME nor HOME is set.
std::filesystem::path cache_folder(const char* name);

/// Opens a regular file to read; links are not followed. Returns the descriptor, or -1 if there is no such file. Throws
/// Error, with the way to mend it, if the file does not belong to this user or root, or if others may write to it.
int open_own_file(const std::filesystem::path& file);

}  // namespace kage::cosim
