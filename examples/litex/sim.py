#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the frames of a pack by kage in a SoC of LiteX, under LiteX's simulator, and holds pixels and registers against it.

The SoC has no processor. In its place stands a list of accesses to the SoC's bus (Accesses, below). It reads and writes the
core's registers through the bridge from Wishbone to AXI4-Lite, starts LiteX's DMA, which reads the frame from RAM, and
waits for the interrupt. The simulation prints each pixel and each answer, and this program checks them.

usage: sim.py [--config NAME|FILE] [--scene SCENE] [--size WxH] [--pack FOLDER] [--work FOLDER] [--rtl FOLDER] [--jobs N]
Exit code 0: all the same. 1: different. 2: trouble.
"""

import argparse
import contextlib
import logging
import os
import pathlib
import subprocess
import sys

import kage
from kage.stream import ERRORS, REGISTER_FIELDS, REGISTERS, VERSION
from kage_litex import Kage
from litex.build.generic_platform import Pins
from litex.build.io import CRG
from litex.build.sim import SimPlatform
from litex.build.sim.config import SimConfig
from litex.gen import LiteXModule
from litex.soc.cores.dma import WishboneDMAReader
from litex.soc.integration.soc import SoCRegion
from litex.soc.integration.soc_core import SoCMini
from litex.soc.interconnect import stream, wishbone
from migen import FSM, Display, Finish, If, Memory, NextState, NextValue, Signal

CLOCK = int(1e6)
FRAMES_AT = 0x4000_0000
KAGE_AT = 0x3000_0000
PATIENCE = 50_000  # clocks without an access or a pixel
END, WRITE, READ, INTERRUPT, PIXELS = range(5)


class Accesses(LiteXModule):
    """The processor's stand-in: a list of steps, one after another. A step is what, an address, a value."""

    autocsr_exclude = {"memory"}  # else the bus would have it

    def __init__(self, bus, interrupt, pixels, length):
        self.memory = Memory(3 + 32 + 32, length, name="accesses")
        port = self.memory.get_port(async_read=True)
        self.specials += self.memory, port
        step = Signal(max=length + 1)
        what, address, value = port.dat_r[:3], port.dat_r[3:35], port.dat_r[35:67]
        resting = Signal(max=PATIENCE + 1)
        pixels_before = Signal(len(pixels))
        self.comb += [
            port.adr.eq(step),
            bus.adr.eq(address[2:]),
            bus.dat_w.eq(value),
            bus.sel.eq(0xF),
            bus.we.eq(what == WRITE),
        ]
        self.fsm = fsm = FSM(reset_state="STEP")
        done = [NextValue(step, step + 1), NextState("STEP")]
        fsm.act(
            "STEP",
            If((what == WRITE) | (what == READ), NextState("ACCESS"))
            .Elif(what == END, NextState("END"))
            .Elif(
                ((what == INTERRUPT) & interrupt) | ((what == PIXELS) & (pixels >= value)), NextValue(step, step + 1)
            ),
        )
        fsm.act("ACCESS", bus.cyc.eq(1), bus.stb.eq(1), If(bus.ack, *done))
        ended = Signal()
        fsm.act("END", ended.eq(1))
        self.sync += [
            If(bus.ack & (what == READ), Display("read %x %d", bus.dat_r, bus.err)),
            pixels_before.eq(pixels),
            If(bus.ack | (pixels != pixels_before), resting.eq(0)).Else(resting.eq(resting + 1)),
            If(ended & (resting > 100), Display("end"), Finish()),  # a pixel too many would have come by then
            If(resting == PATIENCE, Display("rest %d", step), Finish()),
        ]

    def say(self, steps):
        """The list. It is known once the SoC has given its registers addresses, and the memory is there before."""
        assert len(steps) < self.memory.depth, "the list has room for as many steps as were said"
        self.memory.init = [what | address << 3 | value << 35 for what, address, value in steps]


class Soc(SoCMini):
    def __init__(self, platform, config, rtl, words, steps):
        super().__init__(platform, CLOCK, with_timer=False)
        self.crg = CRG(platform.request("sys_clk"))
        self.kage = Kage(platform, config, rtl)
        self.bus.add_slave("kage", self.kage.bus, SoCRegion(origin=KAGE_AT, size=Kage.SIZE, cached=False))

        # Frames: RAM, LiteX's DMA, and words joined to beats. "big" leaves a word as a processor has it; "little" turns its bytes.
        size = 1 << (4 * len(words) - 1).bit_length()
        self.add_ram("frames", FRAMES_AT, size, contents=words)
        self.dma = WishboneDMAReader(wishbone.Interface(), endianness="big", with_csr=True)
        self.bus.add_master("dma", self.dma.bus)
        self.beats = stream.Converter(32, len(self.kage.sink.data))
        self.comb += [self.dma.source.connect(self.beats.sink), self.beats.source.connect(self.kage.sink)]

        # Video: each pixel is printed. It is not ready in each clock, as a way to memory would not be either.
        pixels, pause = Signal(32), Signal(3)
        video = self.kage.source
        self.comb += video.ready.eq(pause != 0)
        self.sync += [
            pause.eq(pause + 1),
            If(
                video.valid & video.ready,
                pixels.eq(pixels + 1),
                Display("pixel %x %d %d", video.data, video.first, video.last),
            ),
        ]

        processor = wishbone.Interface()
        self.bus.add_master("processor", processor)
        self.accesses = Accesses(processor, self.kage.ev.irq, pixels, steps)


