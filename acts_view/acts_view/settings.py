# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Parameters of the node ``view``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from acts_core.errors import SettingsError
from acts_core.files import path_of
from acts_core.names import ALLOWED, is_full_name
from acts_core.settings import setting, validate


@dataclass(frozen=True)
class ViewSettings:
    """Parameters of the node ``view``; see `acts_core.settings`."""

    skins: str = setting(
        "",
        "namespaces of the skins to show, with commas between, within the node's own unless / is before them; / is the "
        "root; empty: all that are found",
    )
    host: str = setting("127.0.0.1", "address to listen on; another than this machine's own gets a token, see the log")
    port: int = setting(8080, "port to listen on; 0: any that is free, see the log", minimum=0, maximum=65535)
    control: bool = setting(
        False,
        "whether pages may call the services of drivers, ball_control and hand_reflexes, and record: this moves robots",
    )
    record_dir: str = setting(
        "recordings", "folder for what pages record; made when needed, relative to where the node was started"
    )
    record_max_mb: float = setting(
        1000.0, "a recording ends by itself at this size [MB]", minimum=0.001, maximum=1_000_000.0
    )
    outlines: bool = setting(
        False, "whether to ask the reconstruction for outlines of contacts, which costs CPU there while a page is open"
    )
    rate_hz: float = setting(30.0, "how often new data are sent to the page [Hz]", minimum=1.0, maximum=100.0)
    send_limit_s: float = setting(
        5.0, "a page that receives nothing for this long is disconnected [s]", minimum=0.1, maximum=60.0
    )

    def __post_init__(self) -> None:
        validate(self)
        if not self.host.strip():
            raise SettingsError("host is empty: needed is an address or a name, such as 127.0.0.1 or 0.0.0.0")
        if not self.record_dir:
            raise SettingsError("record_dir is empty: needed is a folder, such as recordings")
        path_of(self.record_dir, error=SettingsError)
        for name in filter(None, self.namespaces("/")):
            if not is_full_name(name):
                raise SettingsError(
                    f"skins: {name[1:]!r} is no namespace: allowed are {ALLOWED}, parts with / between, and a comma "
                    "between skins"
                )

    @property
    def record_folder(self) -> Path:
        """What `record_dir` names."""
        return path_of(self.record_dir, error=SettingsError)

    def namespaces(self, own: str) -> tuple[str, ...]:
        """The skins that are given, each with a slash before, of the root empty; no skin: all that are found.

        Parameters
        ----------
        own : str
            Namespace of the node, in which those are that are given without a slash before.
        """
        given = (name.strip() for name in self.skins.split(","))
        whole = (name if name.startswith("/") else f"{own}/{name}" for name in given if name)
        return tuple(dict.fromkeys(f"/{name.strip('/')}".rstrip("/") for name in whole))
