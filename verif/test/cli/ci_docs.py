# SPDX-License-Identifier: Apache-2.0
# Runs the CI examples of docs/ci.md as GitHub and GitLab would: jobs in their order, each in a folder of its own, with artifacts
# handed on. Stubs stand for what belongs to the CI system: containers, apt-get, checkout, caches; and for the build.
# usage: ci_docs.py KAGE SOURCE github|gitlab sound|broken
import fnmatch
import json
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import yaml

kage, source, system, rtl = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3], sys.argv[4]
root = Path(f"{system}-{rtl}").resolve()
real_cmake = shutil.which("cmake")
cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "kage"
fewer = {
    "--frames 64": "--frames 4 --size 64x48 --config default",
    "--minutes 5": "--rounds 1 --config default",
}
kept = root / "kept"  # stands for the examples' /var/cache/ci


def example(name):
    blocks = [
        b
        for b in re.findall(r"^```yaml\n(.*?)^```$", (source / "docs/ci.md").read_text(), flags=re.S | re.M)
        if name in b.splitlines()[0]
    ]
    assert len(blocks) == 1 and "/var/cache/ci" in blocks[0], name
    text = blocks[0].replace("/var/cache/ci", str(kept))
    for much, few in fewer.items():
        assert text.count(much) == 1, (name, much)
        text = text.replace(much, few)
    return yaml.safe_load(text)


def stubs():
    (root / "bin").mkdir(parents=True)
    defect = (
        f"/usr/bin/python3 -B {source}/verif/cosim/model/driver/defects.py {source}/verif/cosim/model/faults.yaml put wrong_compare kage/share/kage"
        if rtl == "broken"
        else ":"
    )
    build = kage.parent.parent
    for name, text in {
        "apt-get": "exit 0",
        "cmake": f'if [ "$1" = --install ]; then {real_cmake} --install {build} --prefix "$4" >/dev/null; {defect}; fi',
    }.items():
        file = root / "bin" / name
        file.write_text(f"#!/bin/sh\nset -e\n{text}\n")
        file.chmod(0o755)


def restore(place):
    """Restores as a runner does: models of the common cache, and verdicts of this test."""
    (place / "kage").mkdir(mode=0o700, parents=True)
    for name, of in {"models": cache, "verilator": cache, "verdicts": Path("cache").resolve()}.items():
        (of / name).mkdir(mode=0o700, parents=True, exist_ok=True)
        (place / "kage" / name).symlink_to(of / name)


def checkout(folder):
    """A clean one, as runners have it: on GitHub it is another user's than the job's, on GitLab everybody may write to it."""
    (folder / "tools").mkdir(parents=True)
    folder.chmod(0o777)
    if os.geteuid() == 0 and system == "github":
        os.chown(folder, 1001, 1001)
    (folder / "tools/deps").write_text('#!/bin/sh\n[ "$*" = demo ]\n')
    (folder / "tools/deps").chmod(0o755)


def shell(script, folder, env, log):
    base = {k: v for k, v in os.environ.items() if not k.startswith(("KAGE_", "GITHUB_", "CI_", "XDG_"))}
    done = subprocess.run(
        ["sh", "-e", "-c", script],
        cwd=folder,
        env={**base, "PATH": f"{root}/bin:{base['PATH']}", **env},
        capture_output=True,
        text=True,
    )
    log.write(f"$ {script}\n{done.stdout}{done.stderr}exit {done.returncode}\n")
    log.flush()
    return done.returncode, done.stdout


def copy(patterns, start, to):
    for path in sorted(p for p in start.iterdir() if any(fnmatch.fnmatch(p.name, q.rstrip("/")) for q in patterns)):
        (
            shutil.copytree(path, to / path.name, symlinks=True, dirs_exist_ok=True)
            if path.is_dir()
            else shutil.copy2(path, to / path.name)
        )


def ordered(jobs, needs):
    done = []
    while len(done) < len(jobs):
        ready = [n for n in jobs if n not in done and all(d in done for d in needs(jobs[n]))]
        assert ready, "jobs wait for each other"
        done += ready
    return done


