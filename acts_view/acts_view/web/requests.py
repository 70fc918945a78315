# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a page may ask for: small messages of JSON, checked before anybody acts on them. Knows no ROS."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass

from acts_core.errors import ViewRequestError

Answer = Callable[[bool, str], None]
"""Takes whether it was done and a sentence for a person; to be called once, from any thread, however late."""

Number = float | int

STOPS = frozenset({"stop_balancing", "stop_grasp", "stop_recording"})
"""What is never refused because other requests wait for their answers."""

LATE_S = 3.0
"""What a page has asked for longer ago is done only if it is one of `STOPS` [s]."""

_KEYS = {"id", "do", "skin", "name", "value", "asked_s"}
_LONGEST = 200
_LARGEST = 1e15


@dataclass(frozen=True)
class Request:
    """One wish.

    Attributes
    ----------
    number : int
        By which the page knows the answer.
    do : str
        What is to be done.
    skin : str
        Of which skin or hand; empty: of none.
    name : str
        Of a parameter; empty: of none.
    value : float, int, str or None
        For it; numbers are finite.
    asked_s : float or None
        When, by the clock that the server tells pages [s]; None: the page does not know it.
    """

    number: int
    do: str
    skin: str = ""
    name: str = ""
    value: Number | str | None = None
    asked_s: float | None = None

    def lateness(self, now_s: float) -> str:
        """Why it is not acted on, in words: it has been on its way for long; empty where it is.

        What is sent into a line that stands still arrives when that goes on, however long after. By then the page has
        given it up, and nobody expects a robot to move.

        Parameters
        ----------
        now_s : float
            By the clock that the server tells pages [s].
        """
        if self.asked_s is None or self.do in STOPS or now_s - self.asked_s <= LATE_S:
            return ""
        return f"not done: it came {now_s - self.asked_s:.1f} s after it was asked for; if you still want it, ask again"


RequestHandler = Callable[[Request, Answer], None]
"""Takes a request, on the server's thread, which it must not hold up."""


def read_request(data: str | bytes) -> Request:
    """Read a message of a page.

    Raises
    ------
    ViewRequestError
        For anything but an object with the keys of `Request`, ``id`` in place of ``number``.
    """
    try:
        content = json.loads(data, parse_constant=_refuse)
    except (ValueError, RecursionError) as error:
        raise ViewRequestError(f"a request that is no JSON: {error}") from error
    if not isinstance(content, dict) or not content.keys() <= _KEYS:
        raise ViewRequestError(f"a request has the keys {', '.join(sorted(_KEYS))} and no others")
    number = content.get("id")
    if not isinstance(number, int) or isinstance(number, bool) or not 0 <= number < 1 << 53:
        raise ViewRequestError("a request has an id, a whole number from 0 on")
    asked_s = _value(content.get("asked_s"))
    if isinstance(asked_s, str):
        raise ViewRequestError("asked_s of a request is a time in seconds")
    return Request(
        number,
        _text(content, "do"),
        _text(content, "skin"),
        _text(content, "name"),
        _value(content.get("value")),
        asked_s,
    )


def _text(content: dict[str, object], key: str) -> str:
    text = content.get(key, "")
    if not isinstance(text, str) or len(text) > _LONGEST:
        raise ViewRequestError(f"{key} of a request is text of at most {_LONGEST} letters")
    return text


def _value(value: object) -> Number | str | None:
    if value is None or (isinstance(value, str) and len(value) <= _LONGEST):
        return value
    # Written so that an infinite one fails, too.
    if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= _LARGEST:
        return value
    raise ViewRequestError(f"the value of a request is a number up to {_LARGEST:g}, or a short text")


def _refuse(name: str) -> None:
    raise ValueError(f"{name} is no number")
