# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts bench view`, much shorter than it is meant to be. ROS_DOMAIN_ID 195."""

from __future__ import annotations

from pathlib import Path

import pytest

from acts_tools.bench.cases.view import measure
from acts_tools.bench.rigs import view_browser
from acts_tools.bench.workbench import Workbench
from acts_tools.running.stopping import StopFlag

pytestmark = pytest.mark.slow


def test_all_clients_get_pictures_beside_one_that_takes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "195")
    # With a browser it takes half a minute; the page has tests of its own in one.
    monkeypatch.setattr(view_browser, "browser", lambda: None)
    result = measure(Workbench(3.0, tmp_path, StopFlag()))
    figures = {figure.key: figure.value for figure in result.figures}
    assert result.problems == []
    assert float(figures["alone_hz"] or 0) > 0
    assert float(figures["clients_images_hz"] or 0) > 0
    assert float(figures["clients_age_ms.median"] or 0) > 0
    assert float(figures["server_percent"] or 0) > 0
    assert figures["browser_images_hz"] is None
