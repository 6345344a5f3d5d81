# SPDX-License-Identifier: Apache-2.0
"""kage_axi under cocotb, by AXI models that share nothing with kage's own co-simulation: cocotbext-axi's stream source and
sink, and its AXI4-Lite master. The golden core (the package kage, ../../python) gives the expected output.

$KAGE_STREAM names the stream file whose first frame is drawn. The core's parameters are those of the file.
"""

import itertools
import os
import random

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ReadOnly, RisingEdge, with_timeout
from cocotbext.axi import (
    AxiLiteBus,
    AxiLiteMaster,
    AxiResp,
    AxiStreamBus,
    AxiStreamFrame,
    AxiStreamSink,
    AxiStreamSource,
)

import kage
from kage.stream import REGISTER_FIELDS, REGISTERS

STREAM = os.environ["KAGE_STREAM"]
SEED = int(os.environ.get("KAGE_SEED", "1"))
# Stalls: input, output. A generator of pauses gives a bool a clock.
PATTERNS = {
    "none": (None, None),
    "input": (lambda r: (r.random() < 0.5 for _ in itertools.count()), None),
    "output": (None, lambda r: (r.random() < 0.5 for _ in itertools.count())),
    # Long stops at both ends, now and then together.
    "bursts": (
        lambda r: itertools.cycle([False] * 23 + [True] * 41),
        lambda r: itertools.cycle([False] * 31 + [True] * 29),
    ),
}


def address(register):
    return REGISTERS[register][0]


def field(register, name, value):
    lsb, bits = REGISTER_FIELDS[register][name]
    return value >> lsb & (1 << bits) - 1


class Bench:
    """Clock, reset, the three ports, and a watch over each clock's handshakes."""

    def __init__(self, dut):
        self.dut = dut
        self.golden = kage.Golden(STREAM)
        self.words = next(kage.frames(STREAM))
        self.frame = self.golden.frame(self.words)
        assert self.frame.status, self.frame.status
        self.channels = self.golden.config.CHANNELS
        self.beat_bytes = 4 * self.golden.config.BEAT_WORDS
        cocotb.start_soon(Clock(dut.aclk, 10, "ns").start())
        dut.aresetn.value = 0
        self.source = AxiStreamSource(AxiStreamBus.from_prefix(dut, "s_axis"), dut.aclk, dut.aresetn, reset_active_level=False)
        self.sink = AxiStreamSink(AxiStreamBus.from_prefix(dut, "m_axis"), dut.aclk, dut.aresetn, reset_active_level=False)
        self.registers = AxiLiteMaster(AxiLiteBus.from_prefix(dut, "s_axil"), dut.aclk, dut.aresetn, reset_active_level=False)
        for port in (self.source, self.sink, self.registers.write_if, self.registers.read_if):
            port.log.setLevel("WARNING")  # else each frame is a line of all its bytes
        cocotb.start_soon(self.watch())

    async def watch(self):
        """From the second clock of reset on no control output is X; a valid stays with its data until it is taken."""
        dut = self.dut
        controls = [dut.s_axis_tready, dut.m_axis_tvalid, dut.s_axil_awready, dut.s_axil_wready, dut.s_axil_bvalid,
                    dut.s_axil_arready, dut.s_axil_rvalid, dut.irq]  # fmt: skip
        held = {
            "m_axis": (dut.m_axis_tvalid, dut.m_axis_tready, [dut.m_axis_tdata, dut.m_axis_tlast, dut.m_axis_tuser]),
            "s_axil_b": (dut.s_axil_bvalid, dut.s_axil_bready, [dut.s_axil_bresp]),
            "s_axil_r": (dut.s_axil_rvalid, dut.s_axil_rready, [dut.s_axil_rdata, dut.s_axil_rresp]),
        }
        waiting = {}
        in_reset = 0
        while True:
            await RisingEdge(dut.aclk)
            # Here signals have the values that the edge samples: those of the clock that it ends.
            reset = not dut.aresetn.value
            in_reset = in_reset + 1 if reset else 0
            if not reset or in_reset > 1:
                for signal in controls:
                    assert signal.value.is_resolvable, f"{signal._name} is {signal.value}"
            for name, (valid, ready, data) in held.items():
                now = [str(d.value) for d in data] if not reset and valid.value else None
                before = waiting.get(name)
                assert before is None or reset or now == before, f"{name}: {before} became {now} while it waited"
                waiting[name] = now if now is not None and not ready.value else None

    async def reset(self, clocks=4):
        self.dut.aresetn.value = 0
        for _ in range(clocks):
            await RisingEdge(self.dut.aclk)
        self.dut.aresetn.value = 1
        self.source.clear()
        self.sink.clear()

    async def start(self):
        """Reset, and a core that is the stream's: else every frame would be refused, and each test wait long for its lines."""
        await self.reset()
        core, stream = await self.read("PARAM_HASH"), self.golden.config.hash()
        assert core == stream, f"the core has PARAM_HASH {core:08x}, the stream {stream:08x}: make clean"

    def stall(self, pattern):
        for port, stalls, seed in zip((self.source, self.sink), PATTERNS[pattern], (SEED, SEED + 1)):
            if stalls:
                port.set_pause_generator(stalls(random.Random(seed)))
            else:
                port.clear_pause_generator()
                port.pause = False

    async def send(self, words):
        data = b"".join(w.to_bytes(4, "little") for w in words)
        data += bytes(-len(data) % self.beat_bytes)
        await self.source.send(AxiStreamFrame(data))

    async def expect(self, frame, name):
        """The pixels of a frame, line by line: TLAST ends a line, TUSER begins a frame."""
        for y in range(frame.height):
            line = await with_timeout(self.sink.recv(), 4000 + 400 * frame.width, "us")
            got = bytes(line.tdata)
            user = line.tuser if isinstance(line.tuser, list) else [line.tuser]
            assert got == frame.lines[y], f"{name}: line {y}: {first_difference(got, frame.lines[y], self.channels)}"
            # The sink tells TUSER of each byte, or once where all are the same.
            wanted = [int(y == 0 and x == 0) for x in range(frame.width) for _ in range(self.channels)]
            assert user == wanted or (len(user) == 1 and user * len(wanted) == wanted), f"{name}: line {y}: TUSER {user}"

    async def nothing_more(self):
        """No pixel comes behind those that were expected."""
        self.sink.clear_pause_generator()
        self.sink.pause = False
        for _ in range(100):
            await RisingEdge(self.dut.aclk)
            assert not self.dut.m_axis_tvalid.value, "a pixel too many"
        assert self.sink.empty(), "a line too many"

    async def read(self, register):
        answer = await with_timeout(self.registers.read(address(register), 4), 10, "us")
        assert answer.resp == AxiResp.OKAY, f"{register}: {answer.resp}"
        return int.from_bytes(answer.data, "little")

    async def write(self, register, value):
        answer = await with_timeout(self.registers.write(address(register), value.to_bytes(4, "little")), 10, "us")
        assert answer.resp == AxiResp.OKAY, f"{register}: {answer.resp}"

    async def until(self, register, value):
        """Until a register has a value; it says what the core did a clock ago."""
        for _ in range(200):
            if (found := await self.read(register)) == value:
                return
        raise AssertionError(f"{register} stays {found}, expected {value}")


