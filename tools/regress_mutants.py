# SPDX-License-Identifier: Apache-2.0
"""See tools/regress-mutants."""

import argparse
import concurrent.futures
import itertools
import json
import math
import os
import pathlib
import random
import shlex
import subprocess
import sys
import tempfile
import time

import kept_rows
import yaml

SCHEMA = "kage.regress-mutants/1"  # of a row: docs/schema


def run(kage, number, options, out):
    """The report of kage regress on a mutant."""
    command = [kage, "regress", "--mutant", str(number), "--no-divergence", "--json", "-", "--out", out]
    command += ["--minutes", str(options.minutes), "--seed", str(options.seed)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}: {done.stderr.strip()}")
    report = json.loads(done.stdout)
    first = report["first_difference"]
    return {
        "found": not report["same"],
        "seconds": report["seconds"],
        "run": first["scene"] if first else None,
        "text": first["text"] if first else None,
    }


def plot(rows, minutes, path):
    """The share that is found against seconds, logarithmic."""
    width, height, left, right, top, bottom = 640, 360, 72, 16, 16, 44
    least, most = 0.1, 60 * minutes

    def x(s):
        return left + (width - left - right) * math.log(max(s, least) / least) / math.log(most / least)

    def y(share):
        return height - bottom - (height - top - bottom) * share

    found = sorted(r["seconds"] for r in rows if r["found"])
    points = [(least, 0.0)]
    for i, seconds in enumerate(found):
        points += [(seconds, i / len(rows)), (seconds, (i + 1) / len(rows))]
    points.append((most, len(found) / len(rows)))
    line = " ".join(f"{x(s):.1f},{y(share):.1f}" for s, share in points)
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="13">',
        f'<rect width="{width}" height="{height}" fill="#fff"/>',
    ]
    for share in (0, 0.25, 0.5, 0.75, 1):
        out.append(f'<line x1="{left}" x2="{width - right}" y1="{y(share):.1f}" y2="{y(share):.1f}" stroke="#ddd"/>')
        out.append(f'<text x="{left - 6}" y="{y(share) + 4:.1f}" text-anchor="end">{share:.0%}</text>')
    for seconds in (0.1, 1, 10, 60, 300):
        if seconds <= most:
            out.append(
                f'<line x1="{x(seconds):.1f}" x2="{x(seconds):.1f}" y1="{top}" y2="{height - bottom}" stroke="#eee"/>'
            )
            anchor = "end" if seconds == most else "middle"
            out.append(
                f'<text x="{x(seconds):.1f}" y="{height - bottom + 18}" text-anchor="{anchor}">{seconds:g} s</text>'
            )
    out.append(f'<polyline points="{line}" fill="none" stroke="#1f6feb" stroke-width="2"/>')
    out.append(
        f'<text x="{(left + width - right) / 2}" y="{height - 6}" text-anchor="middle">time of kage regress</text>'
    )
    out.append(
        f'<text transform="translate(14 {(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">mutants found</text>'
    )
    out.append("</svg>")
    pathlib.Path(path).write_text("\n".join(out) + "\n")


def what_is_tried(options):
    """A hash of the RTL, the mutants and the program: rows of others are not of the same table."""
    files = [pathlib.Path(options.kage)]
    for folder in ("rtl", "verif/mutants", "verif/cosim/model/driver"):
        files += sorted(f for f in (options.source / folder).rglob("*") if f.is_file() and "__pycache__" not in f.parts)
    return kept_rows.hash_of(files)


KINDS = ("random", "mixed", "damaged", "scene")  # in the order of a round of kage regress


def kind(name):
    """The kind of a run, by its name: "damaged" for "damaged.glass.0"."""
    return name.split(".")[0] if name.split(".")[0] in KINDS else "scene"


def cosim(kage, line, *more):
    """The report of a run, and its seconds, the program's start among them. Runs beside each other have folders of their own."""
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as out:
        command = [kage, *shlex.split(line)[1:], "--no-report", "--json", "-", "--out", out, *more]
        done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"{line}: exit code {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stdout), time.monotonic() - start


def expected_module(mutant, config):
    """The module that is to be named (verif/mutants/list.hpp)."""
    module = mutant.get("seen_by", pathlib.Path(mutant["file"]).stem)
    return ("pixel_banked" if config["ARRANGEMENT"] else "pixel_systolic") if module == "pixels" else module


def try_each(kage, number, mutant, options):
    """Every run of the first round on its own; of each kind the first that finds the mutant says which module it names."""
    command = [kage, "regress", "--list", "--mutant", str(number), "--seed", str(options.seed)]
    listed = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    runs = []
    for name, _, line in (text.partition(": ") for text in listed):
        report, seconds = cosim(kage, line, "--no-divergence", "--jobs", "1", "--threads", "1", "--no-shrink")
        run = {"run": name, "kind": kind(name), "found": not report["same"], "seconds": seconds}
        if run["found"] and not any(r["found"] and r["kind"] == run["kind"] for r in runs):
            report, _ = cosim(kage, line, "--jobs", "1", "--no-shrink")
            divergence = (report.get("first_difference") or {}).get("divergence") or {}
            run["named"] = divergence.get("module", "")
            run["right"] = run["named"] == expected_module(mutant, report["config"])
        runs.append(run)
    return {"schema": "kage.regress-mutants-each/1", "name": mutant["name"], "runs": runs}


