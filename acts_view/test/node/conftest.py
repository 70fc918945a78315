# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The bench of the node ``view``, in the domain of the module that asks for it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from view_node_bench import Bench


@pytest.fixture
def bench(request: pytest.FixtureRequest) -> Iterator[Bench]:
    made = Bench(request.module.DOMAIN_ID)
    yield made
    made.close()
