# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Who may connect to the page's socket. Knows no ROS.

A browser lets any page connect to any address and says in ``Origin`` which page it was. Only the page that came from
this server may: its origin is where it asks (``Host``). On loopback the host must be a name of this machine besides, so
that no foreign name can be led here by DNS; elsewhere the address has to carry the token that the server has printed.
"""

from __future__ import annotations

import hmac
import secrets
from urllib.parse import parse_qs, urlsplit

from acts_core.runtime import is_loopback


def is_local_host(host: str) -> bool:
    """Whether a host that a person gives is this very machine: ``localhost`` or a numeric loopback address."""
    return host == "localhost" or is_loopback(host)


def new_token() -> str:
    """A token that cannot be guessed."""
    return secrets.token_urlsafe(16)


def refusal(host: str | None, origin: str | None, path: str, token: str) -> str:
    """Why a connection is refused, for the one who asks; empty where it is not.

    Parameters
    ----------
    host, origin : str or None
        Headers of the request; None where it has none.
    path : str
        With its query.
    token : str
        That the query must have; empty: none, and only names of this machine are allowed.
    """
    if not host or origin != f"http://{host}":
        return "this socket is for the page that this server shows"
    if token:
        given = parse_qs(urlsplit(path).query).get("token", [""])[-1]
        if not hmac.compare_digest(given.encode(), token.encode()):
            return "the address lacks the token that `acts view` printed when it began"
        return ""
    try:
        name = urlsplit(origin).hostname or ""
    except ValueError:
        name = ""
    return "" if is_local_host(name) else "this server is for its own machine; `acts view --host` opens it to others"
