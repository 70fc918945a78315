# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The packet codec, recipes and sessions of the simulated RTDE port, without sockets."""

from __future__ import annotations

import contextlib
import struct

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.errors import PacketError
from acts_sim.ur import Controller, UrControllerConfig
from acts_sim.ur.ports import RtdePort
from acts_sim.ur.ports.session import RtdeSession
from acts_sim.ur.rtde import (
    INPUT_TYPES,
    OUTPUT_TYPES,
    InputRecipe,
    OutputImage,
    OutputRecipe,
    PacketReader,
    PacketType,
    encode,
    split_names,
)
from acts_sim.ur.rtde.packets import TYPE_FORMATS

pytestmark = pytest.mark.slow

SERVO_NAMES = ["input_int_register_0", *(f"input_double_register_{index}" for index in range(11))]

packets = st.lists(st.tuples(st.sampled_from(PacketType), st.binary(max_size=200)), max_size=8)


@settings(deadline=None)
@given(packets, st.data())
def test_packets_survive_any_cutting(sent: list[tuple[PacketType, bytes]], data: st.DataObject) -> None:
    stream = b"".join(encode(kind, payload) for kind, payload in sent)
    cuts = sorted(data.draw(st.lists(st.integers(0, len(stream)), max_size=10)))
    reader = PacketReader()
    received = []
    for start, end in zip([0, *cuts], [*cuts, len(stream)], strict=True):
        received += reader.feed(stream[start:end])
    assert received == sent


@settings(deadline=None)
@given(packets, st.binary(max_size=300))
def test_garbage_is_refused_or_waited_for(sent: list[tuple[PacketType, bytes]], garbage: bytes) -> None:
    reader = PacketReader()
    assert reader.feed(b"".join(encode(kind, payload) for kind, payload in sent)) == sent
    with contextlib.suppress(PacketError):
        found = b"".join(encode(kind, payload) for kind, payload in reader.feed(garbage))
        assert garbage.startswith(found)


@settings(deadline=None)
@given(packets, st.binary(max_size=2))
def test_what_is_not_whole_yet_is_waited_for(sent: list[tuple[PacketType, bytes]], begun: bytes) -> None:
    stream = b"".join(encode(kind, payload) for kind, payload in sent)
    assert PacketReader().feed(stream + begun) == sent


@pytest.mark.parametrize("header", [b"\x00\x00V", b"\x00\x02V", b"GET", b"\x00\x03\x00"])
def test_impossible_headers_are_refused(header: bytes) -> None:
    with pytest.raises(PacketError, match="not an RTDE packet"):
        PacketReader().feed(header)


def test_packet_that_does_not_fit() -> None:
    assert len(encode(PacketType.DATA_PACKAGE, bytes(65532))) == 65535
    with pytest.raises(PacketError, match="does not fit"):
        encode(PacketType.DATA_PACKAGE, bytes(65533))


@settings(deadline=None)
@given(st.lists(st.sampled_from(sorted(INPUT_TYPES)), min_size=1, max_size=30, unique=True), st.binary(max_size=400))
def test_input_recipe_takes_whole_fields_only(names: list[str], payload: bytes) -> None:
    recipe = InputRecipe(names, [INPUT_TYPES[name] for name in names])
    decoded = recipe.decode(payload)
    assert decoded.whole == (len(payload) >= recipe.size)
    assert list(decoded.values) == names[: len(decoded.values)]
    assert decoded.whole == (len(decoded.values) == len(names))
    taken = InputRecipe(list(decoded.values), [INPUT_TYPES[name] for name in decoded.values])
    assert taken.size <= len(payload)


@settings(deadline=None)
@given(st.integers(-(2**31), 2**31 - 1), st.lists(st.floats(allow_nan=False), min_size=11, max_size=11))
def test_servo_command_round_trip(command: int, values: list[float]) -> None:
    recipe = InputRecipe(SERVO_NAMES, ["INT32", *["DOUBLE"] * 11])
    decoded = recipe.decode(struct.pack(">i11d", command, *values))
    assert decoded.whole
    assert list(decoded.values.values()) == [command, *values]


@settings(deadline=None)
@given(st.lists(st.sampled_from(sorted(OUTPUT_TYPES)), min_size=1, max_size=20))
def test_output_package_holds_the_values_in_the_order_asked_for(names: list[str]) -> None:
    image = OutputImage()
    recipe = OutputRecipe(image, names, 500.0)
    image.set("timestamp", 12.5)
    image.set("actual_q", *range(6))
    ((kind, payload),) = PacketReader().feed(recipe.package())
    assert kind == PacketType.DATA_PACKAGE
    assert payload[0] == OutputRecipe.ID
    offset = 1
    for name in names:
        packed = struct.Struct(">" + TYPE_FORMATS[OUTPUT_TYPES[name]])
        assert packed.unpack_from(payload, offset) == image.get(name)
        offset += packed.size
    assert offset == len(payload)


