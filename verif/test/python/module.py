#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""module.py KAGE SOURCE LIBRARY: the package python/kage against the program. The golden core's lines are the pack's
pixels, steps give every token and the state behind it, and wrong input is refused in a line. The commands and the
example of its README run."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

program, source, library = sys.argv[1:]
sys.path.insert(0, f"{source}/python")
os.environ |= {"KAGE": program, "KAGE_GOLDEN": library}
import kage  # noqa: E402


def fail(text):
    sys.exit(f"FAILED: {text}")


def same(what, got, wanted):
    if got != wanted:
        fail(f"{what}: {got}, expected {wanted}")


def refused(error, call, *words):
    try:
        call()
    except error as e:
        text = str(e)
        if "\n" in text or not all(w in text for w in words):
            fail(f"says '{text}', expected {words}")
        return
    fail(f"not refused: {words}")


def pack_by_golden(folder, scene, config, size):
    """Every frame of a pack, sound and malformed: the golden core by Python gives its very pixels and errors."""
    options = [*(["--size", size, "--degrade"] if size else []), "--frames", "2", "--config", config, "--no-rtl"]
    pack = kage.write_pack(scene, folder / f"{config}-{scene}", options)
    core = kage.Golden(pack.config)
    frames = pack.frames()
    for i, f in enumerate(frames):
        drawn = core.frame(f.words)
        same(f"{config} frame {i}: lines", drawn.lines, f.lines)
        same(f"{config} frame {i}: whether it is sound", bool(drawn.status), f.error == "NONE")
        if not drawn.status and not drawn.status.text.startswith(f"{f.error}:"):
            fail(f"{config} frame {i}: {drawn.status}, expected {f.error}")
    return core, frames


