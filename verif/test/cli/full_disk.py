#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every file that kage writes, on a disk that fills up while it is being written.

usage: full_disk.py KAGE SOURCE yes|no      (yes: file systems may be mounted); run in an empty folder

Each writer writes over old files, with so much room that it just fits, and with less, down to none. Each time it has to
end with all files whole, or with exit code 2, one line that says the cause, and the old files as they were. Room is
limited in two ways: by a tmpfs of a size (ENOSPC), and by RLIMIT_FSIZE (EFBIG), which needs no rights.
"""

import concurrent.futures
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import xml.etree.ElementTree

KAGE, SOURCE, DISKS = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3] == "yes"
HERE = pathlib.Path.cwd()
PAGE = os.sysconf("SC_PAGE_SIZE")
PLENTY = 64 << 20
SECONDS = 120  # that a run may take; one that hangs fails
NO_ROOM = ("No space left on device", "File too large")


def kage(*arguments, limit=None, env=None):
    def limited():
        if limit is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    return subprocess.run(
        [KAGE, *map(str, arguments)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=SECONDS,
        preexec_fn=limited,
        env={**os.environ, "KAGE_PROGRESS": "0", **(env or {})},
    )


# ---- whether a file is whole


def same_bytes(path, good):
    assert path.read_bytes() == good.read_bytes(), "other bytes"


def same_picture(path, good):  # an EXR has its date
    done = kage("diff", path, good)
    assert done.returncode == 0, done.stdout + done.stderr


def same_waveform(path, good):  # an FST has its date, in its header block, which ends at byte 330
    assert path.read_bytes()[330:] == good.read_bytes()[330:], "other bytes"


def shape(
    value,
):  # numbers and texts may differ, as times do; a note says which file may be missing, and its name is null
    if isinstance(value, dict):
        return {k: shape(v) for k, v in value.items() if k != "notes"}
    if isinstance(value, list):
        return [shape(v) for v in value]
    return "text" if value is None else type(value).__name__.replace("str", "text")


def whole_json(path, good):
    parts = [shape(json.loads(p.read_text())) for p in (path, good)]
    assert parts[0] == parts[1], "other parts"


def same_text(path, good):  # but for the folder that it names
    parts = [p.read_text().replace(str(p.parent), "OUT") for p in (path, good)]
    assert parts[0] == parts[1], "other text"


def whole_xml(path, good):
    count = [len(list(xml.etree.ElementTree.parse(p).iter())) for p in (path, good)]
    assert count[0] == count[1], "another number of elements"


def whole_plot(path, good):  # its lines depend on times
    assert xml.etree.ElementTree.parse(path).getroot().tag == xml.etree.ElementTree.parse(good).getroot().tag, (
        "another root"
    )


def whole_page(path, good):
    text = path.read_text()
    assert text.rstrip().endswith("</html>") and abs(len(text) - good.stat().st_size) < 1000, "half a page"


WHOLE = {
    ".png": same_bytes,
    ".kage": same_bytes,
    ".bsp": same_bytes,
    ".gtkw": same_text,
    ".exr": same_picture,
    ".fst": same_waveform,
    ".json": whole_json,
    ".xml": whole_xml,
    ".svg": whole_plot,
    ".html": whole_page,
}


class Writer:
    """A command that writes into the folder OUT. `codes` are its exit codes where all is well. Files whose names end
    with one of `may_miss` may stay away, as the verdict does not depend on them, where a line says why: "no ... was
    written"."""

    def __init__(self, name, *command, codes=(0,), may_miss=()):
        self.name, self.command, self.codes, self.may_miss = name, command, codes, may_miss

    def run(self, folder, **more):
        return kage(*(str(c).replace("OUT", str(folder)) for c in self.command), **more)

    def learn(self):
        """Learns which files it writes where there is room."""
        self.good = HERE / f"good-{self.name}"
        self.good.mkdir()
        done = self.run(self.good)
        assert done.returncode in self.codes, f"{self.name}: exit {done.returncode}: {done.stdout}{done.stderr}"
        self.names = sorted(p.relative_to(self.good) for p in self.good.rglob("*") if p.is_file())
        assert self.names, f"{self.name}: writes nothing"
        self.bytes = sum((self.good / n).stat().st_size for n in self.names)

    def lay_old(self, folder):
        for name in self.names:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(self.old[name.suffix] if name.suffix in self.old else self.old[""], folder / name)

    def check(self, folder, done):
        """Whether all was written; AssertionError where it is neither all nor nothing."""
        there = sorted(p.relative_to(folder) for p in folder.rglob("*") if p.is_file())
        if done.returncode not in self.codes:
            assert done.returncode == 2, f"exit {done.returncode}"
            assert done.stderr.count("\n") == 1 and done.stderr.startswith("kage: "), "not one line on standard error"
            assert any(cause in done.stderr for cause in NO_ROOM), "the cause is not said"
            assert there == self.names, f"files: {[*map(str, there)]}"
            for name in there:
                old = self.old[name.suffix] if name.suffix in self.old else self.old[""]
                assert (folder / name).read_bytes() == old.read_bytes(), f"{name}: an old file has changed"
            return False
        assert not list(folder.rglob(".kage-*")), "unfinished files are left"
        whole = True
        for name in self.names:
            missing = (
                name not in there
                or (folder / name).read_bytes() == self.old.get(name.suffix, self.old[""]).read_bytes()
            )
            if missing and str(name).endswith(self.may_miss):
                lines = [line for line in done.stdout.splitlines() if "was written" in line]
                assert any(cause in line for line in lines for cause in NO_ROOM), (
                    f"{name} is missing, and no line says why"
                )
                whole = False
            else:
                assert not missing, f"{name} is missing"
                WHOLE[name.suffix](folder / name, self.good / name)
        return whole