def make() -> tuple[Controller, RtdePort]:
    controller = Controller(UrControllerConfig(), lambda text: None)
    return controller, RtdePort(controller)


def ask(session: RtdeSession, kind: PacketType, payload: bytes = b"") -> bytes:
    ((answered, answer),) = PacketReader().feed(session.receive(encode(kind, payload)))
    assert answered == kind
    return answer


def outputs(names: str, frequency_hz: float = 500.0) -> bytes:
    return struct.pack(">d", frequency_hz) + names.encode()


def test_setup_and_start() -> None:
    _, port = make()
    session = port.session()
    assert ask(session, PacketType.REQUEST_PROTOCOL_VERSION, b"\x00\x02") == b"\x01"
    assert ask(session, PacketType.REQUEST_PROTOCOL_VERSION, b"\x00\x07") == b"\x00"
    assert struct.unpack(">4I", ask(session, PacketType.GET_URCONTROL_VERSION)) == (5, 11, 1, 108318)
    assert ask(session, PacketType.START) == b"\x00", "there is nothing to send yet"
    assert ask(session, PacketType.SETUP_OUTPUTS, outputs("timestamp,actual_q,")) == b"\x01DOUBLE,VECTOR6D"
    assert (
        ask(session, PacketType.SETUP_INPUTS, b"input_int_register_0,input_double_register_0,") == b"\x01INT32,DOUBLE"
    )
    assert ask(session, PacketType.SETUP_INPUTS, b"input_int_register_0,") == b"\x02INT32", "again, same connection"
    started, first = PacketReader().feed(session.receive(encode(PacketType.START)))
    assert started == (PacketType.START, b"\x01")
    assert first[0] == PacketType.DATA_PACKAGE
    assert len(first[1]) == 1 + 8 + 48


def test_unknown_variables_are_named() -> None:
    _, port = make()
    session = port.session()
    assert ask(session, PacketType.SETUP_OUTPUTS, outputs("timestamp,nonsense,")) == b"\x00DOUBLE,NOT_FOUND"
    assert ask(session, PacketType.SETUP_INPUTS, b"input_int_register_0,nonsense,") == b"\x00INT32,NOT_FOUND"
    assert ask(session, PacketType.START) == b"\x00"


def test_more_outputs_than_a_package_holds_are_refused() -> None:
    _, port = make()
    session = port.session()
    answer = ask(session, PacketType.SETUP_OUTPUTS, outputs("actual_q," * 1400))
    assert answer[0] == 0
    assert ask(session, PacketType.START) == b"\x00"


def test_inputs_have_one_writer_until_it_goes() -> None:
    _, port = make()
    first, second = port.session(), port.session()
    assert ask(first, PacketType.SETUP_INPUTS, b"input_int_register_0,").startswith(b"\x01")
    assert ask(second, PacketType.SETUP_INPUTS, b"input_int_register_0,input_int_register_1,") == b"\x00IN_USE,INT32"
    first.close()
    assert ask(second, PacketType.SETUP_INPUTS, b"input_int_register_0,") == b"\x01INT32"


@pytest.mark.parametrize(("asked_hz", "due_in_a_second"), [(500.0, 500), (125.0, 125), (400.0, 400), (1e9, 500)])
def test_packages_come_at_the_rate_asked_for(asked_hz: float, due_in_a_second: int) -> None:
    controller, port = make()
    session = port.session()
    ask(session, PacketType.SETUP_OUTPUTS, outputs("timestamp,", asked_hz))
    session.receive(encode(PacketType.START))
    stamps: list[float] = []
    for _ in range(500):
        controller.tick()
        for _, payload in PacketReader().feed(session.tick()):
            stamps += struct.unpack(">d", payload[1:])
    assert abs(len(stamps) - due_in_a_second) <= 1
    if due_in_a_second == 500:
        assert stamps == pytest.approx([0.002 * (index + 1) for index in range(500)])


@settings(deadline=None, max_examples=50)
@given(st.lists(st.tuples(st.sampled_from(PacketType), st.binary(max_size=150)), max_size=20))
def test_no_packet_breaks_a_session(sent: list[tuple[PacketType, bytes]]) -> None:
    controller, port = make()
    session = port.session()
    ask(session, PacketType.SETUP_INPUTS, ",".join(SERVO_NAMES).encode())
    for kind, payload in sent:
        try:
            session.receive(encode(kind, payload))
        except PacketError:
            session.close()
            session = port.session()
        controller.tick()
        session.tick()
    assert all(abs(angle) < 7.0 for angle in controller.joints.q)


def test_names_are_split_at_commas() -> None:
    assert split_names(b"a,b,") == ["a", "b"]
    assert split_names(b"") == []
    assert split_names(b"\xff,") == ["�"]
