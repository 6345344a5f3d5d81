# SPDX-License-Identifier: Apache-2.0
"""See tools/regress-mutants."""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import yaml


def run(kage, number, options, out):
    """What kage regress says of a mutant."""
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
    import math

    width, height, left, right, top, bottom = 640, 360, 56, 16, 16, 44
    least, most = 0.1, 60 * minutes
    x = lambda s: left + (width - left - right) * math.log(max(s, least) / least) / math.log(most / least)
    y = lambda share: height - bottom - (height - top - bottom) * share
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
            out.append(f'<line x1="{x(seconds):.1f}" x2="{x(seconds):.1f}" y1="{top}" y2="{height - bottom}" stroke="#eee"/>')
            out.append(f'<text x="{x(seconds):.1f}" y="{height - bottom + 18}" text-anchor="middle">{seconds:g} s</text>')
    out.append(f'<polyline points="{line}" fill="none" stroke="#1f6feb" stroke-width="2"/>')
    out.append(f'<text x="{(left + width - right) / 2}" y="{height - 6}" text-anchor="middle">time of kage regress</text>')
    out.append("</svg>")
    pathlib.Path(path).write_text("\n".join(out) + "\n")


def main():
    parser = argparse.ArgumentParser(prog="tools/regress-mutants")
    parser.add_argument("kage")
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("--minutes", type=float, default=5)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--plot")
    parser.add_argument("--json")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    mutants = yaml.safe_load((options.source / "verif/mutants/mutants.yaml").read_text())
    unknown = set(options.names) - {m["name"] for m in mutants}
    if unknown:
        sys.exit(f"tools/regress-mutants: no mutant is called {sorted(unknown)[0]}")
    rows = []
    with tempfile.TemporaryDirectory() as out:
        for number, mutant in enumerate(mutants, 1):
            if "equivalent" in mutant or (options.names and mutant["name"] not in options.names):
                continue
            row = {"name": mutant["name"], **run(options.kage, number, options, out)}
            rows.append(row)
            verdict = f"{row['seconds']:7.1f} s  {row['run']}" if row["found"] else "  not found"
            print(f"{row['name']:<28} {verdict}", flush=True)
    found = [r["seconds"] for r in rows if r["found"]]
    print(f"\n{len(rows)} mutants, {len(found)} found ({len(found) / len(rows):.1%}), seed {options.seed}")
    for seconds in (1, 5, 10, 30, 60, 120, 300):
        if seconds <= 60 * options.minutes:
            so_far = sum(s <= seconds for s in found)
            print(f"  after {seconds:>3} s: {so_far} ({so_far / len(rows):.1%})")
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(rows, indent=1) + "\n")
    if options.plot:
        plot(rows, options.minutes, options.plot)


main()
