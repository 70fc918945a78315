# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Node ``view``: a page in the browser that shows what skins feel. It only listens, unless `control` lets pages ask.

While no page is open it subscribes to no skin, so that nothing is computed for it.
"""

from __future__ import annotations

import threading
import time
import traceback
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters
from rclpy.client import Client
from rclpy.task import Future

from acts_core.errors import ArrayError
from acts_core.words import counted
from acts_ros.clocks import steady_timer
from acts_ros.diagnostics import OK, WARN, DiagnosticsReporter, Report
from acts_ros.executor import call_soon, call_when_done
from acts_ros.log import STEADY, log_of
from acts_ros.middleware import NotAskedError, ask
from acts_ros.parameters import declare, node_options
from acts_ros.polled import PollingNode
from acts_ros.publishers import OnlyPublishers
from acts_view.nodes.control import Control
from acts_view.nodes.skin_topics import SkinTopics
from acts_view.recording.recording import Feed, Recording
from acts_view.settings import ViewSettings
from acts_view.skin.snapshot import SkinShape
from acts_view.web.pace import Pace
from acts_view.web.server import ViewServer

if TYPE_CHECKING:
    from acts_view.recording.bounded_bag import BoundedBag

_LOOK_PERIOD_S = 1.0
_SEARCH_PERIOD_S = 0.1
_DIAGNOSTICS_DEPTH = 100
_FORGET_NODE_S = 60.0
_TOLD_EVERY_S = 10.0
# What is shown at most: anybody in the domain can make up more.
_SKINS_MAX = 32
_NODES_MAX = 200
_VALUES_MAX = 100
_TEXT = 500
_ONLY_SHOWS = "This page only shows. With acts view --control it can also record, tare, and start and stop motion."
_MISSING = "nobody publishes touch of this skin: is its name right, and do its driver and its reconstruction run?"
_TOUCH_TOPICS = ("contact", "view/contact_series", "image_raw", "view/image_raw")
_CONTACT_TYPE = "acts_msgs/msg/Contact"
_CONTACT_TOPIC = "/contact"
_ONLY_TOPICS = ("samples", "contact")
# As SkinShape has them.
_FORCE_PARAMETERS = ("force_full_scale_counts", "force_dead_n", "force_half_n", "force_response")
_SHAPE_PARAMETERS = ("layout", "rows", "cols", "pitch_m", "row_pitch_m", "touch_counts", *_FORCE_PARAMETERS)


class ViewNode(PollingNode):
    """Shows skins on a page, see `ViewServer`.

    Subscribes of every skin ``regions``, ``hand/status``, ``joint_states``, ``ball/state``, ``ball/reference``,
    ``ball/status``, ``board_object``, and ``view/age``, ``view/image_raw``, ``view/confidence``, ``view/contacts``,
    ``view/object`` and ``view/contact_series``, or where they are not, those without ``view/`` and ``contact``; with
    `outlines` also ``outlines``; and ``/diagnostics``. Asks the node ``reconstruction`` beside them for its parameters.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("view", **node_options(), **options)
        self._settings = settings = declare(self, ViewSettings)
        self._skins: dict[str, SkinTopics] = {}
        # The executor's thread changes what is subscribed to, the server's takes what has come.
        self._lock = threading.Lock()
        self._asked: dict[str, tuple[Client, Future[Any] | None]] = {}
        # Skins of which somebody may have begun the reconstruction anew since it was asked last.
        self._begun_anew: set[str] = set()
        # As other names of a node: a launch file may have pushed a namespace around the skins and around this one.
        self._wanted = settings.namespaces(self.get_namespace())
        self._names = list(self._wanted)
        self._heard: dict[str, tuple[float, dict[str, Any]]] = {}
        self._only: dict[str, OnlyPublishers] = {}
        self._pages = 0
        self._recording = Recording(
            settings.record_folder,
            int(settings.record_max_mb * 1e6),
            lambda: tuple(self._names),
            self._feed,
            log_of(self),
        )
        self._control = Control(self, self._recording) if settings.control else None
        self._server = ViewServer(
            settings.host,
            settings.port,
            send_limit_s=settings.send_limit_s,
            on_clients=self._on_pages,
            log=log_of(self),
            on_request=None if self._control is None else self._control.take,
            find_file=None if self._control is None else self._recording.file,
        )
        self.address = self._server.address
        self.create_subscription(DiagnosticArray, "/diagnostics", self._on_diagnostics, _DIAGNOSTICS_DEPTH)
        self._diagnostics = DiagnosticsReporter(self, self.address.url.partition("?")[0], self._report)
        # Not by a timer of the node: it costs more than what it would call.
        self._pace = Pace(1.0 / settings.rate_hz)
        self._server.every(1.0 / settings.rate_hz, self._show)
        steady_timer(self, _LOOK_PERIOD_S, self._look)
        # For the same reason it only runs while a page waits for the first skin.
        self._search = steady_timer(self, _SEARCH_PERIOD_S, self._begin_or_end)
        self._search.cancel()
        self.get_logger().info(f"open {self.address.url}")

    def close(self) -> None:
        """End the server, and what is being recorded."""
        self._server.close()
        self._recording.close()

    def _feed(self, _skins: Sequence[str], bag: BoundedBag) -> Feed:
        # Imported here, because it is slow to import and few record.
        from acts_view.nodes.graph_feed import GraphFeed

        return GraphFeed(self, self._recorded, bag)

    def _recorded(self) -> Sequence[str]:
        """The skins that there are, also those that appeared while no page is open."""
        if not self._wanted:
            self._find()
        return self._names

    def _on_pages(self, pages: int) -> None:
        """From the server's thread."""
        self._pages = pages
        call_soon(self, self._begin_or_end)

    def _show(self) -> float:
        """Show what is new; on the server's thread. How much later than a period from now to look again [s]."""
        with self._lock:
            for name, topics in self._skins.items():
                try:
                    taken = topics.take()
                    if taken is not None:
                        self._server.show_frame(name, *taken)
                except Exception:  # noqa: BLE001 - the page goes on showing the other skins
                    self.get_logger().error(
                        f"{name} cannot be shown: {traceback.format_exc()}",
                        throttle_duration_sec=_TOLD_EVERY_S,
                        throttle_time_source_type=STEADY,
                    )
            return self._pace.later_s(topics.image_waited_s for topics in self._skins.values())

    def _begin_or_end(self) -> None:
        """Begin with the first page, as soon as there is a skin, and end with the last one."""
        if not self._pages:
            self._leave()
        elif not self._skins:
            self._look()
        if self._pages and not self._skins:
            self._search.reset()
        else:
            self._search.cancel()

    def _look(self) -> None:
        """Now and then: which skins there are, what they are like, and what is said of all."""
        self._recording.step()
        if self._control is not None:
            self._control.step()
        self._forget()
        if not self._pages:
            return
        if not self._wanted:
            self._find()
        for name in self._names:
            if name in self._skins:
                with self._lock:
                    self._skins[name].look()
            else:
                # Making all subscriptions takes longest; it comes before the lock, for which the server's thread waits.
                made = SkinTopics(self, name, with_outlines=self._settings.outlines)
                with self._lock:
                    self._skins[name] = made
                # Nobody has looked while no page was open.
                self._begun_anew.add(name)
            self._ask_shape(name)
        told = {"note": _ONLY_SHOWS} if self._control is None else self._control.look()
        diagnostics = [*self._mixtures(), *self._missing(), *self._statuses()]
        self._server.show_status({"skins": self._names, "diagnostics": diagnostics, **told})

    def _leave(self) -> None:
        with self._lock:
            for name, topics in self._skins.items():
                topics.close()
                # What a controller has said may not be so any more when the next page is opened.
                if (frame := topics.without_tellers()) is not None:
                    self._server.show_frame(name, frame, [])
            self._skins.clear()

    def _find(self) -> None:
        for topic, kinds in self.get_topic_names_and_types():
            name = topic.removesuffix(_CONTACT_TOPIC)
            if _CONTACT_TYPE in kinds and name != topic and name not in self._names and len(self._names) < _SKINS_MAX:
                self._names.append(name)
        self._names.sort()

    def _ask_shape(self, name: str) -> None:
        if name not in self._asked:
            service = f"{name}/reconstruction/get_parameters"
            self._asked[name] = self.create_client(GetParameters, service), None
        client, asked = self._asked[name]
        if asked is not None and not asked.done():
            # Kept, questions that are never answered would add up.
            client.remove_pending_request(asked)
        if not client.service_is_ready():
            self._begun_anew.add(name)
        else:
            try:
                future = ask(client, GetParameters.Request(names=list(_SHAPE_PARAMETERS)))
            except NotAskedError:
                return  # the next look asks again
            call_when_done(self, future, lambda done: self._on_shape(name, done))
            self._asked[name] = client, future

    def _on_shape(self, name: str, done: Future[Any]) -> None:
        response = done.result()
        if response is None or len(response.values) != len(_SHAPE_PARAMETERS):
            return
        values = dict(zip(_SHAPE_PARAMETERS, map(_value, response.values), strict=True))
        if None in values.values():
            return
        try:
            self._server.show_shape(name, SkinShape(**values), is_begun_anew=name in self._begun_anew)
            self._begun_anew.discard(name)
        except ArrayError as error:
            self.get_logger().warning(f"{name}: {error}", throttle_duration_sec=10.0, throttle_time_source_type=STEADY)

    def _on_diagnostics(self, array: DiagnosticArray) -> None:
        now_s = time.monotonic()
        for status in array.status:
            name = self._name_of(status)
            if name in self._heard or len(self._heard) < _NODES_MAX:
                self._heard[name] = (now_s, _shown(status))

    def _name_of(self, status: DiagnosticStatus) -> str:
        """Of the node; of another view of this one's name, as of a launch file with view:=true, also its address."""
        name, about = status.name[:_TEXT], status.hardware_id[:_TEXT]
        is_own_name = name == self.get_fully_qualified_name().lstrip("/")
        return f"{name} ({about})" if is_own_name and about != self._diagnostics.hardware_id else name

    def _statuses(self) -> list[dict[str, Any]]:
        now_s = time.monotonic()
        return [
            {"name": name, "age_s": now_s - heard_s, **shown} for name, (heard_s, shown) in sorted(self._heard.items())
        ]

    def _mixtures(self) -> list[dict[str, Any]]:
        """Of skins that several nodes publish, so that the page shows a mixture, these nodes."""
        for name in self._names:
            self._only.setdefault(name, OnlyPublishers(self, [f"{name}/{topic}" for topic in _ONLY_TOPICS]))
        problems = {name: only.problem() for name, only in self._only.items()}
        return [
            {"name": name or "/", "level": WARN, "message": problem[:_TEXT], "age_s": 0.0, "values": []}
            for name, problem in problems.items()
            if problem
        ]

    def _missing(self) -> list[dict[str, Any]]:
        """Of skins that were asked for and that nobody publishes, that it is so."""
        return [
            {"name": name or "/", "level": WARN, "message": _MISSING, "age_s": 0.0, "values": []}
            for name in self._wanted
            if not any(self.count_publishers(f"{name}/{topic}") for topic in _TOUCH_TOPICS)
        ]

    def _forget(self) -> None:
        now_s = time.monotonic()
        self._heard = {name: one for name, one in self._heard.items() if now_s - one[0] < _FORGET_NODE_S}

    def _report(self) -> Report:
        return OK, f"{counted(self._pages, 'page')} open", {"pages": self._pages, "skins": ", ".join(self._skins)}


def _shown(status: DiagnosticStatus) -> dict[str, Any]:
    """What a page is told of a status; no more of it is kept, since anybody in the domain can send long ones."""
    return {
        "level": int.from_bytes(status.level, "little"),
        "message": status.message[:_TEXT],
        "values": [[value.key[:_TEXT], value.value[:_TEXT]] for value in status.values[:_VALUES_MAX]],
    }


def _value(value: ParameterValue) -> Any:
    kinds = {
        ParameterType.PARAMETER_STRING: value.string_value,
        ParameterType.PARAMETER_INTEGER: value.integer_value,
        ParameterType.PARAMETER_DOUBLE: value.double_value,
    }
    return kinds.get(value.type)
