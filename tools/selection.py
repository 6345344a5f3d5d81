# SPDX-License-Identifier: Apache-2.0
"""Which tests a change concerns, as far as files name each other, and what the build must make for tests.

usage: selection.py changed BUILD [BASE]         names of tests, one a line: those that read a file which differs from BASE
       selection.py needs BUILD [OPTION of ctest...]     outputs of the build that the selected tests need

A test reads the files that its command names, and those that they include, import, instantiate or name in turn. A change in
C++ concerns the tests that include the file's header, or a header of its room (tools/rooms.py) through which the file is
called. Tests that call it only through another room's library are left to CI, which runs all. A change of a file that every
test stands on (CMake lists, rtl/defs, ...) concerns all.
"""

import collections
import fnmatch
import functools
import json
import pathlib
import re
import shutil
import subprocess
import sys

import rooms

TOP = pathlib.Path(__file__).resolve().parent.parent
CPP = (".cpp", ".hpp", ".h", ".c", ".inc")
SV = (".sv", ".svh", ".v")
EVERYTHING = ("CMakeLists.txt", "CMakePresets.json", "cmake/*", "*/CMakeLists.txt", "rtl/defs/*", "tools/lib.sh")
# Tests that look over the whole tree, in seconds: they go with every change.
WHOLE_TREE = (
    "contract/defects",
    "contract/definition",
    "contract/layers",
    "contract/links",
    "contract/one_place",
    "tools/gen-defs",
)
# Programs of tests that are not named as their test, with what they are made of.
PROGRAMS = {
    "kage_extremes": "verif/extremes/*.cpp",
    "mutants": "verif/mutants/*",
    "mesh_figures": "verif/test/meshes/figures.cpp",
    "fake_board": "verif/test/support/fake_board.*",
    **{
        f"rtl_core_{kind}": f"verif/test/rtl/core_{kind}.cpp"
        for kind in ("random", "clocks", "display", "same", "light")
    },
}
# Tests that read all files of a kind, without a name in their script.
READERS = {
    "docs/*": ("contract/*", "docs/*"),
    "README.md": ("contract/*", "docs/*"),
    "tools/*": ("tools/*", "contract/figures"),
    "constraints/*": ("synth/*", "contract/figures"),
    ".github/*": ("contract/workflow",),
    ".ci/*": ("contract/workflow",),
    ".githooks/*": ("tools/commit-msg",),
    "verif/cosim/diverge/monitors/*": ("unit/cosim/divergence", "unit/cosim/stages"),
    "verif/cosim/report/page/*": ("cli/report",),
    "verif/explore/page/*": ("cli/sweep_in_browser", "cli/sweep_page"),
    "verif/mutants/*": ("mutants/*",),
    "verif/bench/*": ("contract/counted",),
    "verif/test/report/*": ("cli/report",),
    "verif/cosim/model/faults.yaml": ("rtl/fault_*", "unit/cosim/faults"),
    "verif/test/examples/*": ("examples/*",),
    "verif/fuzz/*": ("fuzz/*",),
    "verif/test/formal/undecided_synchronizer.sv": ("formal/async_fifo",),
    "verif/test/package/*": ("package/*",),
    "verif/test/support/import_answers.cpp": ("unit/scene/import",),
    "verif/test/hls/*": ("hls/*",),
    "ref/bind/*": ("unit/bind/*", "python/*", "examples/*"),
    "ref/scene/plugin/*": ("unit/scene/*", "scene/meshes"),
    "tools/fpga*": ("cli/fpga", "synth/*"),
    "rtl/*.sv": ("rtl/contracts", "rtl/tb", "rtl/template"),
    "rtl/*.v": ("rtl/contracts", "rtl/tb", "rtl/template"),
    "rtl/*.svh": ("rtl/contracts", "rtl/tb", "rtl/template"),
    "rtl/kage.f": ("rtl/tb", "cli/vectors*"),
    "ref/include/kage/golden*": ("unit/bind/*", "python/*", "examples/*"),
    "ref/plugin/*": ("cli/plugins", "unit/scene/import"),
    "ref/simd/*": ("simd/*", "cli/simd"),
    "verif/vectors/bench/*": ("cli/vectors*",),
    "verif/cosim/model/driver/*": ("cli/cosim", "cli/model_*", "rtl/families_39_40_41_flat4"),
    "constraints/boards/sim/*": ("board/*", "cli/board", "rtl/sdram", "rtl/frame_memory"),
    "tools/gates": ("gates/*",),
    "scenes/*": ("scene/builtin", "cli/scene_*", "cli/cosim"),
    "python/*": ("python/*",),
    "hls/*": ("hls/*",),
    "examples/*": ("examples/*",),
}
MODEL = ("rtl/kage_top.sv", "verif/cosim/model/driver/*")


