# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Node ``reconstruction``: samples in; full images and the contact in them out, as fast as the samples come.

Topics: samples and baseline in; contact, contacts, impacts, spectra, outlines, regions, cop, image_raw, image,
confidence, object and view/* out.
"""

from __future__ import annotations

import time
from collections import Counter, defaultdict, deque
from collections.abc import Sequence
from operator import sub
from statistics import median
from typing import NamedTuple

from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from std_msgs.msg import Header

from acts_core.errors import ArrayError, PacketError
from acts_core.frames import SampleFrame
from acts_core.kernels import skip_extras
from acts_core.runtime import LateFrames, Pace, RateLimit, Use, enter_realtime
from acts_core.stop_signals import StopSignals
from acts_core.words import counted
from acts_msgs.msg import Baseline, TactileSamples
from acts_msgs.msg import Contact as ContactMessage
from acts_recon.frame_pipeline import ArraySizeError, FramePipeline, RepeatedFrameError
from acts_recon.nodes.contacts_publisher import ContactsPublisher
from acts_recon.nodes.frame_publisher import FramePublisher, RecoveredFrame
from acts_recon.nodes.images_publisher import ImagesPublisher
from acts_recon.nodes.impacts_publisher import ImpactsPublisher
from acts_recon.nodes.object_publisher import ObjectPublisher
from acts_recon.nodes.outlines_publisher import OutlinesPublisher
from acts_recon.nodes.regions_publisher import RegionsPublisher
from acts_recon.nodes.spectra_publisher import SpectraPublisher
from acts_recon.settings import ReconstructionConfig, ReconstructionSettings
from acts_ros import qos
from acts_ros.clocks import steady_timer
from acts_ros.composition import run_nodes
from acts_ros.diagnostics import OK, WARN, DiagnosticsReporter, Report
from acts_ros.executor import call_soon
from acts_ros.log import log_of
from acts_ros.messages import ContactFields, baseline_of, frame_of, set_stamp, stamp_ns_of, write_contact
from acts_ros.parameters import declare, node_options
from acts_ros.polled import PolledSubscription
from acts_ros.publishers import published

_COMPILING = "compiling: this takes long the first time on a machine, and with another kind of skin"
_SUBSCRIBERS_PERIOD_S = 0.2
# Of each kind, so that one that comes often hides no other.
_REJECTED_TOLD_HZ = 0.2
# More often no board begins anew between two reports.
_MOST_RESTARTS = 2


class _Counts(NamedTuple):
    """What a report tells the new ones of, since the start."""

    frames: int = 0
    rejected: int = 0
    lost: int = 0
    untold: int = 0
    source_changes: int = 0
    restarts: int = 0

    def since(self, before: _Counts) -> _Counts:
        return _Counts(*map(sub, self, before))


class ReconstructionNode(Node):
    """Translates between topics and a `FramePipeline`.

    Subscribes ``samples`` (acts_msgs/TactileSamples), or takes frames by `take` from a driver in the same process.
    Publishes for every frame ``contact`` (acts_msgs/Contact), while in contact ``cop`` (geometry_msgs/PointStamped),
    and where somebody listens images (see `ImagesPublisher`), ``contacts`` and ``view/contacts`` (acts_msgs/Contacts),
    as far as the parameters offer them ``impacts`` (acts_msgs/Impact), ``spectra`` (acts_msgs/Spectrum) and
    ``outlines`` (acts_msgs/Outline), with a layout of several patches, or of one on a link, ``regions``
    (acts_msgs/RegionContacts), and, with an object library, ``object`` and ``view/object`` (acts_msgs/ObjectClass).

    Parameters
    ----------
    subscribes : bool
        Whether frames come as messages; otherwise somebody calls `take`.
    """

    def __init__(self, *, subscribes: bool = True, cli_args: Sequence[str] | None = None, **options: object) -> None:
        super().__init__("reconstruction", cli_args=cli_args, **node_options(), **options)
        self._settings: ReconstructionConfig = declare(self, ReconstructionSettings, self._change)
        if self._settings.unused:
            self.get_logger().warning(f"{', '.join(self._settings.unused)}: not used by method {self._settings.method}")
        self.get_logger().info(_COMPILING)
        only = ["contact", "contacts", "regions"]
        only += (["samples"] if subscribes else []) + (["baseline"] if self._settings.subtract_baseline else [])
        self._diagnostics = DiagnosticsReporter(
            self, self.resolve_topic_name("samples"), self._report, only_publishers=only
        )
        with self._diagnostics.busy(_COMPILING):
            self._pipeline = FramePipeline(self._settings, self._forget)
            self._recovery = self._pipeline.recovery
            self._parts = self._make_parts()
        self._contact_publisher = self.create_publisher(ContactMessage, "contact", **published(qos.STREAM))
        self._cop_publisher = self.create_publisher(PointStamped, "cop", **published(qos.STREAM))
        # Filled anew for every frame: making messages costs more than sending them.
        self._header = Header()
        self._cop = PointStamped()
        self._view_limit = RateLimit(self._settings.image_rate_hz)
        self._viewed: list[str] = []

        self._frames = 0
        self._untold = 0
        self._unused = 0
        self._late = LateFrames()
        self._rejected: Counter[str] = Counter()
        self._rejected_due: defaultdict[str, RateLimit] = defaultdict(lambda: RateLimit(_REJECTED_TOLD_HZ))
        self._durations_s: deque[float] = deque(maxlen=1000)
        self._reported, self._reported_s = _Counts(), time.monotonic()
        self._pace = Pace()

        self._look_for_subscribers()
        steady_timer(self, _SUBSCRIBERS_PERIOD_S, self._look_for_subscribers)
        if self._settings.subtract_baseline:
            self.create_subscription(Baseline, "baseline", self._on_baseline, **qos.overridable(qos.LATCHED))
        # Messages that are recovered after all that the executor has to do, with the times of their reception [ns].
        self._held: list[tuple[TactileSamples, int]] = []
        self._is_behind = False
        if subscribes:
            self._waiting: PolledSubscription[TactileSamples] = PolledSubscription(
                self.create_subscription(TactileSamples, "samples", self._on_samples, **qos.overridable(qos.STREAM))
            )
        rows, cols = self._recovery.image.shape
        self.get_logger().info(
            f"ready: array of {self._settings.rows} x {self._settings.cols}, image of {rows} x {cols}"
        )

    def begin(self) -> None:
        """Let this process be scheduled as the parameters ask."""
        enter_realtime(self._settings, "reconstruction", log_of(self))

    def _change(self, settings: ReconstructionConfig) -> str:
        """Put changed parameters in force."""
        self._settings = settings
        self._view_limit.set_rate(settings.image_rate_hz)
        for part in self._parts:
            part.set_rates(settings)
        return ""

    def _make_parts(self) -> list[FramePublisher]:
        """Those that the settings offer, in the order in which they publish."""
        settings, recovery = self._settings, self._recovery
        made: list[FramePublisher] = []
        regions = settings.regions(recovery)
        if regions is not None:
            made.append(RegionsPublisher(self, settings, recovery, regions))
        made += [ImagesPublisher(self, settings, recovery), ContactsPublisher(self, settings, recovery)]
        if settings.impacts:
            made.append(ImpactsPublisher(self, settings, recovery))
        if settings.spectra:
            made.append(SpectraPublisher(self, settings, recovery))
        if settings.outlines:
            made.append(OutlinesPublisher(self, settings, recovery))
        recogniser = settings.recogniser(recovery)
        if recogniser is not None:
            made.append(ObjectPublisher(self, settings, recogniser))
        return made

    def _look_for_subscribers(self) -> None:
        self._send_cop = self._cop_publisher.get_subscription_count() > 0
        for part in self._parts:
            part.look_for_subscribers()
        self._viewed = [topic for part in self._parts for topic in part.viewed]
        # Often nobody listens to any, and asking each of them for every frame takes long.
        self._is_more_wanted = self._send_cop or any(part.is_wanted for part in self._parts)

    def _on_samples(self, samples: TactileSamples) -> None:
        # With those that have come meanwhile: one by one, all that waits would be as late as the queue is long.
        waiting = self._waiting.take_all()
        # It came no later than the next, whose reception is known.
        held = [(samples, waiting[0][1] if waiting else time.time_ns()), *waiting]
        if not self._is_behind:
            self._take_held(held)
            return
        # The events executor calls back once for each message, also where it was taken with another. If each call
        # recovered frames, more calls would come than end, and timers and services would wait longer and longer.
        if not self._held:
            call_soon(self, lambda: self._take_held(self._held))
        self._held += held

    def _take_held(self, received: list[tuple[TactileSamples, int]]) -> None:
        """Recover messages that have come together, each with the time at which it was received [ns]."""
        now_ns = time.time_ns()
        self._held = []
        self._is_behind = len(received) > 1
        frames = []
        for message, received_ns in received:
            try:
                # How long it has waited here: its stamp may be of a recording that is played.
                frames.append((frame_of(message), stamp_ns_of(message), now_ns - received_ns, message.header.frame_id))
            except PacketError as error:
                self._reject("bad_stamp", f"samples dropped: {error}")
        for number, of_frame in enumerate(frames, start=1):
            self._take(*of_frame, is_newest=number == len(frames))

    def take(self, frames: Sequence[tuple[SampleFrame, int]], frame_id: str) -> None:
        """Recover frames that have come together, and publish what is in them; always from the same thread.

        Of those that are late not all are published or even recovered (see `LateFrames`), but the newest always is.
        With too little CPU touch becomes rare, but not old.

        Parameters
        ----------
        frames : sequence of (SampleFrame, int)
            At least one, each with the ROS time at the end of its last measurement [ns].
        frame_id : str
            Frame of the skin.
        """
        now_ns = time.time_ns()
        for number, (frame, stamp_ns) in enumerate(frames, start=1):
            self._take(frame, stamp_ns, now_ns - stamp_ns, frame_id, is_newest=number == len(frames))

    def _take(self, frame: SampleFrame, stamp_ns: int, age_ns: int, frame_id: str, *, is_newest: bool) -> None:
        """One of them, with its age [ns], however that is known."""
        began_s = time.perf_counter()
        use = self._late.use(age_ns)
        is_told = use is Use.PUBLISH or is_newest
        is_used = is_told or use is Use.RECOVER
        self._untold += not is_told
        self._unused += not is_used
        try:
            if not is_used:
                self._pipeline.count(frame)
                return
            self._pipeline.step(frame, stamp_ns)
        except ArraySizeError as error:
            self._reject("wrong_array_size", f"samples dropped: {error} by the parameters rows and cols")
            return
        except RepeatedFrameError as error:
            self._reject("repeated", f"samples dropped: {error}")
            return
        except ArrayError as error:
            self._reject("bad_frame", f"samples dropped: {error}")
            return
        self._frames += 1
        if is_told:
            self._publish(stamp_ns, frame_id)
            self._durations_s.append(time.perf_counter() - began_s)

    def _publish(self, stamp_ns: int, frame_id: str) -> None:
        """Publish what has been found in the newest frame."""
        once, every, contact = self._pipeline.frame, self._pipeline.every, self._pipeline.contact
        assert once is not None
        assert every is not None
        fields = ContactFields(stamp_ns, frame_id, once.sequence, *contact)
        self._contact_publisher.publish(write_contact(fields))
        if not self._is_more_wanted:
            return
        header = self._header
        header.frame_id = frame_id
        set_stamp(header.stamp, stamp_ns)
        if self._send_cop and contact.in_contact:
            self._cop.header = header
            self._cop.point.x, self._cop.point.y = contact.x_m, contact.y_m
            self._cop_publisher.publish(self._cop)
        due = self._viewed if self._viewed and self._view_limit.due(time.monotonic()) else ()
        frame = RecoveredFrame(header, stamp_ns, once, every, contact, due)
        for part in self._parts:
            if part.is_wanted:
                part.publish(frame)

    def _on_baseline(self, message: Baseline) -> None:
        try:
            self._pipeline.set_baseline(*baseline_of(message, *self._pipeline.size))
        except ArrayError as error:
            self._reject("bad_baseline", f"baseline not used: {error}")

    def _forget(self) -> None:
        """Forget what is kept of all frames: the board of the next one counts from the start again."""
        for part in self._parts:
            part.reset()

    def _reject(self, kind: str, sentence: str) -> None:
        self._rejected[kind] += 1
        if self._rejected_due[kind].due(time.monotonic()):
            self.get_logger().warning(sentence)

    def _report(self) -> Report:
        now_s = time.monotonic()
        pipeline = self._pipeline
        counts = _Counts(
            self._frames,
            self._rejected.total(),
            pipeline.lost,
            self._untold,
            pipeline.source_changes,
            pipeline.restarts,
        )
        new, passed_s = counts.since(self._reported), now_s - self._reported_s
        self._reported, self._reported_s = counts, now_s
        if new.frames:
            self._pace.step(now_s, new.frames)
        rate_hz = new.frames / max(passed_s, 1e-9)
        durations_s = list(self._durations_s)
        self._durations_s.clear()
        level, words = self._judge(new, rate_hz, now_s)
        values = {
            "rate_hz": rate_hz,
            "frames": counts.frames,
            "lost": counts.lost,
            "source_changes": counts.source_changes,
            "restarts": counts.restarts,
            "rejected.wrong_array_size": self._rejected["wrong_array_size"],
            "rejected.bad_frame": self._rejected["bad_frame"],
            "rejected.repeated": self._rejected["repeated"],
            "rejected.bad_stamp": self._rejected["bad_stamp"],
            "rejected.bad_baseline": self._rejected["bad_baseline"],
            "not_published": counts.untold,
            "not_used": self._unused,
            "baseline": "subtracted" if self._pipeline.subtracts else "none",
            "dead_taxels": self._settings.dead_taxels or "none",
            "frame_us.median": 1e6 * median(durations_s) if durations_s else 0.0,
        }
        return level, words, values

    def _judge(self, new: _Counts, rate_hz: float, now_s: float) -> tuple[int, str]:
        """Level and sentence for what is new since the last report; of several warnings the first cause."""
        if new.rejected:
            words = counted(new.rejected, "message dropped that does not fit", "messages dropped that do not fit")
            return WARN, f"{words}, see the log"
        # Of a slow board's frames none may fall into the time since the last report.
        if not new.frames and self._pace.is_silent(now_s):
            return WARN, "no samples"
        if new.source_changes > 0:
            words = "frames of two sources come in turn, and each change is taken for another board: end all but one"
            return WARN, f"{words} that publishes {self.resolve_topic_name('samples')}"
        # Each frame is then recovered alone: what it has not measured is taken for untouched.
        if new.restarts > _MOST_RESTARTS:
            words = f"{counted(new.restarts, 'frame')} with a number that is not above that of the frame before, each"
            return WARN, f"{words} taken for a board that begins anew: needed are numbers that count the frames"
        # What came after all was counted before.
        if new.lost > 0:
            words = counted(new.lost, "frame lost before it came here", "frames lost before they came here")
            return WARN, f"{words}, {rate_hz:.0f} frames/s"
        if new.untold:
            left_out = "contact left out because its frame", "contacts left out because their frames"
            words = f"{counted(new.untold, *left_out)} came late, {rate_hz:.0f} frames/s"
            return WARN, f"{words}: this machine is too slow or too busy (acts doctor tells)"
        return OK, f"{rate_hz:.0f} frames/s"


SETTINGS: dict[str, type] = {"reconstruction": ReconstructionSettings}
"""The settings class of the node, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node; the exit code."""
    skip_extras()
    return run_nodes({"reconstruction": ReconstructionNode}, SETTINGS, signals, args)
