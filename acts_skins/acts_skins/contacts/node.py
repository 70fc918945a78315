# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `skin_contacts`: merges the contacts of all skins of a file, in one frame, into one message."""

from __future__ import annotations

import time
from collections import Counter, deque
from dataclasses import dataclass, replace
from math import ceil
from typing import Any

from acts_core.errors import ActsError, PacketError
from acts_core.settings import setting
from acts_core.words import counted
from acts_msgs.msg import SkinContact, SkinContacts
from acts_msgs.msg import SkinState as StateMessage
from acts_ros import qos
from acts_ros.diagnostics import OK, WARN, DiagnosticsReporter, Report
from acts_ros.messages import header_of, message_of, set_stamp
from acts_ros.parameters import declare, node_options
from acts_ros.polled import PollingNode
from acts_ros.publishers import published
from acts_skins.contacts.alignment import Aligned, AlignedSkin, Aligner, AlignmentConfig, Counters, SkinState
from acts_skins.contacts.fixed_rate_thread import FixedRateThread
from acts_skins.contacts.messages import CONTACT_TYPES, skin_contact, touches
from acts_skins.contacts.placing import Placement, Touch
from acts_skins.skins_file import skins_of

_FRAMES_HZ = 1000.0
# Queues hold the frames of this many cycles, and at least this many frames, in case the node is delayed.
_CYCLES_KEPT = 4
_FRAMES_KEPT = 64
# About 250 contacts, far more than a skin tracks; reading more would delay the other skins.
_LARGEST_BYTES = 65536
_LONGEST_NAME = 64
_FOREIGN = "in another frame"
# Of a skin, in a second.
_CHANGES_TOLD = 4


@dataclass(frozen=True)
class SkinContactsSettings(AlignmentConfig):
    """Parameters of the node."""

    skins_file: str = setting("", "YAML file that describes the skins; needed")
    base_frame: str = setting("", "frame of the merged contacts; empty or none: base_frame of the skins file")
    rate_hz: float = setting(100.0, "how often the merged contacts are published [Hz]", minimum=1.0, maximum=1000.0)
    topic: str = setting(
        "contacts",
        "topic of each skin that is merged: contacts (tracked, with numbers), or contact (all pressure as one)",
        choices=tuple(CONTACT_TYPES),
    )