def run(*command):
    return subprocess.run(command, cwd=TOP, capture_output=True, text=True, check=True).stdout


def room_of(file):
    """The folder that is a file's room."""
    if file.startswith("ref/include/kage/"):
        return "ref/" + rooms.OWNERS.get(file.rsplit("/", 1)[1], "include")
    if file.startswith("ref/"):
        return "/".join(file.split("/")[:2])
    return max((room for room in rooms.ABOVE if file.startswith(f"{room}/")), key=len, default=file)


def listed_files(top):
    """The files of a checkout. Where git is not, as in an archive, all but what builds and runs make."""
    if shutil.which("git") and (top / ".git").exists():
        return run("git", "-C", str(top), "ls-files", "-z", "--cached", "--others", "--exclude-standard").split("\0")
    made = ("build", "out", ".git")
    return [str(p.relative_to(top)) for p in top.rglob("*") if p.relative_to(top).parts[0] not in made]


class Tree:
    """The files of a checkout, and which of them a file names."""

    def __init__(self, top=TOP):
        self.top = top
        self.files = {file for file in listed_files(top) if (top / file).is_file()}
        self.cpp = {file for file in self.files if file.endswith(CPP)}
        self.modules = {pathlib.PurePath(file).stem: file for file in sorted(self.files) if file.endswith(SV[:1])}
        self.read = {}  # what each test reads, once it has been asked for
        self.by_name = {}
        for file in self.files:
            self.by_name.setdefault(pathlib.PurePath(file).name, []).append(file)

    def matching(self, pattern):
        return fnmatch.filter(self.files, pattern)

    @functools.cache
    def text(self, file):
        return (self.top / file).read_text(errors="replace")

    @functools.cache
    def named(self, file):
        """The files that a file includes, instantiates or names."""
        if file.endswith(CPP):
            return {t for name in rooms.includes(self.text(file)) for t in rooms.targets(file, name, self.cpp)}
        if file.endswith(SV):
            words = set(re.findall(r"[\w.]+", re.sub(r"//[^\n]*|/\*.*?\*/", "", self.text(file), flags=re.S)))
            found = {self.modules[word] for word in words if word in self.modules}
            return found | {f for word in words if word.endswith(".svh") for f in self.by_name.get(word, [])}
        if not re.match(r"(verif|tools|hls|scenes|constraints)/", file) or file.endswith((".yaml", ".md", ".json")):
            return set()
        words = set(re.findall(r"[\w./-]+", self.text(file)))
        words |= {word.rsplit("/", 1)[-1] for word in words if word.startswith("/")}
        here = str(pathlib.PurePath(file).parent)
        imports = re.findall(r"^\s*(?:import|from) (\w+)", self.text(file), re.M)
        paths = {word.lstrip("./") for word in words if "/" in word} | {
            f"{here}/{word}" for word in words if "." in word
        }
        return (paths | {f"{folder}/{name}.py" for name in imports for folder in (here, "tools")}) & self.files

    @functools.cache
    def closure(self, file):
        """All that a file reads: of a kind with it in turn; a script reads scripts beside it, and other files as they are."""
        found, open_ = set(), {file}
        while open_:
            at = open_.pop()
            found.add(at)
            if at == file or at.endswith(CPP) or at.endswith(SV) and file.endswith(SV):
                open_ |= self.named(at) - found
            elif not at.endswith(SV) and pathlib.PurePath(at).parent == pathlib.PurePath(file).parent:
                open_ |= self.named(at) - found
        return found

    @functools.cache
    def room(self, file):
        """The C++ files of a file's room, and the public headers whose functions it has."""
        own = room_of(file)
        public = {f"ref/include/kage/{name}" for name in rooms.PUBLIC.get(own.removeprefix("ref/"), [])}
        return public | {f for f in self.cpp if room_of(f) == own}

    @functools.cache
    def interface(self, changed):
        """The headers through which a changed C++ file is called. The first is itself or the one of its name. Then come
        the headers of files in its room that include one of these, and so on. In ref/ a file without a header of its name
        counts for all of its room. Nobody calls a test's source."""
        if room_of(changed) == "verif/test":
            return {changed}
        room = self.room(changed)
        headers = {file for file in room if file.endswith(CPP) and not file.endswith(".cpp")}

        def own(file):
            stem = pathlib.PurePath(file).stem
            return {h for h in headers if pathlib.PurePath(h).stem == stem}

        found = ({changed} & headers) | own(changed) or headers
        while True:
            callers = {f for f in room if self.closure(f) & found}
            more = found.union(
                *(
                    own(file) or (headers if file.startswith("ref/") and file.endswith(".cpp") else set())
                    for file in callers
                )
            )
            if more == found:
                return found | {changed}
            found = more


