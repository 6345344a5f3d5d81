#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs that are killed, or end by a signal, at random moments.

usage: killed.py KAGE SOURCE [SEED]      run in an empty folder

SIGKILL leaves old or new files, whole, and one hidden folder at most, which git does not add and the next run in that folder
removes; no child goes on. A first SIGINT, SIGTERM or SIGHUP ends a run tidily with 128 and its number, a second one at once.
"""

import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

KAGE, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else 1
HERE = pathlib.Path.cwd()
MARK = f"KAGE_TEST_MARK=killed-{os.getpid()}"  # in the environment of all that a run starts
ENOUGH = 3  # runs that are killed in time, to say anything
wrong = []


def fail(text):
    wrong.append(text)
    print("FAILED:", text)


def start(*arguments, **environment):
    name, value = MARK.split("=")
    return subprocess.Popen(
        [KAGE, *map(str, arguments)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env={**os.environ, "KAGE_PROGRESS": "0", name: value, **environment},
    )


def run(*arguments, **environment):
    run_ = start(*arguments, **environment)
    said = run_.communicate(timeout=300)[1].decode()
    if run_.returncode != 0:
        fail(f"{arguments}: exit {run_.returncode}: {said}")


def marked():
    """The processes that a run has started, but for zombies."""
    found = []
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if MARK.encode() in (folder / "environ").read_bytes().split(b"\0"):
                found.append((folder / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace"))
        except OSError:
            pass
    return found


def none_goes_on(what):
    deadline = time.monotonic() + 5
    while marked():
        if time.monotonic() > deadline:
            fail(f"{what}: goes on: {marked()}")
            return
        time.sleep(0.05)


def files(folder):
    return {
        str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file() and ".kage-" not in str(p)
    }


def hidden(folder):
    return [p for p in folder.rglob(".kage-*") if p.is_dir()]


def git(folder, *arguments):
    return subprocess.run(
        ["git", "-C", folder, "-c", "user.name=a", "-c", "user.email=a@b", *arguments],
        check=True,
        capture_output=True,
        text=True,
    ).stdout


def killed(what, times, arguments, out, allowed, prepare=lambda: None):
    """Kills a run at random moments, which writes into `out`, and before which there is something to `prepare`. Each file there
    has one of the `allowed` contents of its name. At least so many times, and until ENOUGH runs have been killed in time."""
    prepare()
    run_ = start(*arguments)
    begin = time.monotonic()
    run_.communicate(timeout=300)
    whole = time.monotonic() - begin
    early = left = i = 0
    while i < times or (early < ENOUGH and i < 10 * times):
        prepare()
        run_ = start(*arguments)
        if i % 2:  # once it writes
            while not hidden(out) and run_.poll() is None:
                time.sleep(0.002)
            time.sleep(random.uniform(0, min(whole / 4, 0.05)))
        else:
            time.sleep(random.uniform(0, whole))
        i += 1
        run_.kill()
        run_.communicate()
        early += run_.returncode == -signal.SIGKILL
        none_goes_on(what)
        left += bool(hidden(out)) if out.exists() else 0
        if out.exists():
            if len(hidden(out)) > 1:
                fail(f"{what}: more than one hidden folder: {hidden(out)}")
            for name, content in files(out).items():
                if content not in allowed(name):
                    fail(f"{what}: {name} is neither as it was nor as it is to be, or is no file of the run")
            if shutil.which("git"):
                shutil.rmtree(out / ".git", ignore_errors=True)
                git(out, "init", "-q")
                git(out, "add", "-A")
                if ".kage-" in git(out, "ls-files"):
                    fail(f"{what}: git adds what was left: {git(out, 'ls-files')}")
                shutil.rmtree(out / ".git")
    run(*arguments)
    if hidden(out):
        fail(f"{what}: the next run does not remove {hidden(out)}")
    print(f"{what}: {early} of {i} killed in time, {left} left a hidden folder")
    return early, left


def any_content(contents):
    return lambda name: [c[name] for c in contents if name in c]


def renders():
    run("render", "courtyard", "--size", "640x480", "--frames", 8, "--out", "good")
    out = HERE / "pictures"
    shutil.copytree("good", out)
    (out / "courtyard_0000.png").write_bytes(b"of an earlier run")
    old = files(out)
    return killed(
        "render",
        12,
        ("render", "courtyard", "--size", "640x480", "--frames", 8, "--out", out),
        out,
        any_content([old, files(HERE / "good")]),
    )


def cosims():
    run("stream", "courtyard", "--size", "64x48", "--frames", 4, "--out", "c.kage")
    run("cosim", "c.kage", "--out", "verdict")
    out = HERE / "verdicts"
    pictures = {name: content for name, content in files(HERE / "verdict").items() if name.endswith(".png")}

    def allowed(name):
        if name in pictures:
            return [pictures[name]]
        page = out / name  # its times differ: it has to be whole
        return [page.read_bytes()] if name == "report.html" and page.read_text().rstrip().endswith("</html>") else []

    return killed("cosim", 12, ("cosim", "c.kage", "--out", out), out, allowed)


def blessings():
    run("render", "courtyard", "--size", "64x48", "--frames", 200, "--out", "fresh")
    run("render", "courtyard", "--size", "32x24", "--frames", 200, "--out", "stale")
    out = HERE / "reference"
    stale, fresh = files(HERE / "stale"), files(HERE / "fresh")

    def anew():
        """All of it is to be blessed again; what a killed run has left stays."""
        out.mkdir(exist_ok=True)
        for name, content in stale.items():
            (out / name).write_bytes(content)

    return killed("bless", 12, ("diff", "--bless", "fresh", out), out, any_content([stale, fresh]), anew)


def builds():
    """A model's build, which runs build.py, Verilator, make and compilers."""
    cache = HERE / "cache"
    early = left = 0
    for seconds in (0.3, 0.8, 1.5, 2.5, 4):
        run_ = start("model", "tiny", XDG_CACHE_HOME=str(cache))
        time.sleep(seconds * random.uniform(0.8, 1.2))
        run_.kill()
        run_.communicate()
        early += run_.returncode == -signal.SIGKILL
        none_goes_on("model")
        left += bool(hidden(cache)) if cache.exists() else 0
        if len(hidden(cache)) > 1:
            fail(f"model: more than one hidden folder: {hidden(cache)}")
    run("model", "tiny", XDG_CACHE_HOME=str(cache))
    strays = [
        p
        for p in cache.rglob("*")
        if p.is_file() and (p.suffix not in (".so", ".json", ".lock", ".o") or p.name.startswith("."))
    ]
    if hidden(cache) or strays:
        fail(f"model: the next run leaves {hidden(cache)} {strays}")
    print(f"model: {early} of 5 killed in time, {left} left a hidden folder")
    return early, left


