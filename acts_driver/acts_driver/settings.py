# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Parameters of the driver."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from acts_core.array import MAX_SIDE
from acts_core.runtime import RealtimeConfig
from acts_core.settings import Changeable, default_of, describe, is_given, refuse_doubles, setting
from acts_core.skin import dead_taxels_named
from acts_driver.baseline import BaselineConfig, BaselineParameters
from acts_driver.board import BoardParameters
from acts_driver.port import SerialSource, Source, check_port
from acts_driver.protocols import PROTOCOLS, Decoder, OnMessage
from acts_driver.replay import ReplayOptions, ReplaySource, open_recording


@dataclass(frozen=True)
class SourceParameters:
    """Parameters about where frames come from."""

    port: str = setting(
        "auto",
        "serial port of the board: a path, auto (the only Teensy), or serial:NUMBER (its USB serial number)",
        changeable=Changeable.UNCONFIGURED,
    )
    protocol: str = setting(
        "binary",
        "what the board speaks: " + " or ".join(f"{name} ({kind.of})" for name, kind in PROTOCOLS.items()),
        choices=tuple(PROTOCOLS),
        changeable=Changeable.UNCONFIGURED,
    )
    frame_id: str = setting(
        "", "frame of the skin in all messages; empty or none: the name of the namespace, with _ for /"
    )
    rows: int = setting(
        32,
        "rows of the array; frames of another size are dropped",
        minimum=1,
        maximum=MAX_SIDE,
        changeable=Changeable.UNCONFIGURED,
    )
    cols: int = setting(
        32,
        "columns of the array; frames of another size are dropped",
        minimum=1,
        maximum=MAX_SIDE,
        changeable=Changeable.UNCONFIGURED,
    )
    # Below 1200 some boards take the speed as the order to enter their boot loader (134 on a Teensy).
    baud: int = setting(
        115200,
        "bits per second; of no effect on USB boards",
        minimum=2400,
        maximum=12_000_000,
        changeable=Changeable.UNCONFIGURED,
    )
    reconnect_s: float = setting(
        0.5, "longest wait between two attempts to open a missing port [s]", minimum=0.02, maximum=60.0
    )
    autostart: bool = setting(
        True, "configure and activate without being asked, waiting for the port where it is missing"
    )
    replay: str = setting(
        "",
        "recording to replay in place of a board: a bag (folder, .mcap, .db3) or an .npz file; empty or none: the port",
        changeable=Changeable.UNCONFIGURED,
    )
    replay_topic: str = setting(
        "", "topic of the bag; empty for its only one of type TactileSamples", changeable=Changeable.UNCONFIGURED
    )
    replay_speed: float = setting(
        1.0, "2 replays twice as fast", minimum=0.001, maximum=1000.0, changeable=Changeable.UNCONFIGURED
    )
    replay_loop: bool = setting(
        True, "start the recording over at its end; false: silence follows", changeable=Changeable.UNCONFIGURED
    )
    replay_delay_s: float = setting(
        1.0,
        "time from activation to the recording's first frame, for subscribers to come [s]",
        minimum=0.0,
        maximum=60.0,
        changeable=Changeable.UNCONFIGURED,
    )
    replay_frames_hz: float = setting(
        0.0,
        "frames per second of recorded full frames; 0: as the file says",
        minimum=0.0,
        maximum=1e6,
        changeable=Changeable.UNCONFIGURED,
    )


# A sampling scheme may bring settings of its own; its own parameter would silently take the place of one of ours.
refuse_doubles(RealtimeConfig, BaselineParameters, BoardParameters, SourceParameters)


@dataclass(frozen=True)
class DriverSettings(RealtimeConfig, BaselineParameters, BoardParameters, SourceParameters):
    """See the descriptions; `docs/driver.md` lists them."""

    def __post_init__(self) -> None:
        RealtimeConfig.__post_init__(self)
        check_port(self.port)
        self.check_board_parameters()
        dead_taxels_named(self.dead_taxels, self.rows, self.cols)  # refuses what are no taxels

    def baseline_config(self) -> BaselineConfig:
        """See `BaselineParameters.baseline_config`."""
        return replace(super().baseline_config(), dead_taxels=self.dead_taxels)

    @property
    def is_replay(self) -> bool:
        """Whether a recording stands in for the board."""
        return is_given(self.replay)

    @property
    def unused(self) -> tuple[str, ...]:
        """Parameters of a recording that were given while none is replayed."""
        names = [name for name in describe(SourceParameters) if name.startswith("replay_")]
        if self.is_replay:
            return ()
        return tuple(name for name in names if getattr(self, name) != default_of(SourceParameters, name))

    def make_source(self) -> Source:
        """Where bytes come from."""
        if not self.is_replay:
            return SerialSource(self.port, self.baud)
        options = ReplayOptions(
            Path(self.replay),
            self.replay_topic,
            self.replay_frames_hz,
            self.sampling,
            self.rate_cap_hz,
            self.skin_map,
        )
        return ReplaySource(
            f"recording {self.replay}",
            lambda: open_recording(options),
            speed=self.replay_speed,
            loop=self.replay_loop,
            delay_s=self.replay_delay_s,
        )

    @property
    def has_dialogue(self) -> bool:
        """Whether there is a board that may take commands."""
        return PROTOCOLS[self.protocol].takes_commands and not self.is_replay

    def make_decoder(self, on_message: OnMessage) -> Decoder:
        """The decoder of the protocol; a recording is replayed as binary. `on_message` as of `StreamDecoder`."""
        name = "binary" if self.is_replay else self.protocol
        return PROTOCOLS[name].decoder(self.rows, self.cols, on_message)
