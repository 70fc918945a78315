# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Launch files of a made-up package."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from fake_prefix import Launch, Prefix

from acts_tools.launch.evaluate import Plan, evaluate


@pytest.fixture
def node(prefix: Prefix) -> Path:
    return prefix.script("node", "#!/bin/sh\n")


@pytest.fixture
def launch(prefix: Prefix, node: Path, tmp_path: Path) -> Launch:
    def run(body: str, **arguments: str) -> Plan:
        folder = tmp_path / "params"
        folder.mkdir(exist_ok=True)
        return evaluate(prefix.launch("it.launch.xml", body), arguments, os.environ, folder)

    return run
