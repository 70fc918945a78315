# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node reconstruction in a ROS domain, and a node beside it that samples and listens."""

from array import array
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from builtin_interfaces.msg import Duration, Time
from diagnostic_msgs.msg import DiagnosticArray
from numpy.typing import NDArray
from peers import Peers
from std_msgs.msg import Header

from acts_core.frames import SampleFrame, Scheme
from acts_msgs.msg import Contact, TactileSamples
from acts_recon.nodes.frame_publisher import FramePublisher
from acts_recon.nodes.reconstruction_node import ReconstructionNode
from acts_ros import qos

Publisher = TypeVar("Publisher", bound=FramePublisher)

DEADLINE_S = 30.0
FIRST_NS = 1_700_000_000_000_000_000
EVERYWHERE = np.arange(1024, dtype=np.uint16)


def timed(time_ms: int) -> dict[str, Any]:
    """Stamp and duration of a frame of 55 samples."""
    header = Header(frame_id="plate", stamp=Time(sec=100 + time_ms // 1000, nanosec=time_ms % 1000 * 1_000_000))
    return {"header": header, "duration": Duration(nanosec=983_235)}


def publisher_of(node: ReconstructionNode, kind: type[Publisher]) -> Publisher:
    """The publisher of a kind that the node has."""
    return next(one for one in node._parts if isinstance(one, kind))


class Listener(Peers):
    """Keeps all that it hears; in namespace /plate where nothing else is said."""

    def __init__(self, domain_id: int, namespace: str = "/plate") -> None:
        super().__init__(domain_id, namespace=namespace)
        self.received: dict[str, list[Any]] = {}

    def listen(self, kind: type, topic: str, profile: Any) -> list[Any]:
        """Keep what comes on a topic; returns when somebody publishes it."""
        messages = self.received.setdefault(topic, [])
        subscription = self.peer.create_subscription(kind, topic, messages.append, profile)
        self.until(lambda: subscription.get_publisher_count() > 0)
        return messages


class Bench(Listener):
    """The node in namespace /plate, and a node beside it that publishes samples and keeps what comes back."""

    def __init__(self, domain_id: int, dictionary_path: Path, parameters: dict[str, object]) -> None:
        super().__init__(domain_id)
        own = {"dictionary": dictionary_path} if parameters.get("method") == "per_frame" else {}
        words = [f"{name}:={value}" for name, value in {**own, **parameters}.items()]
        arguments = ["--ros-args", *(part for word in words for part in ("-p", word))]
        with ExitStack() as on_failure:
            on_failure.callback(self.close)
            self.node = self.add(ReconstructionNode(cli_args=arguments, context=self.context, namespace="/plate"))
            on_failure.pop_all()
        self.publisher = self.peer.create_publisher(TactileSamples, "samples", qos.STREAM)
        self.listen(Contact, "contact", qos.STREAM)
        # From the start: of some things only one report tells.
        self.listen(DiagnosticArray, "/diagnostics", 10)
        self.until(lambda: self.publisher.get_subscription_count() == 1)
        self.until(lambda: self.node.count_subscribers("contact") == 1)
        self.until(lambda: self.node.count_subscribers("/diagnostics") == 1)

    def send(self, sequence: int, indices: NDArray, counts: NDArray, **fields: Any) -> None:
        """Publish a frame, and wait until the node has taken or refused it: it leaves out frames that wait for long."""
        before = self._frames_taken
        self.post(sequence, indices, counts, **fields)
        self.until(lambda: self._frames_taken > before)

    @property
    def _frames_taken(self) -> int:
        return self.node._frames + self.node._unused + sum(self.node._rejected.values())

    def post(self, sequence: int, indices: NDArray, counts: NDArray, **fields: Any) -> None:
        """Publish a frame."""
        message = TactileSamples(sequence=sequence, rows=32, cols=32, scheme=TactileSamples.SCHEME_ADAPTIVE)
        message.header.frame_id = "plate"
        message.header.stamp.sec = 100 + sequence % 1000
        message.header.stamp.nanosec = 7
        message.indices = array("H", indices.astype(np.uint16).tobytes())
        message.counts = array("H", counts.astype(np.uint16).tobytes())
        for name, value in fields.items():
            setattr(message, name, value)
        self.publisher.publish(message)

    def take(self, sequence: int, counts: NDArray, set_by_ns: int = 0) -> None:
        """Hand the node the counts (32, 32) of all taxels, a thousand frames a second from `FIRST_NS` on, at once.

        By a clock that was set meanwhile by so much [ns].
        """
        taken = np.rint(counts.ravel()).astype(np.uint16)
        frame = SampleFrame(sequence, 1000 * sequence, 1, Scheme.RASTER, 32, 32, 0, EVERYWHERE, taken)
        self.node.take([(frame, FIRST_NS + 1_000_000 * sequence + set_by_ns)], "plate")

    def contact(self, sequence: int) -> Contact:
        """Wait for the contact of one frame."""
        self.until(lambda: any(message.sequence == sequence for message in self.received["contact"]))
        return next(message for message in self.received["contact"] if message.sequence == sequence)

    def diagnostics(self, condition: Callable[[Any, dict[str, str]], bool]) -> None:
        """Wait until a status of the node, from its start on, fulfils the condition."""

        def holds() -> bool:
            statuses = [status for message in self.received["/diagnostics"] for status in message.status]
            mine = [status for status in statuses if status.name == "plate/reconstruction"]
            return any(condition(status, {value.key: value.value for value in status.values}) for status in mine)

        self.until(holds)
