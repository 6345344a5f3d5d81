# SPDX-License-Identifier: Apache-2.0
"""CMake lists link, name and install nothing that their rooms may not: a part of layers.py."""

import posixpath
import re

from rooms import ABOVE, EXEMPT, JUDGES, PRODUCTS, is_below, may, place

# A comment, a text, a parenthesis or a word.
PIECE = re.compile(r'#[^\n]*|\[\[.*?\]\]|"(?:\\.|[^"\\])*"|[()]|[^\s()"#]+', re.S)
PATH = re.compile(r"(?:\$\{\w+\}|[\w.*/+-])+")
MAKE = ("add_library", "add_executable", "add_custom_target", "kage_executable", "kage_plugin")
LINK = ("add_library", "add_executable", "kage_executable", "kage_plugin", "target_link_libraries", "target_sources")
# Lists that put the build together: they may name every room.
OF_THE_BUILD = ("CMakeLists.txt", "verif/CMakeLists.txt", "verif/long_tests.cmake")
# Where names of includes begin. Includes are judged file by file.
ROOTS = ("ref", "ref/include", "verif")
# The libraries of the golden model stand for its public headers.
REF = "ref/CMakeLists.txt"


def is_list(path):
    return path.endswith((".cmake", "/CMakeLists.txt")) or path == "CMakeLists.txt"


def commands(text):
    """(name, words) of each command."""
    name, words, depth = "", [], 0
    for piece in PIECE.findall(text):
        if piece.startswith("#"):
            continue
        depth += {"(": 1, ")": -1}.get(piece, 0)
        if piece == ")" and depth == 0:
            yield name, words
            words = []
        elif piece not in "()":
            if depth == 0:
                name = piece
            else:
                words.append(piece)


def makers(lists):
    """The list that makes each target, of those whose names are no variables."""
    return {
        words[0]: path
        for path, text in lists.items()
        for name, words in commands(text)
        if name in MAKE and re.fullmatch(r"[\w:]+", words[0])
    }


def named(path, text, names):
    """(command, file or folder of the source) that a list names. A variable in a name stands for anything. Names of the
    build's files and of installed ones are left out."""
    here = "" if path.startswith("cmake/") else posixpath.dirname(path)  # the list at the top reads those of cmake/
    known = {"PROJECT_SOURCE_DIR": "/", "CMAKE_CURRENT_SOURCE_DIR": f"/{here}"}

    def whole(word):
        return re.sub(r"\$\{(\w+)\}", lambda m: known.get(m[1], m[0]), word)

    for name, words in commands(text):
        if name == "set" and len(words) == 2:
            known.setdefault(words[0], whole(words[1]))
        for word in (w for piece in words for w in PATH.findall(re.sub(r"^-[IDL]", "", piece))):
            word = re.sub(r"\$\{\w*(BINARY|INSTALL)\w*\}.*", "", whole(word))
            word = re.sub(r"\$\{\w+\}", "*", re.sub(r"/+", "/", word))
            if not word.strip("*"):
                continue
            tries = [word[1:]] if word.startswith("/") else [posixpath.join(here, word)]
            if not word.startswith("/") and ("/" in word or name == "install"):
                tries.append(word)
            for target in map(posixpath.normpath, tries):
                pattern = re.compile(re.escape(target).replace(r"\*", "[^/]*"))
                hits = {target} & names.keys() if "*" not in target else [n for n in names if pattern.fullmatch(n)]
                if hits and "*" not in target.split("/")[0]:
                    yield from ((name, hit) for hit in hits)
                    break


def may_name(path, target):
    """Whether a room's list may name a file or a folder, or link a target that this list makes."""
    if target in ROOTS or not is_below(target, ("ref", "verif", "cli")):
        return True
    if path.startswith("ref/"):
        return target.startswith("ref/")
    if any(path.startswith(room + "/") for room in ABOVE):
        return may(path, "ref/include/kage/defs.hpp" if target == REF else f"{target}/")
    return not is_below(target, JUDGES)


