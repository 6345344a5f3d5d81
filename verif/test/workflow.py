#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The project's workflow for GitHub, which nobody runs here, runs what .ci/run runs: each stage in some job, by tools that
are there. usage: workflow.py SOURCE
"""

import os
import pathlib
import re
import sys

import yaml


def faults(source):
    path = source / ".github/workflows/ci.yml"
    text = path.read_text()
    if not text.startswith("# Not run here"):
        yield "its first line does not say that it is not run here"
    workflow = yaml.safe_load(text)
    commands = []
    for name, job in workflow["jobs"].items():
        for key in ("runs-on", "container", "timeout-minutes", "steps"):
            if key not in job:
                yield f"job {name} has no {key}"
        for step in job["steps"]:
            if ("run" in step) == ("uses" in step):
                yield f"job {name}: a step that neither runs nor uses one thing: {step}"
            commands.append(step.get("run", ""))
    ran = [" ".join(command.split("#")[0].split()) for command in commands]
    for command in ran:
        for tool in re.findall(r"\btools/[a-z-]+", command):
            if not os.access(source / tool, os.X_OK):
                yield f"{tool} is not there"
    stages = re.findall(r"\bstage (tools/[^\n;]+)", (source / ".ci/run").read_text())
    yield from (f".ci/run has the stage '{s}', and no job has" for s in stages if " ".join(s.split()) not in ran)
    if len(stages) < 8:
        yield f".ci/run has {len(stages)} stages only: they are not found as they stand there"


def main(source):
    bad = list(faults(source))
    print("\n".join(f".github/workflows/ci.yml: {fault}" for fault in bad) or "the workflow runs all stages of .ci/run")
    return 1 if bad else 0


sys.exit(main(pathlib.Path(sys.argv[1])))
