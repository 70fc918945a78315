# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Images and objects that the core recovers itself arrive as it sent them."""

import core_firmware
import numpy as np
import pytest
from core_firmware import CoreFirmware
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.wire import (
    OUTPUTS,
    BoardImage,
    BoardObject,
    BoardSettings,
    StreamDecoder,
    cobs,
    encode_configure,
)

pytestmark = pytest.mark.slow

FAST = settings(max_examples=60, deadline=None)
U32, U64 = st.integers(0, 2**32 - 1), st.integers(0, 2**64 - 1)


@FAST
@given(U32, U64, U32, st.integers(1, 64), st.integers(1, 64), st.integers(0, 2**32 - 1))
def test_images(sequence: int, board_us: int, duration_us: int, rows: int, cols: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    counts = random.uniform(-100, 1200, (rows, cols)).astype(np.float32)
    counts[random.random((rows, cols)) < 0.02] = random.choice(
        np.array([np.nan, np.inf, -np.inf, 0.5, 1022.5], dtype=np.float32)
    )
    packet = core_firmware.encode_image(sequence, board_us, duration_us, counts)
    messages: list[object] = []
    StreamDecoder(on_message=messages.append).feed(cobs.encode(packet) + b"\0")
    (image,) = messages
    assert isinstance(image, BoardImage)
    assert (image.sequence, image.board_us, image.duration_us) == (sequence, board_us, duration_us)
    expected = np.floor(np.clip(np.nan_to_num(counts.astype(float)), 0, 1023) + 0.5)
    assert image.counts.tolist() == expected.tolist()


@FAST
@given(U32, U64, U32, st.lists(st.floats(width=32), min_size=1, max_size=64), st.data())
def test_objects(sequence: int, board_us: int, duration_us: int, values: list[float], data: st.DataObject) -> None:
    residuals = np.array(values, dtype=np.float32)
    number = data.draw(st.none() | st.integers(0, len(values) - 1))
    packet = core_firmware.encode_object(sequence, board_us, duration_us, number, residuals)
    messages: list[object] = []
    StreamDecoder(on_message=messages.append).feed(cobs.encode(packet) + b"\0")
    (found,) = messages
    assert isinstance(found, BoardObject)
    assert (found.sequence, found.board_us, found.duration_us) == (sequence, board_us, duration_us)
    assert found.number == number
    largest = np.finfo(np.float32).max
    expected = np.where(np.isfinite(residuals), np.maximum(residuals, 0), largest)
    assert found.residuals.tolist() == expected.tolist()


def test_every_output_is_known_to_both() -> None:
    with CoreFirmware() as firmware:
        for number, output in enumerate(OUTPUTS):
            state = firmware.ask(encode_configure(1, BoardSettings(output=output))).state
            assert state.settings.output == output
            assert state.samples_only == (number > 0)  # no model is held
            assert firmware.active_output == 0