class Script:
    """The processor's accesses, and the answers expected: a read has a name and its expected value, None for any."""

    def __init__(self, csr):
        self.csr, self.steps, self.expected = csr, [], []

    def core(self, register):
        return KAGE_AT + REGISTERS[register][0]

    def write(self, address, value):
        self.steps.append((WRITE, address, value))

    def read(self, address, name, value, refused=0):
        self.steps.append((READ, address, 0))
        self.expected.append((name, value, refused))

    def wait(self, what, value=0):
        self.steps.append((what, 0, value))


def field(register, name, value):
    lsb, bits = REGISTER_FIELDS[register][name]
    assert 0 <= value < 1 << bits
    return value << lsb


def script_of(pack, config, places, csr):
    """All frames of the pack, one after another. csr(NAME) is the address of a register of LiteX."""
    s = Script(csr)
    everything = sum(field("IRQ", name, 1) for name in REGISTER_FIELDS["IRQ"])
    shape = sum(field("SHAPE", name, getattr(config, name)) for name in REGISTER_FIELDS["SHAPE"])
    for name, value in {
        "ID": int.from_bytes(b"KAGE", "big"),
        "VERSION": VERSION,
        "PARAM_HASH": config.hash(),
        "SHAPE": shape,
        "CAPABILITY": field("CAPABILITY", "SPANS", 1),
    }.items():
        s.read(s.core(name), name, value)
    s.read(KAGE_AT + 4 * len(REGISTERS), "behind the last register", None, refused=1)
    s.write(s.core("WATCHDOG"), PATIENCE // 2)
    s.read(s.core("WATCHDOG"), "WATCHDOG", PATIENCE // 2)
    # An error interrupts before its frame has ended, so it is not asked for: IRQ tells it at the frame's end too.
    s.write(s.core("CONTROL"), everything - field("CONTROL", "ERROR", 1))
    s.write(csr("kage_ev_enable"), 1)
    errors = pixels = 0
    for number, (frame, (address, size)) in enumerate(zip(pack.manifest["frames"], places)):
        who = f"frame {number} ({frame['what']}): "
        s.write(csr("dma_base"), 0)  # the upper half
        s.write(csr("dma_base") + 4, address)
        s.write(csr("dma_length"), size)
        s.write(csr("dma_enable"), 1)
        pixels += frame["width"] * frame["height"]
        s.wait(INTERRUPT)
        s.read(csr("kage_ev_pending"), who + "ev_pending", 1)
        s.wait(PIXELS, pixels)
        s.write(csr("dma_enable"), 0)
        bad = frame["error"] != "NONE"
        errors += bad
        s.read(s.core("IRQ"), who + "IRQ", field("IRQ", "FRAME_END", 1) | field("IRQ", "ERROR", int(bad)))
        s.write(s.core("IRQ"), everything)
        s.read(csr("kage_ev_pending"), who + "ev_pending once IRQ is cleared", 0)
        s.read(s.core("STATUS"), who + "STATUS", 0)
        s.read(s.core("FRAMES"), who + "FRAMES", number + 1)
        s.read(s.core("ERRORS"), who + "ERRORS", errors)
        if bad:
            code = field("ERROR", "CODE", ERRORS[frame["error"]][0]) | field("ERROR", "LINE", frame["error_line"])
            s.read(s.core("ERROR"), who + "ERROR", code)
            s.read(s.core("ERROR_FRAME"), who + "ERROR_FRAME", frame["error_frame"])
            s.read(s.core("ERROR_TOKEN"), who + "ERROR_TOKEN", frame["error_token"])
    s.read(s.core("STALL"), "STALL, as the watchdog has not bitten", 0)
    s.wait(END)
    return s


def simulate(soc, script, work, jobs):
    """Builds the SoC by LiteX's SimPlatform and runs it. The lines that it prints."""
    simulation = SimConfig()
    simulation.add_clocker("sys_clk", freq_hz=CLOCK)
    soc.accesses.say(script.steps)
    with contextlib.redirect_stdout(sys.stderr):
        soc.platform.build(
            soc, build_dir=str(work), sim_config=simulation, run=False, jobs=jobs, opt_level="O1", interactive=False
        )
    # Only the clock of LiteX's modules for the simulator: others talk to a network or a terminal.
    environment = {**os.environ, "MAKEFLAGS": "-- MODULES=clocker"}
    with open(work / "build.log", "w") as log:
        subprocess.run(
            ["bash", "build_sim.sh"], cwd=work, env=environment, stdout=log, stderr=subprocess.STDOUT, check=True
        )
    done = subprocess.run(["obj_dir/Vsim"], cwd=work, capture_output=True, text=True, timeout=600)
    (work / "run.log").write_text(done.stdout + done.stderr)
    return done.stdout.splitlines()


def differences(pack, script, lines, channels):
    """A line for each thing that is not as the pack has it, and how much was compared."""
    frames = [(n, f) for n, f in enumerate(pack.frames())]
    wanted_pixels = [
        (
            f"frame {n}, line {y}, x {x}",
            line[x * channels : (x + 1) * channels],
            x == y == 0,
            x == len(line) // channels - 1,
        )
        for n, f in frames
        for y, line in enumerate(f.lines)
        for x in range(len(line) // channels)
    ]
    found, pixels, reads, ended = [], 0, 0, False
    for line in lines:
        match line.split():
            case ["pixel", data, first, last]:
                if pixels == len(wanted_pixels):
                    found.append("a pixel too many")
                    break
                place, color, is_first, is_last = wanted_pixels[pixels]
                pixels += 1
                got = int(data, 16).to_bytes(channels, "little")
                if got != color:
                    found.append(f"{place}: expected {tuple(color)}, got {tuple(got)}")
                if (int(first), int(last)) != (is_first, is_last):
                    found.append(f"{place}: first {first}, last {last}")
            case ["read", data, error]:
                name, value, refused = script.expected[reads]
                reads += 1
                if int(error) != refused:
                    found.append(f"{name}: {'answered' if refused else 'refused'}")
                elif value is not None and int(data, 16) != value:
                    found.append(f"{name}: expected {value:#x}, got {int(data, 16):#x}")
            case ["rest", step]:
                found.append(f"nothing moves at step {step}, {script.steps[int(step)]}")
            case ["end"]:
                ended = True
    if not found and (not ended or pixels < len(wanted_pixels) or reads < len(script.expected)):
        found.append(
            f"it ended early: {pixels} of {len(wanted_pixels)} pixels, {reads} of {len(script.expected)} reads"
        )
    return found, f"{len(frames)} frames, {pixels} pixels and {reads} reads compared"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--config", default="tiny", help="a name in rtl/defs/configs.yaml, or a YAML file")
    parser.add_argument("--scene", default="courtyard", help="a built-in scene, or a file")
    parser.add_argument("--size", default="64x48")
    parser.add_argument("--pack", help="a pack that is there (kage vectors), with a configuration of its own")
    parser.add_argument("--work", default="build/litex", type=pathlib.Path, help="the folder for what is built")
    parser.add_argument("--rtl", help="the core's files; else those of the source tree or the installation")
    parser.add_argument("--jobs", default=2, type=int)
    options = parser.parse_args()
    logging.disable(logging.INFO)
    work = options.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    if options.pack:
        pack = kage.Pack(options.pack)
    else:
        more = ["--degrade", "--frames", "1", "--no-rtl", "--size", options.size, "--config", options.config]
        pack = kage.write_pack(options.scene, work / "pack", more)
    # The frames in RAM, each with zeros up to a whole beat.
    words, places = [], []
    for frame in pack.frames():
        whole = frame.words + [0] * (-len(frame.words) % pack.config.BEAT_WORDS)
        places.append((FRAMES_AT + 4 * len(words), 4 * len(whole)))
        words += whole
    steps = len(script_of(pack, pack.config, places, lambda name: 0).steps) + 1
    platform = SimPlatform("SIM", [("sys_clk", 0, Pins(1))])
    soc = Soc(platform, pack.config, options.rtl, words, steps)
    with contextlib.redirect_stdout(sys.stderr):
        soc.finalize()

    def csr(name):
        module = next(m for m in soc.csr.regions if name.startswith(m + "_"))
        at = soc.csr.regions[module].origin
        for register in soc.csr.regions[module].obj:
            if f"{module}_{register.name}" == name:
                return at
            at += 4 * ((register.size + 31) // 32)
        raise KeyError(name)

    script = script_of(pack, pack.config, places, csr)
    found, compared = differences(pack, script, simulate(soc, script, work, options.jobs), pack.config.CHANNELS)
    for line in found[:5]:
        print(f"different: {line}")
    print(f"kage_litex: {'different' if found else 'same'}: {compared}")
    return 1 if found else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (kage.PackError, OSError, NotImplementedError, subprocess.SubprocessError) as error:
        print(f"sim.py: {error}", file=sys.stderr)
        sys.exit(2)