# ---- ways to limit the room


class Disk:
    unit = PAGE

    def __init__(self, writer):
        self.writer = writer
        self.folder = HERE / f"disk-{writer.name}"
        self.folder.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={PLENTY}", "tmpfs", self.folder], check=True)

    def size(self, size):
        subprocess.run(["mount", "-o", f"remount,size={size}", self.folder], check=True)

    def trial(self, room):
        self.size(PLENTY)
        for entry in self.folder.iterdir():
            shutil.rmtree(entry) if entry.is_dir() else entry.unlink()
        self.writer.lay_old(self.folder)
        room_there = os.statvfs(self.folder)
        # A tmpfs of size 0 has no limit.
        self.size(max(PAGE, (room_there.f_blocks - room_there.f_bfree) * room_there.f_bsize + room))
        return self.writer.run(self.folder)

    def end(self):
        subprocess.run(["umount", "-l", self.folder], check=True)


class Length:
    unit = 1024

    def __init__(self, writer):
        self.writer = writer
        self.folder = HERE / f"length-{writer.name}"

    def trial(self, room):
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir()
        self.writer.lay_old(self.folder)
        return self.writer.run(self.folder, limit=room)

    def end(self):
        pass


def search(way):
    """Tries rooms round the least that suffices, and some below; returns what went wrong."""
    writer = way.writer
    tried = {}

    def fits(units):
        if units not in tried:
            try:
                done = way.trial(units * way.unit)
                tried[units] = writer.check(way.folder, done)
            except subprocess.TimeoutExpired:
                raise AssertionError(f"room of {units * way.unit} bytes: it hangs") from None
            except AssertionError as e:
                raise AssertionError(f"room of {units * way.unit} bytes: {e}\n{done.stdout}{done.stderr}") from None
        return tried[units]

    try:
        low, high = 0, writer.bytes // way.unit + 16
        while not fits(high):
            low, high = high, 2 * high
            assert high * way.unit < PLENTY, "it never fits"
        for units in (0, high // 8, high // 2):
            fits(units)
        while high - low > max(1, high // 12):
            middle = (low + high) // 2
            low, high = (low, middle) if fits(middle) else (middle, high)
        print(
            f"{writer.name}, {type(way).__name__.lower()}: {len(tried)} rooms, {sum(not f for f in tried.values())} too small; "
            f"{high * way.unit} bytes suffice"
        )
        assert sum(not f for f in tried.values()) > 0, "no room was too small"
        return []
    except AssertionError as e:
        return [f"{writer.name}, {type(way).__name__.lower()}: {e}"]
    finally:
        way.end()


def model_cache():
    """An RTL model, whose build writes hundreds of files: the cause, and where the log is if there is one."""
    wrong = []
    folder = HERE / "disk-cache"
    folder.mkdir()
    ways = [("length", limit) for limit in (0, 2000, 100_000)]
    if DISKS:
        ways += [("disk", room) for room in (PAGE, 200_000, 700_000, 1_200_000)]
    for way, room in ways:
        if way == "disk":
            subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={room},mode=700", "tmpfs", folder], check=True)
        try:
            done = kage("model", "tiny", env={"XDG_CACHE_HOME": str(folder)}, limit=room if way == "length" else None)
            said = done.stderr
            assert done.returncode == 2 and said.count("\n") == 1 and any(c in said for c in NO_ROOM), (
                f"exit {done.returncode}"
            )
            if "(log: " in said:
                log = pathlib.Path(said.split("(log: ")[1].split(")")[0])
                assert log.stat().st_size > 0, "the log is empty"
            assert not list(folder.rglob(".kage-*")), "unfinished files are left"
            assert not list(folder.rglob("*.so")), "half a model is left"
        except (AssertionError, subprocess.TimeoutExpired) as e:
            wrong.append(f"model, {way}, room of {room} bytes: {e}: {said}")
        finally:
            if way == "disk":
                subprocess.run(["umount", "-l", folder], check=True)
            else:
                shutil.rmtree(folder)
                folder.mkdir()
    print(f"model: {len(ways)} rooms, all too small")
    return wrong


def inputs():
    """The inputs of the writers, made where there is room."""
    small = ("--size", "96x72")
    for command in (
        ("stream", "courtyard", *small, "--frames", 3, "--out", "c.kage"),
        ("render", "c.kage", "--out", "fresh"),
        ("render", "courtyard", "--size", "80x60", "--frames", 3, "--out", "stale"),
        ("render", "courtyard", "--size", "80x60", "--frames", 1, "--exr", "--out", "stale"),
    ):
        assert kage(*command).returncode == 0, command
    for shard in (1, 2):
        done = kage("cosim", "c.kage", "--shard", f"{shard}/2", "--json", f"{shard}.json", "--out", f"shard{shard}")
        assert done.returncode == 0, done.stderr
    (HERE / "stale/c_0000.png").write_bytes((HERE / "stale/courtyard_0001.png").read_bytes())
    (HERE / "stale/c_0001.png").write_bytes((HERE / "stale/courtyard_0002.png").read_bytes())
    mesh = "".join(f"v {x} {y} {(x * y) % 3}\n" for y in range(12) for x in range(12))
    mesh += "".join(f"f {12 * y + x + 1} {12 * y + x + 2} {12 * y + x + 13}\n" for y in range(11) for x in range(11))
    pathlib.Path("mesh.obj").write_text(mesh)
    pathlib.Path("old").write_text("of an earlier run\n")
    # Files that are compared with new ones have to be of their kind.
    Writer.old = {"": HERE / "old", ".png": HERE / "stale/courtyard_0000.png"}


def main():
    inputs()
    two = ("fresh/c_0000.png", "fresh/c_0001.png")
    report = ("--json", "OUT/r.json", "--junit", "OUT/r.xml")
    page = ("report.html",)
    writers = [
        Writer("png", "render", "c.kage", "--out", "OUT"),
        Writer("exr", "render", "c.kage", "--exr", "--out", "OUT"),
        Writer("stream", "stream", "c.kage", "--out", "OUT/s.kage"),
        Writer("diff", "diff", *two, "--out", "OUT/heat.png", "--flip", "OUT/flip.png", *report, codes=(1,)),
        Writer("views", "diff", "fresh", "stale", "--out", "OUT", codes=(1,)),
        Writer("bless", "diff", "--bless", "fresh", "OUT"),
        Writer(
            "order",
            "order",
            "mesh.obj",
            "--eyes",
            2,
            "--repeats",
            1,
            "--save",
            "OUT/o.bsp",
            "--plot",
            "OUT/o.svg",
            "--json",
            "OUT/o.json",
        ),
        Writer("cosim", "cosim", "c.kage", "--out", "OUT", *report, may_miss=page),
        Writer("merge", "merge", "1.json", "2.json", "--out", "OUT", *report),
        Writer(
            "waveform",
            "cosim",
            "courtyard",
            "--size",
            "64x48",
            "--frames",
            1,
            "--all-spans",
            "--fault",
            "wrong_compare",
            "--out",
            "OUT",
            codes=(1,),
            may_miss=(*page, ".fst", ".gtkw"),
        ),
    ]
    for writer in writers:
        writer.learn()
    wrong = []
    with concurrent.futures.ThreadPoolExecutor(max(2, os.cpu_count() or 1)) as pool:
        tasks = [pool.submit(model_cache)]
        for writer in writers:
            tasks += [pool.submit(search, way(writer)) for way in ((Disk, Length) if DISKS else (Length,))]
        for task in tasks:
            wrong += task.result()
    for text in wrong:
        print("FAILED:", text)
    sys.exit(bool(wrong))


main()