def states(core, words):
    """Word by word: the same frame, and the state that pixels have right ahead of a line's end is what the line shows."""
    whole = core.frame(words)
    shown = {}
    clear = (1 << core.config.Z_BITS) - 1
    before, checked, kinds = [], 0, []
    for step in core.steps(words):
        kinds.append(step.kind)
        if step.kind == "EOL":
            shown[step.line - 1] = before
        width = whole.width
        before = [core.pixel(x) for x in range(width)] if step.kind != "END" else []
    same("the frame by steps", core.finished, whole)
    same("the first and the last step", (kinds[0], kinds[-1]), ("HEADER", "END"))
    for y, pixels in shown.items():
        for x, p in enumerate(pixels):
            if p.z not in (None, clear):
                at = x * core.config.CHANNELS
                same(f"line {y}, x {x}", bytes(p.color), whole.lines[y][at : at + core.config.CHANNELS])
                checked += 1
    return checked


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    tiny, frames = pack_by_golden(folder, "courtyard", "tiny", "24x16")
    if (checked := states(tiny, frames[0].words)) < 100:
        fail(f"only {checked} pixels of tiny were looked at")
    pack_by_golden(folder, "courtyard", "default", "24x16")
    pack_by_golden(folder, "three-lights", "lights", "24x16")
    pack_by_golden(folder, "polyhedra", "polyhedra", "24x16")
    pack_by_golden(folder, "random:mixed", "glasslights", None)

    # A stream file's frames, and a configuration by mapping.
    stream = folder / "courtyard.kage"
    subprocess.run([program, "stream", "courtyard", "--size", "24x16", "--frames", "2", "--config", "default", "--out", stream], check=True, capture_output=True)  # fmt: skip
    core = kage.Golden(stream)
    drawn = [core.frame(words) for words in kage.frames(stream)]
    same("frames of the file", len(drawn), 2)
    same("by a mapping", kage.Golden({"LANES": 8, "MAX_WIDTH": 1280}).config, core.config)
    same("by a Config", kage.Golden(core.config).frame(next(kage.frames(stream))), drawn[0])
    if kage.Golden("tiny").frame(next(kage.frames(stream))).status:
        fail("a frame of another configuration is sound")

    # Malformed frames by steps are the frame at once; steps that nobody asks for leave nothing to the next frame.
    for f in pack_by_golden(folder, "random:mixed", "tiny", None)[1] + frames:
        whole = tiny.frame(f.words)
        for _ in tiny.steps(f.words):
            pass
        same(f"{f.what} by steps", tiny.finished, whole)
        next(tiny.steps(f.words), None)
        same(f"{f.what} behind a step", tiny.frame(f.words), whole)

    # Wrong input.
    refused(kage.GoldenError, lambda: kage.Golden("nowhere"), "nowhere", "no configuration")
    refused(kage.GoldenError, lambda: kage.Golden({"Z_BITS": 99}), "Z_BITS")
    refused(kage.PackError, lambda: kage.Pack(folder / "none"), "manifest.json")
    refused(kage.PackError, lambda: kage.write_pack("nowhere", folder / "x"), "nowhere")
    pixels = folder / "tiny-courtyard/../default-courtyard/pixels.bin"
    data = bytearray(pixels.read_bytes())
    data[3] ^= 1
    pixels.write_bytes(data)
    refused(kage.PackError, lambda: kage.Pack(folder / "default-courtyard").frames(), "pixels.bin", "manifest")
    manifest = folder / "tiny-courtyard/manifest.json"
    whole = manifest.read_text()
    manifest.write_text(whole.replace('"Z_BITS"', '"Y_BITS"'))
    refused(kage.PackError, lambda: kage.Pack(manifest.parent), "manifest.json", "configuration")
    manifest.write_text(whole.replace('"height"', '"hight"'))
    refused(kage.PackError, lambda: kage.Pack(manifest.parent).frames(), "manifest.json", "height")
    manifest.write_text("{}")
    refused(kage.PackError, lambda: kage.Pack(folder / "tiny-courtyard"), "kage.pack/1")
    try:
        core.pixel(10**6)
        fail("pixel 10^6 is there")
    except IndexError:
        pass
    missing = subprocess.run([sys.executable, "-c", "import kage; kage.Golden('tiny')"], env=os.environ | {"PYTHONPATH": f"{source}/python", "KAGE_GOLDEN": "/nowhere.so"}, capture_output=True, text=True)  # fmt: skip
    if "libkage_golden.so: not found" not in missing.stderr:
        fail(f"a missing library: {missing.stderr}")
    # As a user installs it. No index is asked: setuptools is the system's.
    into = folder / "installed"
    shutil.copytree(f"{source}/python", folder / "python")
    done = subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-deps", "--no-index", "--target", into, folder / "python"], env=os.environ | {"KAGE_BUILD": str(pathlib.Path(library).parents[1])}, capture_output=True, text=True)  # fmt: skip
    if done.returncode != 0:
        fail(f"pip install: {done.stderr[-500:]}")
    del os.environ["KAGE_GOLDEN"]
    # Installed before anything is built: the library is named where it is missing, and found once it is there. Into a venv, as
    # the README says, for Debian's own Python refuses packages.
    later, venv = folder / "later", folder / "venv"
    subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", venv], check=True)
    early = [
        venv / "bin/pip",
        "install",
        "--quiet",
        "--no-build-isolation",
        "--no-deps",
        "--no-index",
        folder / "python",
    ]
    done = subprocess.run(early, env=os.environ | {"KAGE_BUILD": str(later)}, capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"pip install into a venv: {done.stderr[-500:]}")
    ask = [venv / "bin/python", "-c", "import kage; print(kage.Golden('tiny').config.Z_BITS)"]
    missing = subprocess.run(ask, cwd=folder, capture_output=True, text=True)
    if f"libkage_golden.so: not found as {later}/lib/libkage_golden.so: build kage" not in missing.stderr:
        fail(f"a library that is not built yet: {missing.stderr}")
    (later / "lib").mkdir(parents=True)
    shutil.copy(library, later / "lib/libkage_golden.so")
    found = subprocess.run(ask, cwd=folder, env=os.environ | {"KAGE_DATA_DIR": source}, capture_output=True, text=True)
    same("a library that is built later", (found.returncode, found.stderr), (0, ""))
    told = subprocess.run([sys.executable, "-c", "import kage; print(kage.__file__, kage.Golden({'Z_BITS': 16}).config.Z_BITS)"], env=os.environ | {"PYTHONPATH": str(into)}, cwd=folder, capture_output=True, text=True)  # fmt: skip
    same("the installed package", told.stdout.split(), [str(into / "kage/__init__.py"), "16"])

    # The README as it stands, with the installed package: tools/demo builds all that it needs, and its example runs.
    readme = pathlib.Path(f"{source}/python/README.md").read_text()
    commands, example = (re.search(f"```{language}\n(.*?)```", readme, re.S)[1] for language in ("sh", "python"))
    same("the README's first command", commands.split()[0], "tools/demo")
    for page in ("python/README.md", "examples/cocotb/README.md"):
        lines = pathlib.Path(f"{source}/{page}").read_text().splitlines()
        first = {
            word: next((i for i, text in enumerate(lines) if text.startswith(word)), -1)
            for word in ("python3 -m venv", "pip install")
        }
        if not 0 <= first["python3 -m venv"] < first["pip install"]:
            fail(f"{page}: Debian's Python refuses `pip install` without a venv before it")
    built = pathlib.Path(library).resolve().parents[1]
    if (built / "build.ninja").exists():
        targets = re.search("--target (.*)", pathlib.Path(f"{source}/tools/demo").read_text())[1].split()
        making = subprocess.run(
            ["ninja", "-C", built, "-t", "commands", *targets], capture_output=True, text=True, check=True
        )
        if f"lib/{pathlib.Path(library).resolve().name}" not in making.stdout:
            fail(f"tools/demo builds {targets}, without libkage_golden")
    del os.environ["KAGE"]
    plain = os.environ | {"PYTHONPATH": str(into), "PATH": "/usr/bin:/bin"}
    with_kage = plain | {"PATH": f"{pathlib.Path(program).parent}:/usr/bin:/bin"}
    (folder / "readme").mkdir()
    line = next(c for c in commands.splitlines() if c.startswith("kage stream"))
    subprocess.run(line, shell=True, cwd=folder / "readme", env=with_kage, check=True, capture_output=True)
    done = subprocess.run(
        [sys.executable, "-c", example], cwd=folder / "readme", env=with_kage, capture_output=True, text=True
    )
    same("the README's example", (done.returncode, done.stderr), (0, ""))
    if "END" in done.stdout or "NONE" not in done.stdout or "Pixel(" not in done.stdout:
        fail(f"the README's example prints {done.stdout[-500:]}")
    missing = subprocess.run([sys.executable, "-c", "import kage; kage.write_pack('courtyard', 'none')"], cwd=folder, env=plain, capture_output=True, text=True)  # fmt: skip
    if "put build/release/bin into PATH, or name the program in $KAGE" not in missing.stderr:
        fail(f"a missing program: {missing.stderr}")
print("passed")