def first_difference(got, wanted, channels):
    if len(got) != len(wanted):
        return f"{len(got) // channels} pixels, expected {len(wanted) // channels}"
    at = next(i for i in range(len(got)) if got[i] != wanted[i])
    return f"x {at // channels}, channel {at % channels}: expected {wanted[at]}, got {got[at]}"


@cocotb.test()
@cocotb.parametrize(pattern=list(PATTERNS))
async def frame(dut, pattern):
    """A frame under a pattern of stalls."""
    bench = Bench(dut)
    await bench.start()
    bench.stall(pattern)
    await bench.send(bench.words)
    await bench.expect(bench.frame, pattern)
    await bench.until("FRAMES", 1)
    assert await bench.read("ERRORS") == 0
    await bench.nothing_more()


@cocotb.test()
async def unknown_inputs_in_reset(dut):
    """Data and addresses are X while reset holds, and while their valid is low behind it."""
    bench = Bench(dut)
    await RisingEdge(dut.aclk)
    await RisingEdge(dut.aclk)  # the models have put their own values there by now
    for signal in (dut.s_axis_tdata, dut.s_axis_tlast, dut.s_axil_awaddr, dut.s_axil_wdata, dut.s_axil_wstrb, dut.s_axil_araddr):
        signal.value = cocotb.types.LogicArray("X" * len(signal))
    await bench.reset(clocks=3)
    for _ in range(20):
        await RisingEdge(dut.aclk)
        assert not dut.s_axis_tdata.value.is_resolvable and not dut.s_axil_wdata.value.is_resolvable
    await bench.send(bench.words)
    await bench.expect(bench.frame, "behind unknown inputs")
    await bench.nothing_more()


