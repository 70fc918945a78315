# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Who may connect, by the headers that browsers send."""

import pytest

from acts_view.web.access import is_local_host, new_token, refusal
from acts_view.web.page_files import read_page

TOKEN = "kept-for-the-test"


@pytest.mark.parametrize("host", ["127.0.0.1:8080", "localhost:8080", "localhost:9000", "[::1]:8080", "127.3.2.1"])
def test_the_page_itself_may_connect_also_through_a_tunnel(host: str) -> None:
    assert refusal(host, f"http://{host}", "/stream", "") == ""


@pytest.mark.parametrize(
    ("host", "origin"),
    [
        ("127.0.0.1:8080", "http://example.org"),
        ("127.0.0.1:8080", "http://localhost:8080"),
        ("127.0.0.1:8080", "http://127.0.0.1:3000"),
        ("127.0.0.1:8080", "https://127.0.0.1:8080"),
        ("127.0.0.1:8080", "null"),
        ("127.0.0.1:8080", None),
        (None, None),
        # A foreign name that its owner lets point here.
        ("example.org:8080", "http://example.org:8080"),
        ("localhost.example.org:8080", "http://localhost.example.org:8080"),
        ("[", "http://["),
    ],
)
def test_no_other_page_may_connect(host: str | None, origin: str | None) -> None:
    assert refusal(host, origin, "/stream", "")


def test_other_hosts_need_the_token() -> None:
    host, origin = "lab:8080", "http://lab:8080"
    assert refusal(host, origin, f"/stream?token={TOKEN}", TOKEN) == ""
    for path in (
        "/stream",
        "/stream?token=",
        f"/stream?token={TOKEN}x",
        f"/stream?token={TOKEN[:-1]}",
        f"/stream?token={TOKEN.swapcase()}",
        "/stream?token=ä",
    ):
        assert "token" in refusal(host, origin, path, TOKEN)
    assert refusal(host, "http://example.org", f"/stream?token={TOKEN}", TOKEN)
    assert len({new_token() for _ in range(100)}) == 100


def test_names_of_this_machine() -> None:
    assert all(map(is_local_host, ("localhost", "127.0.0.1", "::1")))
    assert not any(map(is_local_host, ("0.0.0.0", "::", "192.168.1.2", "lab", "")))


def test_the_page_needs_nothing_from_elsewhere() -> None:
    files = read_page()
    assert files["/"] == files["/index.html"]
    own = [file.body.decode() for path, file in files.items() if not path.startswith("/vendor/")]
    assert not any("http://" in text or "https://" in text for text in own)