def foreign():
    """A person's folder of such a name stays."""
    mine = HERE / "own" / ".kage-2024"
    (mine / "notes").mkdir(parents=True)
    (mine / ".gitignore").write_text("*.o\n")
    (mine / "notes/a.txt").write_text("mine")
    run("render", "courtyard", "--size", "32x24", "--frames", 1, "--out", mine.parent)
    if not (mine / "notes/a.txt").exists():
        fail("a folder that kage has not made is gone")


def imports():
    """A mesh's import, which is a child of its own."""
    lines = [f"v {i % 300} {i // 300} {i % 7}" for i in range(90000)]
    lines += [f"f {i + 1} {i + 2} {i + 301}" for i in range(89000)]
    pathlib.Path("large.obj").write_text("\n".join(lines) + "\n")
    for seconds in (0.2, 0.4, 0.6, 0.8):
        run_ = start("render", "large.obj", "--frames", 1, "--out", "none")
        time.sleep(seconds)
        run_.kill()
        run_.communicate()
        none_goes_on("import")


def signals():
    """One signal: tidily, with its code. Two: at once, whatever the program waits for."""
    pipe = HERE / "pipe"  # which nobody reads
    os.mkfifo(pipe)
    run("stream", "courtyard", "--size", "32x24", "--frames", 1, "--out", "s.kage")
    wide = 1000  # an import of some ten seconds
    with open("larger.obj", "w") as f:
        f.writelines(f"v {i % wide} {i // wide} {i % 7}\n" for i in range(wide * wide))
        f.writelines(f"f {i + 1} {i + 2} {i + wide + 1}\n" for i in range(wide * (wide - 1) - 1))
    waits = {
        "render": ("render", "courtyard", "--size", "1280x960", "--frames", 500, "--out", "many"),
        "pipe": ("info", "s.kage", "--json", pipe),
        "import": ("info", "larger.obj"),
        "build": ("model", "default"),
    }
    for what, arguments in waits.items():
        for number, times in ((signal.SIGINT, 1), (signal.SIGTERM, 1), (signal.SIGHUP, 1), (signal.SIGTERM, 2)):
            run_ = start(*arguments, XDG_CACHE_HOME=str(HERE / "cache2"))
            time.sleep(1.5)
            begin = time.monotonic()
            for _ in range(times):
                run_.send_signal(number)
                time.sleep(0.02)  # two that come together are one
            try:
                run_.communicate(timeout=20)
            except subprocess.TimeoutExpired:
                run_.kill()
                run_.communicate()
            seconds = time.monotonic() - begin
            if run_.returncode != 128 + number:
                fail(f"{what}: {times} x {number.name}: exit {run_.returncode}, expected {128 + number}")
            if times == 2 and seconds > 2:
                fail(f"{what}: a second {number.name} took {seconds:.1f} s")
            none_goes_on(what)
            left = hidden(HERE / "cache2") + list(HERE.glob("many"))
            if times == 1 and left:
                fail(f"{what}: {number.name} leaves {left}")
            for folder in left:
                shutil.rmtree(folder)
    print("signals: done")


random.seed(SEED)
counts = [step() for step in (renders, cosims, blessings, builds)]
foreign()
imports()
signals()
if any(early < ENOUGH for early, _ in counts) or sum(left for _, left in counts) < 5:
    fail("too few runs were killed in time to say anything")
sys.exit(bool(wrong))