class SkinContactsNode(PollingNode):
    """Connects topics with `Aligner` and `Placement`.

    Reads ``SKIN/contacts`` (acts_msgs/Contacts) of every skin when a cycle is due, and publishes ``skin_contacts``
    (acts_msgs/SkinContacts).
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("skin_contacts", **node_options(), **options)
        settings = declare(self, SkinContactsSettings)
        skins_file = skins_of(settings.skins_file)
        base_frame = skins_file.merged_in(settings.base_frame)
        self._base_frame = base_frame
        self._links = {skin.name: skin.pose.parent for skin in skins_file.skins}
        self._placements = {name: Placement(pose) for name, pose in skins_file.in_base(base_frame).items()}
        self._aligner: Aligner[bytes] = Aligner(list(self._placements), settings)
        depth = max(_FRAMES_KEPT, ceil(_CYCLES_KEPT * _FRAMES_HZ / settings.rate_hz))
        self._kind = CONTACT_TYPES[settings.topic]
        self._subscriptions_of = {
            name: self.create_raw_polled_subscription(self._kind, f"{name}/{settings.topic}", qos.STREAM, depth=depth)
            for name in self._placements
        }
        self._publisher = self.create_publisher(SkinContacts, "skin_contacts", **published(qos.STREAM))
        self._clock = self.get_clock()
        self._there: set[str] = set()
        self._told_s: dict[str, deque[float]] = {}
        self._refused: Counter[tuple[str, str]] = Counter()
        self._foreign_frames: dict[str, str] = {}
        self._aligned: Aligned[bytes] | None = None
        self._thread = FixedRateThread(settings.rate_hz, self._step)
        self._reported: tuple[float, int, int, Counter[tuple[str, str]]] = (time.monotonic(), 0, 0, Counter())
        self._received_before = {name: Counters() for name in self._placements}
        self._diagnostics = DiagnosticsReporter(
            self,
            str(skins_file.path),
            self._report,
            only_publishers=[contacts.topic_name for contacts in self._subscriptions_of.values()],
        )

    def begin(self) -> None:
        """Start merging."""
        self._thread.start()

    def close(self) -> None:
        """Stop merging."""
        self._thread.stop()

    def _step(self) -> None:
        now_ns = self._clock.now().nanoseconds
        for name, subscription in self._subscriptions_of.items():
            for data, _ in subscription.take_all():
                if len(data) > _LARGEST_BYTES:
                    self._refused[name, f"in messages of more than {_LARGEST_BYTES} bytes"] += 1
                    continue
                try:
                    stamp_ns, frame_id = header_of(data)
                except PacketError:
                    self._refused[name, "without a header"] += 1
                    continue
                if frame_id != name:
                    # The file does not give the pose of this frame.
                    self._foreign_frames[name] = frame_id[:_LONGEST_NAME]
                    self._refused[name, _FOREIGN] += 1
                    continue
                self._aligner.take(name, stamp_ns, data, now_ns)
        aligned = self._aligner.step(now_ns)
        read = [self._read(skin) for skin in aligned.skins]
        aligned = replace(aligned, skins=tuple(skin for skin, _ in read))
        self._publisher.publish(self._message(aligned, [touched for _, touched in read]))
        self._aligned = aligned
        self._tell_changes(aligned)

    def _message(self, aligned: Aligned[bytes], touched: list[list[Touch]]) -> SkinContacts:
        message = SkinContacts()
        message.header.frame_id = self._base_frame
        set_stamp(message.header.stamp, aligned.time_ns)
        skins: list[StateMessage] = []
        contacts: list[SkinContact] = []
        for skin, touches_of_skin in zip(aligned.skins, touched, strict=True):
            state = StateMessage(name=skin.name, state=skin.state.value, age=skin.age_s)
            if skin.stamp_ns is not None:
                set_stamp(state.stamp, skin.stamp_ns)
                for touch in touches_of_skin:
                    placed = self._placements[skin.name].place(touch)
                    contacts.append(skin_contact(skin.name, self._links[skin.name], placed))
                    state.contacts += 1
            skins.append(state)
        message.skins, message.contacts = skins, contacts
        return message

    def _read(self, skin: AlignedSkin[bytes]) -> tuple[AlignedSkin[bytes], list[Touch]]:
        """A skin and its contacts; lost where none of these can be used: without contacts it would be untouched."""
        if skin.frame is None:
            return skin, []
        lost = replace(skin, state=SkinState.LOST, stamp_ns=None, age_s=0.0, frame=None)
        try:
            found = touches(message_of(skin.frame, self._kind))
        except PacketError:
            self._refused[skin.name, "that cannot be read"] += 1
            return lost, []
        possible = [touch for touch in found if touch.can_be()]
        if len(possible) < len(found):
            self._refused[skin.name, "with impossible values"] += len(found) - len(possible)
        return (skin, possible) if possible or not found else (lost, [])

    def _tell_changes(self, aligned: Aligned[bytes]) -> None:
        """Log which skins are lost or there again; a few times a second, since that may change with each frame."""
        now_s = time.monotonic()
        for skin in aligned.skins:
            is_there = skin.state is SkinState.FRESH
            if skin.state is SkinState.STALE or is_there == (skin.name in self._there):
                continue
            told_s = self._told_s.setdefault(skin.name, deque(maxlen=_CHANGES_TOLD))
            if len(told_s) == _CHANGES_TOLD and now_s - told_s[0] < 1.0:
                continue
            told_s.append(now_s)
            if is_there:
                self._there.add(skin.name)
                self.get_logger().info(f"skin {skin.name}: there")
            else:
                self._there.remove(skin.name)
                self.get_logger().warning(f"skin {skin.name}: lost")

    def _why(self, skin: AlignedSkin[bytes], counters: Counters) -> str:
        """Why a skin is stale or lost, by what came of it since the last report."""
        before = self._received_before[skin.name]
        if skin.silent_s is not None and skin.silent_s <= skin.stale_after_s:
            return "its newest contacts cannot be used"
        if counters.frames > before.frames and counters.late_s > skin.stale_after_s:
            return (
                f"its contacts are {counters.late_s:.3g} s old when they come: its clock lies behind "
                f"{self._clock_name()}, or a machine has too little CPU"
            )
        silence = "no contacts yet" if skin.silent_s is None else f"no contacts for {skin.silent_s:.3g} s"
        if counters.future > before.future:
            return f"{silence}, stamps lie {counters.ahead_s:.3g} s ahead of {self._clock_name()}"
        return silence

    def _clock_name(self) -> str:
        return "simulated time (use_sim_time)" if self.get_parameter("use_sim_time").value else "this clock"

    def _report(self) -> Report:
        if self._thread.failure is not None:
            raise ActsError(f"merging has stopped: {self._thread.failure!r}")
        now_s, refused = time.monotonic(), Counter(self._refused)
        before_s, cycles_before, missed_before, refused_before = self._reported
        cycles, missed = self._thread.cycles, self._thread.missed
        self._reported = (now_s, cycles, missed, refused)
        values: dict[str, object] = {
            "rate_hz": (cycles - cycles_before) / max(now_s - before_s, 1e-9),
            "missed_cycles": missed,
            "clock_resets": self._aligner.clock_resets,
        }
        troubles = []
        aligned = self._aligned
        for skin in aligned.skins if aligned is not None else ():
            counters = self._aligner.counters[skin.name]
            values[f"{skin.name}.state"] = skin.state.name.lower()
            values[f"{skin.name}.age_s"] = skin.age_s
            values[f"{skin.name}.frames"] = counters.frames
            values[f"{skin.name}.future"] = counters.future
            values[f"{skin.name}.out_of_order"] = counters.out_of_order
            if skin.state is not SkinState.FRESH:
                troubles.append(f"{skin.name} is {skin.state.name.lower()}: {self._why(skin, counters)}")
            self._received_before[skin.name] = replace(counters)
        for (name, why), number in (refused - refused_before).items():
            shown = f"in the frame {self._foreign_frames[name]!r}" if why is _FOREIGN else why
            troubles.append(f"{counted(number, 'contact')} of {name} {shown} dropped")
        if missed > missed_before:
            troubles.append(f"{counted(missed - missed_before, 'cycle')} missed")
        if troubles:
            return WARN, "; ".join(troubles), values
        return OK, f"{counted(len(self._placements), 'skin')} in {self._base_frame}", values