def listed(build, options=()):
    """The tests that ctest selects. It leaves out the commands of programs that are not built: CMake's files have them."""
    commands = {}
    for file in build.rglob("CTestTestfile.cmake"):
        for name, words in re.findall(r"^add_test\(\[=\[(.*?)\]=\] (.*)\)$", file.read_text(), re.M):
            commands[name] = re.findall(r'"((?:\\.|[^"\\])*)"', words)
    found = json.loads(run("ctest", "--test-dir", str(build), "--show-only=json-v1", *options))["tests"]
    return [{**test, "command": commands[test["name"]]} for test in found]


def tops(tree, name):
    """The modules that the tests of verif/test/rtl/NAME.cpp verilate."""
    lists = tree.text("verif/test/rtl/CMakeLists.txt")
    part = re.search(rf"^rtl_test\({name}\)$(.*?)^(rtl_test|file)\(", lists, re.M | re.S)
    found = re.findall(r"rtl_model\(\S+ ([^\s)]+)", part[1]) if part else []
    patterns = [re.sub(r"\$\{\w+\}", "*", top) for top in found]
    return {tree.modules[m] for p in patterns for m in fnmatch.filter(tree.modules, p)}


def seeds(tree, test):
    """The files that a test's command names, and those that its programs are made of."""
    name, command = re.sub(r"^simd/\w+/", "", test["name"]), test["command"]
    given = [str(p["value"]) for p in test["properties"] if p["name"] == "ENVIRONMENT"]
    command = command + re.findall(r"=(/[^;,'\"\]]+)", " ".join(given))
    globs = [command[at + 1] for at, word in enumerate(command) if word == "--reads"]
    # A proof declares all modules, and reads its own with those within it.
    found = {file for glob in globs if not name.startswith("formal/") for file in tree.matching(glob)}
    found |= {word[len(str(tree.top)) + 1 :] for word in command if word.startswith(f"{tree.top}/")} & tree.files
    found |= {
        f
        for f in (f"verif/test/{name}.cpp", f"verif/test/{name}.sh", f"verif/test/formal/{name[7:]}_proof.sv")
        if f in tree.files
    }
    for word in command:
        found |= set(tree.matching(PROGRAMS.get(pathlib.PurePath(word).name, "")))
    if command[0].endswith("/rtl_modules"):
        found |= {f"verif/test/{name}.cpp"} | tops(tree, name.removeprefix("rtl/"))
    if any(word.endswith(".so") for word in command) or name == "cli/cosim":
        found |= {file for pattern in MODEL for file in tree.matching(pattern)}
    if name.startswith("cli/"):
        words = name[4:].split("_")
        script = f"verif/test/{name}.sh"
        called = (
            collections.Counter(re.findall(r'"?\$kage"? ([a-z]+)', tree.text(script))) if script in tree.files else {}
        )
        commands = words[:1] if f"cli/{words[0]}.cpp" in tree.files else called.most_common(1)[0][:1] if called else []
        found |= {
            f for command in commands for p in (f"cli/{command}.cpp", f"cli/{command}_*.cpp") for f in tree.matching(p)
        }
    return found


def reads(tree, test):
    """The files that a test reads, and the C++ files that it names itself: includes of its sources, of headers made for tests,
    and of the program's file for the command that it tries."""
    begin = seeds(tree, test)
    everything = set().union(*(tree.closure(file) for file in begin))
    own = begin | {file for file in everything if file.startswith(("verif/test/", "verif/extremes/"))}
    return everything, own.union(*(tree.named(file) for file in own if file.endswith(CPP)))


