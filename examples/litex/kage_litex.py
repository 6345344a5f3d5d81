# SPDX-License-Identifier: Apache-2.0
"""kage as a module of LiteX.

    from kage_litex import Kage

    self.kage = Kage(platform, "default")  # a name, a YAML file, or parameters
    self.bus.add_slave("kage", self.kage.bus, SoCRegion(size=Kage.SIZE, cached=False))
    self.irq.add("kage")
    self.comb += [source_of_frames.connect(self.kage.sink), self.kage.source.connect(sink_of_video)]

It asks for the package kage (../../python), which knows the parameters and where they may stand.
"""

import dataclasses
import os
import pathlib

from kage.stream import Config
from litex.gen import LiteXModule
from litex.soc.interconnect import axi, stream
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourceLevel
from migen import ClockSignal, Instance, ResetSignal, Signal

_HERE = pathlib.Path(__file__).resolve().parent


def rtl_folder():
    """The core's files: $KAGE_RTL, the source tree's, or those that lie beside an installed example's prefix."""
    places = [_HERE.parents[1] / "rtl", *(p / "share/kage/rtl" for p in _HERE.parents)]
    if "KAGE_RTL" in os.environ:
        places = [pathlib.Path(os.environ["KAGE_RTL"])]
    for place in places:
        if (place / "kage_axi.v").exists():
            return place
    raise FileNotFoundError(f"kage_axi.v: not in {', '.join(map(str, places))}; name its folder in $KAGE_RTL")


def parameters_of(config, rtl):
    """The parameters that a name of rtl/defs/configs.yaml, a YAML file, a mapping or a Config says; the others have their
    defaults. Raises ValueError for those that no core can have."""
    if isinstance(config, str | os.PathLike):
        import yaml  # of Debian's python3-yaml; who gives parameters needs none

        known = yaml.safe_load((rtl / "defs/configs.yaml").read_text())
        config = (known[config] if config in known else yaml.safe_load(pathlib.Path(config).read_text())) or {}
    if not isinstance(config, Config):
        config = Config(**config)
    if faults := config.faults():
        raise ValueError(f"no core has these parameters: {'; '.join(faults)}")
    return config


class Kage(LiteXModule):
    """The core with its ports as LiteX has them.

    sink    frames: `data` of 32 * BEAT_WORDS bits, the first word lowest; `last` on the beat with a frame's last token
    source  video: `data` of 8 * CHANNELS bits, red lowest; `first` on a frame's first pixel, `last` on a line's last
    bus     registers by AXI4-Lite; SoCBusHandler.add_slave puts a bridge before it where the SoC's bus is another
    ev      the interrupt as an event source, by level: `pending` is 1 until the core's register IRQ has been cleared
    config  the parameters, as kage.stream.Config has them
    """

    SIZE = 0x100  # bytes of the registers' region

    def __init__(self, platform, config=None, rtl=None):
        rtl = pathlib.Path(rtl) if rtl else rtl_folder()
        self.config = parameters_of(config or {}, rtl)
        self.sink = stream.Endpoint([("data", 32 * self.config.BEAT_WORDS)])
        self.source = stream.Endpoint([("data", 8 * self.config.CHANNELS)])
        self.bus = axi.AXILiteInterface(data_width=32, address_width=32)
        self.ev = EventManager()
        self.ev.core = EventSourceLevel(description="A frame has ended or has an error, or the watchdog has bitten.")
        self.ev.finalize()  # its registers are there from here on

        # # #

        # The region begins where the SoC puts it: the core looks at the lowest eight bits.
        addresses = {"i_s_axil_awaddr": self.bus.aw.addr[:8], "i_s_axil_araddr": self.bus.ar.addr[:8]}
        irq = Signal()
        self.comb += self.ev.core.trigger.eq(irq)
        self.specials += Instance(
            "kage_axi",
            **{f"p_{name}": value for name, value in dataclasses.asdict(self.config).items()},
            i_aclk=ClockSignal(),
            i_aresetn=~ResetSignal(),
            i_s_axis_tvalid=self.sink.valid,
            o_s_axis_tready=self.sink.ready,
            i_s_axis_tdata=self.sink.data,
            i_s_axis_tlast=self.sink.last,
            o_m_axis_tvalid=self.source.valid,
            i_m_axis_tready=self.source.ready,
            o_m_axis_tdata=self.source.data,
            o_m_axis_tuser=self.source.first,
            o_m_axis_tlast=self.source.last,
            **addresses,
            i_s_axil_awvalid=self.bus.aw.valid,
            o_s_axil_awready=self.bus.aw.ready,
            i_s_axil_wvalid=self.bus.w.valid,
            o_s_axil_wready=self.bus.w.ready,
            i_s_axil_wdata=self.bus.w.data,
            i_s_axil_wstrb=self.bus.w.strb,
            o_s_axil_bvalid=self.bus.b.valid,
            i_s_axil_bready=self.bus.b.ready,
            o_s_axil_bresp=self.bus.b.resp,
            i_s_axil_arvalid=self.bus.ar.valid,
            o_s_axil_arready=self.bus.ar.ready,
            o_s_axil_rvalid=self.bus.r.valid,
            i_s_axil_rready=self.bus.r.ready,
            o_s_axil_rdata=self.bus.r.data,
            o_s_axil_rresp=self.bus.r.resp,
            o_irq=irq,
        )
        platform.add_verilog_include_path(str(rtl / "include"))
        for path in (*sorted(rtl.glob("*.sv")), rtl / "kage_axi.v"):
            platform.add_source(str(path))
