# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Results of the board get the stamps of their frames, in whatever order both come."""

import numpy as np
from pty_board import frame

from acts_core.frames import SampleFrame
from acts_core.wire import BoardImage, BoardObject
from acts_driver.board import BoardResults
from acts_driver.nodes.board_topics import image_message, object_message


def image(of: SampleFrame) -> BoardImage:
    return BoardImage(of.sequence, of.board_us, 491, np.arange(12, dtype=np.uint16).reshape(3, 4))


def test_a_result_that_follows_its_frame() -> None:
    results = BoardResults()
    assert results.stamped([(frame(7), 1000)]) == []
    results.receive(image(frame(7)))
    ((result, stamp_ns),) = results.stamped([])
    assert (result.sequence, stamp_ns) == (7, 1000)
    assert results.stamped([]) == []


def test_a_result_that_is_read_together_with_its_frame_and_the_next() -> None:
    results = BoardResults()
    for number in (1, 2):
        results.receive(image(frame(number)))
    found = results.stamped([(frame(1), 10), (frame(2), 20), (frame(3), 30)])
    assert [(result.sequence, stamp_ns) for result, stamp_ns in found] == [(1, 10), (2, 20)]
    assert (results.results, results.dropped) == (2, 0)


def test_a_result_without_its_frame_is_dropped_and_counted() -> None:
    results = BoardResults()
    results.stamped([(frame(number), number) for number in range(1000)])
    for number in (999, 1000, 3):  # the last one accepted, one not yet seen, one of long ago
        results.receive(image(frame(number)))
    assert [stamp_ns for _, stamp_ns in results.stamped([])] == [999]
    assert (results.results, results.dropped) == (1, 2)


def test_a_number_used_again_after_a_restart_is_another_frame() -> None:
    results = BoardResults()
    results.stamped([(frame(0), 5)])
    before = frame(0)
    results.receive(BoardImage(0, before.board_us + 1, 491, np.zeros((3, 4), dtype=np.uint16)))
    assert results.stamped([]) == []
    assert results.dropped == 1


def test_messages() -> None:
    message = image_message(image(frame(7)), "plate", 3_000_000_004)
    assert (message.header.frame_id, message.header.stamp.sec, message.header.stamp.nanosec) == ("plate", 3, 4)
    assert (message.height, message.width, message.encoding, message.step) == (3, 4, "mono16", 8)
    assert np.frombuffer(message.data, dtype="<u2").tolist() == list(range(12))

    residuals = np.array([0.5, 0.25, 1.0], dtype=np.float32)
    known = object_message(BoardObject(9, 1, 343, 1, residuals), "plate", 5)
    assert (known.sequence, known.class_number, known.name, known.confidence) == (9, 1, "", 0.5)
    assert known.residuals.tolist() == residuals.tolist()
    untouched = object_message(BoardObject(9, 1, 343, None, np.ones(3, dtype=np.float32)), "plate", 5)
    assert (untouched.class_number, untouched.confidence) == (untouched.NO_OBJECT, 0.0)
