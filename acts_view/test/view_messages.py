# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reads the messages to the page, as the page does."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray


def decode(message: bytes) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """As `acts_view.web.codec` describes the format, and as the page does it: every array lies at a multiple of 4."""
    length = int.from_bytes(message[:4], "little")
    header = json.loads(message[4 : 4 + length])
    at = 4 + length
    read = {}
    for name, kind, shape in header.pop("arrays"):
        assert at % 4 == 0
        count = math.prod(shape)
        read[name] = np.frombuffer(message, np.dtype(kind).newbyteorder("<"), count, at).reshape(shape)
        at += -(-read[name].nbytes // 4) * 4
    assert at == len(message)
    return header, read
