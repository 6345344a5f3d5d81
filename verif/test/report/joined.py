# SPDX-License-Identifier: Apache-2.0
"""Shards of two scenes, joined."""

import json
import os

from looks import looks
from page import check, panel, sheet, stalls_by_phase


def joined_run(b):
    b.open("joined/report.html")
    kept = json.load(open("joined.json"))
    check(
        b.run("document.querySelector('h1').innerText").strip().endswith("Different"),
        "joined: the verdict is not Different",
    )
    verdict = b.run("document.getElementById('verdict').innerText")
    check(
        "courtyard, " + kept["first_difference"]["text"] in verdict,
        f"joined: the first difference is not told: {verdict}",
    )
    check(
        "rtl/pixel_banked.sv" in verdict and "3 differences more" in verdict,
        f"joined: the stage is not named: {verdict}",
    )
    joined_rows(b, kept)
    joined_links(b)
    lone_shards(b)
    same_shards(b)


def joined_rows(b, kept):
    """A row a scene, a row a frame, and each shard's command."""
    scenes = sheet(b, "scenes")
    for scene, row in zip(kept["scenes"], scenes[1:]):
        check(
            row[:7] == [scene["scene"], "different", scene["frames"], 3, "160x120", scene["cycles"], 0],
            f"joined: row {row}",
        )
    check(scenes[-1][5] == kept["cycles"] and scenes[-1][8] == kept["spans"], f"joined: sums {scenes[-1]}")
    frames = sheet(b, "table")[1:]
    check(
        [r[:2] for r in frames] == [[s, f] for s in ("courtyard", "penumbra") for f in range(3)],
        f"joined: frames {frames}",
    )
    check([r[2] for r in frames] == ["different", "different", "not compared"] * 2, "joined: the frames' verdicts")
    check(
        [r[3] for r in frames] == ["Shard 1/2", "Shard 2/2", "Shard 1/2", "Shard 2/2", "Shard 1/2", "Shard 2/2"],
        "joined: the frames' shards",
    )
    parts = b.run("document.getElementById('parts').innerText")
    for i, name in enumerate(("1/2", "2/2")):
        check(
            f"--shard {name}" in parts and os.getcwd() in parts and "Verilator" in parts,
            f"joined: no way to run shard {name} again",
        )
    check(b.run("document.querySelectorAll('#configs table').length") == 2, "joined: not two configurations")


def joined_links(b):
    """Keys come to every link, and the link of a frame to that frame."""
    stops = set()
    for _ in range(30):
        b.key("Tab")
        stops.add(b.run("document.activeElement.getAttribute('href') || document.activeElement.tagName"))
    links = set(b.run("[...document.querySelectorAll('a')].map(a => a.getAttribute('href'))"))
    check(
        links <= stops and len(links) == 8 and "SUMMARY" in stops and "BUTTON" in stops,
        f"Tab comes to {stops} of {links}",
    )
    looks(b, "joined")
    b.click("#table tbody tr:nth-child(2) a")
    b.until(
        "location.href.includes('/2/courtyard/report.html#frame=1') && document.body && document.body.dataset.ready === 'yes'"
    )
    check("Frame 1, column" in panel(b) and "They differ here" in panel(b), "the link does not show the frame")


def lone_shards(b):
    """Pages of shards that are not there, and the page of one shard alone."""
    b.open("gone/report.html")
    check(
        b.run("document.querySelectorAll('a').length") == 0
        and "its page is not here" in b.run("document.body.innerText"),
        "links to pages that are not there",
    )
    # The tokens of a shard's frames, whatever their numbers.
    b.open("part/report.html")
    check(
        b.run("Explain.data.frames.map(f => [f.frame, Explain.has(f.frame, 40)]).join()") == "1,true,4,true",
        "tokens of a shard's frames are missing",
    )


def same_shards(b):
    """One scene, all the same; a frame that is no shard's first."""
    b.open("joined-same/report.html")
    check(b.run("document.querySelector('h1').innerText").strip().endswith("Same"), "joined: the verdict is not Same")
    each = {f["frame"]: f for f in json.load(open("joined-same.json"))["each"]}
    rows = sheet(b, "table")[1:]
    check(
        [r[5] for r in rows] == [each[i]["stalled"]["input_starved"] for i in range(3)] and rows[2][5] > 0,
        f"joined: stalls {rows}",
    )
    looks(b, "joined-same")
    b.click("#table tbody tr:nth-child(3) a")
    b.until(
        "location.href.includes('/1/report.html#frame=2') && document.body && document.body.dataset.ready === 'yes'"
    )
    check("Frame 2, column" in panel(b), "the link does not show the frame")
    stalls_by_phase(b, each[2])
    check(len(each[2]["stalled_by_phase"]) > 2, f"input lacked in one phase only: {each[2]}")
