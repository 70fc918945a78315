# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Percentiles in reports."""

from acts_tools.percentiles import percentiles


def test_percentiles_have_the_names_that_are_asked_for() -> None:
    values = [k / 3 for k in range(1001)]
    assert percentiles(values) == {"median": 166.667, "p99": 330.0, "p999": 333.0}
    assert percentiles(values, ("p50", "p99"), decimals=None) == {"p50": 500 / 3, "p99": 330.0}


def test_nothing_has_no_percentiles() -> None:
    assert percentiles([]) == {"median": None, "p99": None, "p999": None}
    assert percentiles([], ("p50",), decimals=None) == {"p50": None}
