# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Requests of a page: whatever comes is one, or is refused."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import ViewRequestError
from acts_view.web.requests import Request, read_request


@given(st.text() | st.binary() | st.builds(json.dumps, st.dictionaries(st.text(), st.integers() | st.text())))
def test_anything_is_a_request_or_refused(data: str | bytes) -> None:
    try:
        request = read_request(data)
    except ViewRequestError:
        return
    assert request.number >= 0


def test_a_request_is_read_as_it_is_and_an_odd_one_refused() -> None:
    assert read_request('{"id":3,"do":"seek","value":1.5}') == Request(3, "seek", value=1.5)
    for text in (
        '{"id":1,"do":"seek","value":NaN}',
        '{"id":1,"do":"seek","value":1e999}',
        '{"id":1,"do":"seek","value":[1]}',
        '{"id":1,"do":"seek","more":1}',
        '{"id":true,"do":"seek"}',
        '{"do":"seek"}',
        "[" * 900,
        json.dumps({"id": 1, "do": "x" * 201}),
    ):
        with pytest.raises(ViewRequestError):
            read_request(text)