@cocotb.test()
async def resets_within_a_frame(dut):
    """Reset of 1, 2 and 3 clocks while a frame is under way; the next frame is whole, and the counters begin anew."""
    bench = Bench(dut)
    dice = random.Random(SEED)
    await bench.start()
    for clocks in (1, 2, 3):
        await bench.send(bench.words)
        for _ in range(dice.randrange(30, 40 + len(bench.words))):
            await RisingEdge(dut.aclk)
        await bench.reset(clocks)
        await bench.send(bench.words)
        await bench.expect(bench.frame, f"behind a reset of {clocks}")
        await bench.until("FRAMES", 1)
    await bench.nothing_more()


@cocotb.test()
async def malformed_frames(dut):
    """Words that break rules: the pixels and the error registers are the golden core's, and a good frame behind them is good."""
    bench = Bench(dut)
    await bench.start()
    dice = random.Random(SEED)
    errors = 0
    frames = 0
    seen = set()
    for name, words in damaged(bench.words, dice):
        frame = bench.golden.frame(words)
        await bench.send(words)
        await bench.expect(frame, name)
        frames += 1
        await bench.until("FRAMES", frames)
        if not frame.status:
            errors += 1
            seen.add(frame.status.error)
            error = await bench.read("ERROR")
            assert field("ERROR", "CODE", error) == frame.status.error, f"{name}: {error:#x}, expected {frame.status}"
            assert field("ERROR", "LINE", error) == frame.status.line, f"{name}: {error:#x}, expected {frame.status}"
            assert await bench.read("ERROR_TOKEN") == frame.status.token, f"{name}: expected {frame.status}"
            assert await bench.read("ERROR_FRAME") == frame.status.frame, f"{name}: expected {frame.status}"
        assert await bench.read("ERRORS") == errors, name
        await bench.nothing_more()
    assert len(seen) >= 6, f"only the errors {sorted(seen)} came"


def damaged(words, dice):
    """Small frames that break a rule each, one after another, and a sound one between them. `words` is a sound frame, of which
    the first lines are taken."""
    config = kage.Golden(STREAM).config
    codec = kage.Codec(config)
    tokens = list(codec.tokens(words))
    header = words[:5]

    def lines(count):
        """A frame of the first lines: header, what stands before them, the lines, END."""
        out, ends = [], 0
        for token in tokens:
            if ends == count:
                break
            out.append(token)
            ends += token["kind"] == "EOL"
        return out

    def whole(height, body):
        width = header[1] & 0xFFFF
        end = next(t for t in tokens if t["kind"] == "END")
        return [header[0], height << 16 | width, *header[2:], *(w for t in [*body, end] for w in codec.pack(t))]

    good = whole(2, lines(2))
    yield "sound", good
    yield "magic", [header[0] ^ 1, *good[1:]]
    yield "size", [good[0], 0, *good[2:]]
    yield "parameters", [*good[:2], good[2] ^ 0x10, *good[3:]]
    yield "sound again", good
    yield "kind 0", [*good[:5], 0, *good[5:]]
    yield "cut short", good[: 5 + dice.randrange(4, 8)]
    yield "too long", [*good, *([0] * config.BEAT_WORDS)]
    yield "a line too few", whole(3, lines(2))
    yield "the second line first", whole(2, [t for t in lines(2) if not (t["kind"] == "EOL" and t["y"] == 0)])
    yield "sound at last", good