def refused(path, text, lists, names, used=None):
    """A line for each thing that a list of this path may not have. `lists` has all lists by path. `names` has all files and
    folders, and whether each is a file. Exemptions that are needed go into `used`."""
    made_by, bad = makers({**lists, path: lists.get(path, "") + "\n" + text}), set()
    of_a_room = not path.startswith("cmake/") and path not in OF_THE_BUILD
    for name, words in commands(text):
        for word in (w for piece in words for w in re.findall(r"\w+(?:::\w+)*", piece)) if name in LINK else ():
            maker = made_by.get(word, path)
            if of_a_room and not maker.startswith("cmake/") and not may_name(path, maker):
                bad.add(f"links {word} of {maker}, which its room may not include")
        installed = (
            words[1:] if name == "install" and words[0] == "TARGETS" else words[:1] if name == "kage_plugin" else []
        )
        bad |= {f"installs {w}, which is no product" for w in installed if not is_below(made_by.get(w, REF), PRODUCTS)}
    for name, target in named(path, text, names):
        if name == "install" and not is_below(target, PRODUCTS) and not (names[target] and "/" not in target):
            bad.add(f"installs {target}, which is no product")
        if of_a_room and not may_name(path, target):
            if (path, place(f"{target}/")[0]) not in EXEMPT:
                bad.add(f"names {target}, which its room may not include")
            elif used is not None:
                used.add((path, place(f"{target}/")[0]))
    return sorted(bad)


EXAMPLES = (  # each must be refused
    ("cli/CMakeLists.txt", "target_link_libraries(kage_cli PRIVATE kage_families)"),
    ("ref/CMakeLists.txt", "target_link_libraries(kage PRIVATE kage_cosim)"),
    ("ref/CMakeLists.txt", "add_subdirectory(../verif/stimulus)"),
    ("verif/cosim/CMakeLists.txt", "target_link_libraries(kage_cosim PUBLIC $<BUILD_INTERFACE:kage_session>)"),
    ("verif/cosim/CMakeLists.txt", "kage_plugin(kage_more more kage_vectors)"),
    ("verif/cosim/session/CMakeLists.txt", "file(GLOB sources CONFIGURE_DEPENDS *.cpp ../regress/*.cpp)"),
    ("verif/cosim/session/CMakeLists.txt", "add_library(more STATIC $<TARGET_OBJECTS:kage_vectors>)"),
    ("verif/oracle/CMakeLists.txt", "kage_executable(draws SOURCES draws.cpp LIBS kage_private kage_cosim)"),
    ("verif/oracle/CMakeLists.txt", "target_sources(kage_oracle PRIVATE ../../ref/geometry/geometry.cpp)"),
    (
        "verif/board/CMakeLists.txt",
        "target_sources(kage_board PRIVATE ${PROJECT_SOURCE_DIR}/verif/test/support/fake_board.cpp)",
    ),
    ("verif/vectors/CMakeLists.txt", "target_include_directories(kage_vectors PRIVATE ../test/support)"),
    (
        "verif/explore/CMakeLists.txt",
        "set(found ${PROJECT_SOURCE_DIR}/verif/extremes/found)\nfile(GLOB kept ${found}/*)",
    ),
    (
        "verif/extremes/CMakeLists.txt",
        "add_test(NAME x COMMAND bash ${PROJECT_SOURCE_DIR}/verif/test/extremes/program.sh)",
    ),
    ("verif/bench/CMakeLists.txt", "target_link_libraries(bench_x PRIVATE kage_catch)"),
    ("constraints/CMakeLists.txt", "add_custom_target(x COMMAND ${PROJECT_SOURCE_DIR}/verif/test/cells/run.sh)"),
    (
        "cmake/KageInstall.cmake",
        "install(FILES verif/test/formal/stream_rules.sv DESTINATION ${CMAKE_INSTALL_DATADIR}/kage)",
    ),
    ("cmake/KageInstall.cmake", "install(DIRECTORY rtl verif/test/examples DESTINATION x)"),
    ("cmake/KageInstall.cmake", "install(DIRECTORY verif DESTINATION x)"),
    ("cmake/KageInstall.cmake", "install(PROGRAMS tools/fpga DESTINATION bin)"),
    ("CMakeLists.txt", "install(TARGETS kage kage_extremes RUNTIME DESTINATION bin)"),
    ("verif/fuzz/CMakeLists.txt", "install(TARGETS kage_fuzz_replay RUNTIME DESTINATION bin)"),
    ("verif/mutants/CMakeLists.txt", "kage_plugin(kage_more more)"),
)


def faults(lists, names):
    """A line for each thing that a list may not have, and for what this file has wrong."""
    used = set()
    for path, text in EXAMPLES:
        if not refused(path, text, lists, names):
            yield f"cmake_lists.py lets {path} say {text}"
    for path, text in lists.items():
        yield from (f"{path}: {what}" for what in refused(path, text, lists, names, used))
    yield from (f"rooms.py: EXEMPT: {path}: {room}: is not needed" for path, room in EXEMPT.keys() - used)
    if len(lists) < 20:
        yield f"cmake_lists.py: found {len(lists)} lists only"
