# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Models on their way to the board: taken whole and right, or not at all."""

import dataclasses
import struct

import numpy as np
import pytest
from core_firmware import CoreFirmware
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.wire import (
    BoardModel,
    BoardSettings,
    Reply,
    ReplyStatus,
    encode_configure,
    encode_query,
    encode_upload_begin,
    encode_upload_data,
    encode_upload_end,
    object_library,
    patch_dictionary,
)
from acts_core.wire.board_models import MODEL_CAPACITY, PATCH_SIDE_MAX, ModelKind
from acts_core.wire.commands import NO_MODEL, HeldModel


@st.composite
def models(draw: st.DrawFn) -> BoardModel:
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    if draw(st.booleans()):
        side = draw(st.integers(1, PATCH_SIDE_MAX))
        atoms = random.normal(size=(side * side, draw(st.integers(1, 200))))
        return patch_dictionary(atoms, patch_step=draw(st.integers(1, side)))
    columns = random.random((draw(st.integers(1, 1024)), draw(st.integers(1, 60))))
    n_objects = draw(st.integers(1, columns.shape[1]))
    return object_library(columns, np.arange(columns.shape[1]) % n_objects)


def small() -> BoardModel:
    return object_library(np.arange(64.0).reshape(16, 4), [0, 1, 2, 1])


def upload(firmware: CoreFirmware, model: BoardModel, piece: int = 1024) -> Reply:
    assert firmware.ask(encode_upload_begin(1, model)).ok
    for offset in range(0, len(model.payload), piece):
        reply = firmware.ask(encode_upload_data(2, offset, model.payload[offset : offset + piece]))
        assert (reply.status, reply.detail) == (ReplyStatus.OK, min(offset + piece, len(model.payload)))
        assert reply.state.uploading
        assert reply.state.model == NO_MODEL
    return firmware.ask(encode_upload_end(3))


@settings(max_examples=25, deadline=None)
@given(models(), st.integers(300, 1024))
def test_a_model_arrives_as_it_is(model: BoardModel, piece: int) -> None:
    with CoreFirmware() as firmware:
        reply = upload(firmware, model, piece)
        assert reply.ok
        assert reply.state.model == HeldModel.of(model)
        assert not reply.state.uploading
        assert firmware.model == model.payload
        assert firmware.ask(encode_query(9)).state.model == HeldModel.of(model)


def test_the_largest_models_fit() -> None:
    with CoreFirmware() as firmware:
        for model in (
            patch_dictionary(np.ones((64, 1000))),
            object_library(np.ones((1024, 60)), np.arange(60) % 30),
            patch_dictionary(np.ones((64, 1024))),
        ):
            assert upload(firmware, model).state.model == HeldModel.of(model)
            assert len(firmware.model) == len(model.payload) <= MODEL_CAPACITY


def test_every_step_may_be_repeated() -> None:
    model = small()
    half = len(model.payload) // 2
    first, second = model.payload[:half], model.payload[half:]
    with CoreFirmware() as firmware:
        for _ in range(2):
            assert firmware.ask(encode_upload_begin(1, model)).detail == 0
        for _ in range(2):
            assert firmware.ask(encode_upload_data(2, 0, first)).detail == half
        for _ in range(2):
            assert firmware.ask(encode_upload_data(3, half, second)).detail == len(model.payload)
        assert firmware.ask(encode_upload_data(2, 0, first)).ok
        for _ in range(2):
            assert firmware.ask(encode_upload_end(4)).ok
        assert firmware.ask(encode_upload_data(3, half, second)).ok
        assert firmware.ask(encode_query(5)).state.model == HeldModel.of(model)
        assert firmware.model == model.payload


def test_pieces_out_of_order_are_refused_and_the_upload_goes_on() -> None:
    model = small()
    size = len(model.payload)
    with CoreFirmware() as firmware:
        assert firmware.ask(encode_upload_data(1, 0, b"abc")).status is ReplyStatus.UPLOAD_OUT_OF_ORDER
        assert firmware.ask(encode_upload_end(1)).status is ReplyStatus.UPLOAD_OUT_OF_ORDER
        assert firmware.ask(encode_upload_begin(2, model)).ok
        assert firmware.ask(encode_upload_data(3, 0, model.payload[:100])).ok
        for command in (
            encode_upload_data(4, 101, model.payload[101:150]),  # a gap
            encode_upload_data(4, 50, model.payload[50:150]),  # an overlap
            encode_upload_data(4, 0, bytes(100)),  # other bytes than before
            encode_upload_data(4, 100, bytes(size)),  # more than was announced
            encode_upload_data(4, 2**32 - 1, b"ab"),  # past the end of numbers
            encode_upload_end(4),  # too early
        ):
            reply = firmware.ask(command)
            assert (reply.status, reply.detail) == (ReplyStatus.UPLOAD_OUT_OF_ORDER, 100)
            assert "from byte 100" in reply.problem
        assert firmware.ask(encode_upload_data(5, 100, model.payload[100:])).ok
        assert firmware.ask(encode_upload_end(6)).ok
        assert firmware.model == model.payload