@cocotb.test()
async def register_accesses(dut):
    """Accesses in all orders, by strobes, and to where nothing is."""
    bench = Bench(dut)
    await bench.start()
    config = bench.golden.config
    assert await bench.read("ID") == 0x4B414745
    assert await bench.read("PARAM_HASH") == config.hash()
    shape = await bench.read("SHAPE")
    assert field("SHAPE", "MAX_WIDTH", shape) == config.MAX_WIDTH
    assert field("SHAPE", "BEAT_WORDS", shape) == config.BEAT_WORDS
    capability = await bench.read("CAPABILITY")
    assert field("CAPABILITY", "SPANS", capability) == 1
    assert field("CAPABILITY", "ACTIVE", capability) == config.ACTIVE
    assert field("CAPABILITY", "POLYGONS", capability) == (config.ACTIVE > 0)

    answers = bench.registers.write_if.b_channel

    async def write_raw(at, value, strobes, order):
        """A write whose address comes before its data, with it, or behind it; the answer is taken late."""
        answers.pause = True  # the master takes none of them
        dut.s_axil_bready.value = 0
        second = {"address": order == "data first", "data": order == "address first"}  # it waits for the other one
        sent = set()
        wait = 3
        for _ in range(50):
            for what, valid in (("address", dut.s_axil_awvalid), ("data", dut.s_axil_wvalid)):
                valid.value = int(what not in sent and (not second[what] or wait == 0))
            dut.s_axil_awaddr.value = at
            dut.s_axil_wdata.value = value
            dut.s_axil_wstrb.value = strobes
            await ReadOnly()
            took = {
                what
                for what, valid, ready in (
                    ("address", dut.s_axil_awvalid, dut.s_axil_awready),
                    ("data", dut.s_axil_wvalid, dut.s_axil_wready),
                )
                if valid.value and ready.value
            }
            assert not dut.s_axil_bvalid.value or sent == {"address", "data"}, "an answer before all was taken"
            if dut.s_axil_bvalid.value:
                break
            await RisingEdge(dut.aclk)
            sent |= took
            wait = max(0, wait - 1)
        else:
            raise AssertionError(f"no answer to a write, {order}")
        await RisingEdge(dut.aclk)
        for _ in range(2):
            await RisingEdge(dut.aclk)  # the answer waits, which the watch looks at
        dut.s_axil_bready.value = 1
        await ReadOnly()
        assert dut.s_axil_bvalid.value, "the answer went away"
        response = AxiResp(int(dut.s_axil_bresp.value))
        await RisingEdge(dut.aclk)
        dut.s_axil_bready.value = 0
        await RisingEdge(dut.aclk)
        assert not dut.s_axil_bvalid.value, "a second answer"
        answers.clear()
        answers.pause = False
        return response

    for order in ("together", "address first", "data first"):
        assert await write_raw(address("WATCHDOG"), 0x11223344, 15, order) == AxiResp.OKAY
        assert await bench.read("WATCHDOG") == 0x11223344, order
        assert await write_raw(address("WATCHDOG"), 0xAABBCCDD, 0b0101, order) == AxiResp.OKAY
        assert await bench.read("WATCHDOG") == 0x11BB33DD, order
        assert await write_raw(address("WATCHDOG"), 0, 0, order) == AxiResp.OKAY
        assert await bench.read("WATCHDOG") == 0x11BB33DD, order
        assert await write_raw(address("ID"), 1, 15, order) == AxiResp.OKAY  # read only: ignored
        past = max(at for at, _, _ in REGISTERS.values()) + 4
        assert await write_raw(past, 1, 15, order) == AxiResp.SLVERR, order
        assert (await with_timeout(bench.registers.read(past, 4), 10, "us")).resp == AxiResp.SLVERR
    assert await bench.read("ID") == 0x4B414745
    # A read and a write at the same time.
    write = cocotb.start_soon(bench.write("CONTROL", 7))
    assert await bench.read("VERSION") == 1
    await write
    assert await bench.read("CONTROL") == 7


@cocotb.test()
async def interrupt_and_watchdog(dut):
    """A frame's end interrupts, an error does, and a standstill within a frame lets the watchdog bite once."""
    bench = Bench(dut)
    await bench.start()
    await bench.write("CONTROL", 1)
    await bench.send(bench.words)
    await bench.expect(bench.frame, "with an interrupt")
    await bench.until("FRAMES", 1)
    assert dut.irq.value == 1 and await bench.read("IRQ") == 1
    await bench.write("IRQ", 1)
    assert await bench.read("IRQ") == 0 and dut.irq.value == 0

    await bench.write("WATCHDOG", 60)
    await bench.write("CONTROL", 4)
    assert dut.irq.value == 0
    await bench.send(bench.words)
    for _ in range(12):  # a frame is open, and not at its end
        await RisingEdge(dut.aclk)
    bench.source.pause = True
    bench.sink.pause = True
    for _ in range(2000):
        await RisingEdge(dut.aclk)
        if dut.irq.value:
            break
    else:
        raise AssertionError("the watchdog does not bite")
    assert await bench.read("IRQ") & 4
    stall = await bench.read("STALL")
    assert field("STALL", "ON_INPUT", stall) or field("STALL", "ON_OUTPUT", stall), f"{stall:#x}"
    await bench.write("IRQ", 4)
    for _ in range(200):
        await RisingEdge(dut.aclk)
    assert not await bench.read("IRQ") & 4, "it bites twice for one standstill"
    bench.source.pause = False
    bench.sink.pause = False
    await bench.expect(bench.frame, "behind a standstill")
    await bench.until("FRAMES", 2)
    await bench.nothing_more()