def ways_to(tree, file):
    """Sets of headers that lead to a changed C++ file, the nearest first: its interface, its room, the interfaces of its callers."""
    if file.endswith(CPP):
        yield tree.interface(file)
    if file.endswith(CPP) and room_of(file) != "verif/test":
        yield tree.room(file)
        yield set().union(*(tree.interface(f) for f in tree.cpp if file in tree.closure(f)))


def concerned(tree, tests, changed):
    """Names of tests that a change concerns, None where all are, and the changed files that no test reads. A C++ file concerns
    the tests that name a header of the nearest way to it that any test names."""
    if any(fnmatch.fnmatch(file, pattern) for file in changed for pattern in EVERYTHING):
        return None, []
    read = {}
    for test in tests:
        if test["name"] == "tools/selection":  # it names files as examples
            continue
        name = test["name"]
        read[name] = tree.read[name] = tree.read.get(name) or reads(tree, test)
    chosen = {name for name in read if any(fnmatch.fnmatch(name, pattern) for pattern in WHOLE_TREE)}
    unread = []
    for file in changed:
        hits = set()
        for asked in ways_to(tree, file):
            hits = hits or {name for name, (_, direct) in read.items() if asked & direct}
        hits = hits or {name for name, (reached, _) in read.items() if file in reached}
        readers = [pattern for kind, names in READERS.items() if fnmatch.fnmatch(file, kind) for pattern in names]
        hits |= {name for name in read if any(fnmatch.fnmatch(name, pattern) for pattern in readers)}
        unread += [] if hits else [file]
        chosen |= hits
    return chosen, unread


def changed_files(base):
    """Files that differ from the commit at which this branch left BASE."""
    fork = run("git", "merge-base", base, "HEAD").strip()
    differing = run("git", "diff", "-z", "--name-only", "--no-renames", fork, "--").split("\0")
    return sorted({*differing, *run("git", "ls-files", "-z", "--others", "--exclude-standard").split("\0")} - {""})


def is_long(test):
    return any("long" in p["value"] for p in test["properties"] if p["name"] == "LABELS")


def print_changed(build, base="HEAD"):
    tree, tests = Tree(), listed(build)
    files = changed_files(base)
    if not files and base == "HEAD":
        base = "HEAD~1"
        files = changed_files(base)
    chosen, unread = concerned(tree, tests, files)
    short = [test["name"] for test in tests if not is_long(test)]
    names = [name for name in short if chosen is None or name in chosen]
    left = sorted((chosen or set()) - set(short))
    for file in unread:
        print(f"no test reads {file} by itself", file=sys.stderr)
    print(f"{len(files)} files differ from {base}: {len(names)} of {len(short)} tests", file=sys.stderr)
    if left:
        print(f"left to CI, or to tools/test -R NAME: {' '.join(left)}", file=sys.stderr)
    print("".join(f"{name}\n" for name in names), end="")


def outputs(build):
    """The files that the build makes."""
    return {line.rsplit(": ", 1)[0] for line in run("ninja", "-C", str(build), "-t", "targets", "all").splitlines()}


def needs(build, options):
    """The outputs that the selected tests' commands name. A folder stands for all programs and libraries in it, the build's own
    for everything."""
    known, needed = outputs(build), set()
    made = {file for file in known if re.match(r"(bin|lib|bench|verif/bin)/", file)}
    for test in listed(build, options):
        named = [p["value"] for p in test["properties"] if p["name"] in ("ENVIRONMENT", "REQUIRED_FILES")]
        for text in [*test["command"], *map(str, named)]:
            for path in re.findall(re.escape(str(build)) + r"(?:/([^\s,;'\"\]]*))?", text):
                if not path:
                    needed |= {"all"}
                elif path in known:
                    needed.add(path)
                else:
                    needed |= {file for file in made if file.startswith(f"{path}/")}
    return sorted(needed)


def print_needs(build, *options):
    print("".join(f"{file}\n" for file in needs(build, options)), end="")


if __name__ == "__main__":
    jobs = {"changed": print_changed, "needs": print_needs}
    if len(sys.argv) < 3 or sys.argv[1] not in jobs:
        sys.exit(__doc__)
    jobs[sys.argv[1]](pathlib.Path(sys.argv[2]).resolve(), *sys.argv[3:])