def test_a_wrong_checksum_leaves_no_model() -> None:
    model = small()
    with CoreFirmware() as firmware:
        assert upload(firmware, model).ok
        assert firmware.ask(encode_upload_begin(1, model)).state.model == NO_MODEL
        damaged = bytes([model.payload[0] ^ 1]) + model.payload[1:]
        assert firmware.ask(encode_upload_data(2, 0, damaged)).ok
        for _ in range(2):
            reply = firmware.ask(encode_upload_end(3))
            assert reply.status is ReplyStatus.MODEL_CHECKSUM
            assert reply.state.model == NO_MODEL
        assert firmware.model == b""
        assert upload(firmware, model).ok


@pytest.mark.parametrize(
    "changes",
    [
        {"kind": ModelKind.NONE},
        {"kind": ModelKind.PATCH_DICTIONARY},
        {"rows": 0},
        {"rows": 17},
        {"columns": 0},
        {"columns": 65535, "rows": 65535},
        {"patch_side": 4},
        {"patch_step": 1},
        {"n_objects": 0},
        {"n_objects": 65},
        {"payload": bytes(16)},
        {"rows": 4096, "columns": 16, "payload": bytes(MODEL_CAPACITY + 16)},
    ],
)
def test_an_impossible_model_is_refused_and_the_old_one_stays(changes: dict[str, object]) -> None:
    with CoreFirmware() as firmware:
        assert upload(firmware, small()).ok
        wrong = dataclasses.replace(small(), **changes)  # type: ignore[arg-type]
        reply = firmware.ask(encode_upload_begin(1, wrong))
        assert reply.status is ReplyStatus.MODEL_IMPOSSIBLE
        assert reply.state.model == HeldModel.of(small())
        assert firmware.model == small().payload


@pytest.mark.parametrize(
    ("offset", "wrong"),
    [(0, struct.pack("<f", np.nan)), (252, struct.pack("<f", -np.inf)), (256, b"\3"), (258, b"\1")],
)
def test_what_no_number_or_no_object_can_be_is_refused_at_the_end(offset: int, wrong: bytes) -> None:
    # Infinite values; a class that was not announced; a class without a column.
    good = small()
    payload = good.payload[:offset] + wrong + good.payload[offset + len(wrong) :]
    with CoreFirmware() as firmware:
        reply = upload(firmware, dataclasses.replace(good, payload=payload))
        assert reply.status is ReplyStatus.MODEL_IMPOSSIBLE
        assert reply.state.model == NO_MODEL


def test_outputs_fall_back_to_samples_until_the_model_fits() -> None:
    dictionary = patch_dictionary(np.ones((16, 3)), patch_step=2)
    with CoreFirmware() as firmware:

        def state(output: str, rows: int = 4, cols: int = 4) -> tuple[bool, int]:
            chosen = BoardSettings(rows=rows, cols=cols, m=2, output=output)
            return firmware.ask(encode_configure(1, chosen)).state.samples_only, firmware.active_output

        assert state("image") == (True, 0)
        assert upload(firmware, dictionary).ok
        assert state("image") == (False, 1)
        assert state("image", rows=3) == (True, 0)  # a patch does not fit
        assert state("object") == (True, 0)
        assert upload(firmware, small()).ok  # 16 taxels
        assert state("object") == (False, 2)
        assert state("object", rows=2, cols=8) == (False, 2)
        assert state("object", rows=5) == (True, 0)
        assert state("image") == (True, 0)
        assert state("samples") == (False, 0)


def test_a_model_outlives_a_reconnection_and_so_does_an_upload() -> None:
    model = small()
    with CoreFirmware() as firmware:
        firmware.ask(encode_upload_begin(1, model))
        firmware.ask(encode_upload_data(2, 0, model.payload[:100]))
        firmware.stop_stream()
        firmware.start_stream()
        assert firmware.ask(encode_upload_data(3, 100, model.payload[100:])).ok
        assert firmware.ask(encode_upload_end(4)).ok
        firmware.stop_stream()
        firmware.start_stream()
        assert firmware.ask(encode_query(5)).state.model == HeldModel.of(model)