def seconds_to_find(row, order):
    """When the runs of a row, kind after kind, find the mutant; with all of them over if they do not."""
    total = 0.0
    for k in order:
        for r in row["runs"]:
            if r["kind"] == k:
                total += r["seconds"]
                if r["found"]:
                    return total
    return total


def tell_each(rows):
    configs = len({r["run"].split(".")[1] for r in rows[0]["runs"]})
    print(f"\n{len(rows)} mutants, each kind of the first round, {configs} configurations\n")
    print("| runs | found | named right, of those found | seconds, median |\n|---|---|---|---|")
    for kinds in [(k,) for k in ("scene", *KINDS[:3])] + [KINDS]:
        found = [row for row in rows if any(r["found"] for r in row["runs"] if r["kind"] in kinds)]
        first = [next(r for k in kinds for r in row["runs"] if r["kind"] == k and r["found"]) for row in found]
        total = sorted(sum(r["seconds"] for r in row["runs"] if r["kind"] in kinds) for row in rows)
        right = sum(r["right"] for r in first)
        name = "all of them" if kinds == KINDS else f"{kinds[0]}"
        print(
            f"| {name} | {len(found)} ({len(found) / len(rows):.0%}) | {right} ({right / max(1, len(found)):.0%}) | {total[len(total) // 2]:.1f} |"
        )
    means = {
        order: sum(seconds_to_find(row, order) for row in rows) / len(rows) for order in itertools.permutations(KINDS)
    }
    best = min(means, key=means.get)
    print(
        f"\nmean seconds until a mutant is found, one run at a time: {', '.join(KINDS)}: {means[KINDS]:.2f}; the best order, {', '.join(best)}: {means[best]:.2f}"
    )


def chosen_mutants(options):
    """(number, mutant) of those that are to be found: all, the named ones, or a sample."""
    mutants = yaml.safe_load((options.source / "verif/mutants/mutants.yaml").read_text())
    unknown = set(options.names) - {m["name"] for m in mutants}
    if unknown:
        sys.exit(f"tools/regress-mutants: no mutant is called {sorted(unknown)[0]}")
    chosen = [
        (n, m)
        for n, m in enumerate(mutants, 1)
        if "equivalent" not in m and (not options.names or m["name"] in options.names)
    ]
    if not chosen:
        sys.exit("tools/regress-mutants: these mutants are the same as the sound RTL: there is nothing to find")
    if options.sample is not None and options.sample < 1:
        sys.exit(f"tools/regress-mutants: --sample {options.sample}: it is 1 or more")
    if options.sample and options.sample < len(chosen):
        chosen = sorted(random.Random(options.seed).sample(chosen, options.sample), key=lambda c: c[0])
    return chosen


def each(options, chosen):
    """--each."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        rows = []
        for row in pool.map(lambda c: try_each(options.kage, *c, options), chosen):
            rows.append(row)
            if options.json:
                kept_rows.write(options.json, rows)
            found = [r for r in row["runs"] if r["found"]]
            print(f"{row['name']:<28} found by {len(found)} of {len(row['runs'])} runs", flush=True)
    tell_each(rows)


def earlier(options, tried):
    """The rows that --resume goes on from, by mutant."""
    if not options.json:
        sys.exit("tools/regress-mutants: --resume needs --json FILE")
    asked = {"seed": options.seed, "minutes": options.minutes, "of": tried}
    try:
        return {row["name"]: row for row in kept_rows.load(options.json, SCHEMA, asked)}
    except kept_rows.NotThese as e:
        sys.exit(f"tools/regress-mutants: {e}")


def regress_all(options, chosen):
    """A row for each mutant; those that are kept are not run again."""
    tried = what_is_tried(options)
    kept = earlier(options, tried) if options.resume else {}
    rows = []
    with tempfile.TemporaryDirectory() as out:
        for number, mutant in chosen:
            row = kept.get(mutant["name"])
            if not row:
                row = {"schema": SCHEMA, "name": mutant["name"]}
                row |= {"seed": options.seed, "minutes": options.minutes, "of": tried}
                row |= run(options.kage, number, options, out)
            rows.append(row)
            if options.json:
                unmet = [r for n, r in kept.items() if n not in {row["name"] for row in rows}]
                kept_rows.write(options.json, rows + unmet)
            verdict = f"{row['seconds']:7.1f} s  {row['run']}" if row["found"] else "  not found"
            print(f"{row['name']:<28} {verdict}", flush=True)
    return rows


def tell(rows, options):
    found = [r["seconds"] for r in rows if r["found"]]
    print(f"\n{len(rows)} mutants, {len(found)} found ({len(found) / len(rows):.1%}), seed {options.seed}")
    for seconds in (1, 5, 10, 30, 60, 120, 300):
        if seconds <= 60 * options.minutes:
            so_far = sum(s <= seconds for s in found)
            print(f"  after {seconds:>3} s: {so_far} ({so_far / len(rows):.1%})")


def main():
    parser = argparse.ArgumentParser(prog="tools/regress-mutants")
    parser.add_argument("kage")
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("--minutes", type=float, default=5)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--plot")
    parser.add_argument("--json")
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--each", action="store_true")
    parser.add_argument("--sample", type=int)
    parser.add_argument("names", nargs="*")
    options = parser.parse_intermixed_args()
    chosen = chosen_mutants(options)
    if options.each and options.resume:
        sys.exit("tools/regress-mutants: --each begins anew: leave out --resume")
    if options.each:
        return each(options, chosen)
    rows = regress_all(options, chosen)
    tell(rows, options)
    if options.plot:
        plot(rows, options.minutes, options.plot)


main()