def github(log):
    doc = example(".github/workflows/")
    assert set(doc) == {"name", True, "jobs"}  # YAML 1.1 reads "on" as true
    artifacts, codes, annotated = root / "artifacts", {}, 0

    def needs(job):
        return [job["needs"]] if isinstance(job.get("needs"), str) else job.get("needs", [])

    for name in ordered(doc["jobs"], needs):
        job = doc["jobs"][name]
        assert job["container"] == "debian:bookworm" and job["runs-on"]
        for shard in job.get("strategy", {}).get("matrix", {}).get("shard", [None]):
            folder, env = (
                root / f"{name}-{shard}",
                {"GITHUB_ACTIONS": "true", "GITHUB_ENV": str(root / f"{name}-{shard}.env")},
            )
            folder.mkdir()
            Path(env["GITHUB_ENV"]).touch()
            code = 0
            shutil.rmtree(kept, ignore_errors=True)  # each job has a container of its own

            def expand(t):
                return re.sub(
                    r"\$\{\{ ([a-z.]+) \}\}",
                    lambda m: {"matrix.shard": str(shard), "github.sha": "0123abc"}[m[1]],
                    str(t),
                )

            for step in job["steps"]:
                if code != 0 and step.get("if") != "success() || failure()":
                    continue
                given = {k: expand(v) for k, v in step.get("with", {}).items()}
                action = step.get("uses", "").split("@")[0]
                if action == "actions/checkout":
                    checkout(folder)
                elif action == "actions/cache":
                    assert {"path", "key"} <= set(given)
                    if Path(given["path"]) == kept / "kage":
                        restore(kept)
                    else:
                        assert given["path"] == ".cache/ccache"
                elif action == "actions/upload-artifact":
                    to = artifacts / given["name"]
                    to.mkdir(parents=True)
                    copy(given["path"].split(), folder, to)
                    assert any(to.iterdir()), f"{name}: nothing to upload"
                elif action == "actions/download-artifact":
                    for a in artifacts.iterdir():  # one goes where we are, all go to folders of their names
                        if given.get("name", a.name) == a.name:
                            copy(
                                ["*"],
                                a,
                                folder
                                if "name" in given
                                else Path(shutil.os.makedirs(folder / a.name) or folder / a.name),
                            )
                else:
                    assert set(step) == {"run"}, step
                    code, out = shell(expand(step["run"]), folder, env, log)
                    annotated += len(
                        re.findall(r"^::error file=rtl/pixel_banked\.sv,title=[^\n:]*::[^\n]+$", out, flags=re.M)
                    )
                    env.update(line.split("=", 1) for line in Path(env["GITHUB_ENV"]).read_text().splitlines())
            codes.setdefault(name, []).append(code)
    return codes, artifacts / "cosim", annotated


def gitlab(log):
    doc = example(".gitlab-ci.yml")
    assert doc["image"] == "debian:bookworm"
    jobs = {n: j for n, j in doc.items() if n not in ("image", "stages", "variables", "default")}
    artifacts, codes = root / "artifacts", {}
    artifacts.mkdir()
    for name in sorted(jobs, key=lambda n: doc["stages"].index(jobs[n]["stage"])):
        job = jobs[name]
        assert job.get("when", "on_success") in ("on_success", "always")
        # The jobs of a stage do not wait for each other.
        earlier = [of for n, of in codes.items() if jobs[n]["stage"] != job["stage"]]
        if job.get("when") != "always" and any(c for of in earlier for c in of):
            continue
        before = sorted(artifacts.iterdir())
        made = root / f"{name}-artifacts"
        made.mkdir()
        count = job.get("parallel", 1)
        for i in range(1, count + 1):
            folder = root / f"{name}-{i}"
            checkout(folder)
            shutil.rmtree(kept, ignore_errors=True)
            if job.get("cache", {}).get("paths") == [".cache/kage"]:
                restore(folder / ".cache")
            copy([p.name for p in before], artifacts, folder)
            env = {"CI": "true", "CI_PROJECT_DIR": str(folder), "CI_NODE_INDEX": str(i), "CI_NODE_TOTAL": str(count)}
            env.update({k: v.replace("$CI_PROJECT_DIR", str(folder)) for k, v in doc["variables"].items()})
            code, _ = shell("\n".join(doc["default"]["before_script"] + job["script"]), folder, env, log)
            codes.setdefault(name, []).append(code)
            after, _ = shell("\n".join(doc["default"]["after_script"]), folder, env, log)
            assert after == 0, f"{name}: after_script"
            assert code == 0 or job["artifacts"]["when"] == "always"
            copy(job["artifacts"]["paths"], folder, made)
        copy(["*"], made, artifacts)
    assert doc["merge"]["artifacts"]["reports"]["junit"] == "cosim.xml"
    return codes, artifacts, None


stubs()
with open(root / "log", "w") as log:
    codes, results, annotated = {"github": github, "gitlab": gitlab}[system](log)

report, suite = json.loads((results / "cosim.json").read_text()), xml.parse(results / "cosim.xml").getroot()[0]
verdict = 1 if rtl == "broken" else 0
failures = sum(s["first_difference"] is not None for scene in report["scenes"] for s in scene["shards"])
assert failures >= 4 * verdict and (verdict or not failures)
assert annotated in (None, failures + verdict), annotated  # the regression's one
assert codes == {"build": [0], "cosim": [verdict] * 4, "regress": [verdict], "merge": [verdict]}, codes
assert (
    report["same"] is (verdict == 0)
    and report["frames"] == 8
    and [len(s["shards"]) for s in report["scenes"]] == [4, 4]
)
assert (suite.get("tests"), suite.get("failures")) == ("8", str(failures))
# Sound RTL has been run once; broken RTL has no verdicts, and those of the sound one do not hide it.
again = system == "gitlab" and rtl == "sound" and any(Path("github-sound").glob("cosim-*"))
assert report["verdicts"] == {
    "cached": True,
    "taken": 8 if again else 0,
    "kept": report["verdicts"]["kept"],
    "trouble": None,
}, report["verdicts"]
# The regression's reports are kept whatever it says.
regression = results.parent / "regress" if system == "github" else results
told = json.loads((regression / "regress.json").read_text())
assert told["same"] is (verdict == 0) and (regression / "regress.xml").is_file(), told
assert (regression / "regress/report.html").is_file()
# The kept results have the pages that the joined one links to.
text = (results / "joined/report.html").read_text()
links = [
    r["page"] for p in json.loads(re.search(r'id="data">(.*?)</script>', text, re.S)[1])["parts"] for r in p["runs"]
]
assert len(links) == 8 and all((results / "joined" / link).is_file() for link in links), links
