# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The shared ring: between two processes, replaced while being read, and refused where it is none."""

import errno
import os
import struct
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.errors import ActsError, SettingsError
from acts_sim.shared import TimedRingReader, TimedRingWriter

pytestmark = pytest.mark.slow


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "test.ring"


def line(time_ns: int, width: int = 3) -> np.ndarray:
    """Values that are linear in time, so that interpolation has to give them exactly."""
    return time_ns * 1e-6 + np.arange(width)


def test_nothing_is_read_before_the_first_slot(path: Path) -> None:
    with TimedRingWriter(path, 3):
        reader = TimedRingReader(path, 3)
        assert reader.newest() is None
        assert reader.sample(5) is None
        assert reader.age_s() == float("inf")
        assert reader.written == 0


def test_newest_is_what_was_written_last(path: Path) -> None:
    with TimedRingWriter(path, 3, slots=4) as writer:
        reader = TimedRingReader(path, 3)
        for time_ns in range(1000, 11000, 1000):
            writer.write(time_ns, line(time_ns))
            newest = reader.newest()
            assert newest is not None
            assert newest[0] == time_ns
            np.testing.assert_array_equal(newest[1], line(time_ns))
        assert reader.written == 10


def test_since_gives_all_that_is_later_and_still_there(path: Path) -> None:
    with TimedRingWriter(path, 3, slots=4) as writer:
        reader = TimedRingReader(path, 3)
        times_ns, values = reader.since(0)
        assert (times_ns.shape, values.shape) == ((0,), (0, 3))
        for time_ns in (1000, 2000):
            writer.write(time_ns, line(time_ns))
        assert reader.since(1000)[0].tolist() == [2000]
        for time_ns in range(3000, 9000, 1000):
            writer.write(time_ns, line(time_ns))
        times_ns, values = reader.since(1000)
        assert times_ns.tolist() == [6000, 7000, 8000]  # one slot is always the next to be written
        np.testing.assert_array_equal(values, [line(time_ns) for time_ns in times_ns.tolist()])
        assert reader.since(8000)[0].size == 0


def test_newest_is_a_copy(path: Path) -> None:
    with TimedRingWriter(path, 3, slots=2) as writer:
        reader = TimedRingReader(path, 3)
        writer.write(1, line(1))
        first = reader.newest()
        writer.write(2, line(2))
        writer.write(3, line(3))
        assert first is not None
        np.testing.assert_array_equal(first[1], line(1))


@settings(max_examples=60, deadline=None)
@given(
    slots=st.integers(2, 9),
    steps=st.lists(st.integers(1, 5_000_000), min_size=1, max_size=20),
    share=st.floats(-0.2, 1.2),
)
def test_sample_is_linear_between_slots_and_holds_outside(
    tmp_path_factory: pytest.TempPathFactory, slots: int, steps: list[int], share: float
) -> None:
    path = tmp_path_factory.mktemp("ring") / "test.ring"
    times_ns = np.cumsum(steps)
    with TimedRingWriter(path, 3, slots=slots) as writer:
        for time_ns in times_ns:
            writer.write(int(time_ns), line(int(time_ns)))
        kept = times_ns[-(slots - 1) :]
        asked_ns = int(kept[0] + share * (kept[-1] - kept[0] + 10))
        sampled = TimedRingReader(path, 3).sample(asked_ns)
    assert sampled is not None
    np.testing.assert_allclose(sampled, line(int(np.clip(asked_ns, kept[0], kept[-1]))), rtol=1e-12, atol=1e-12)


def test_age_counts_from_the_newest_slot(path: Path) -> None:
    with TimedRingWriter(path, 1) as writer:
        reader = TimedRingReader(path, 1)
        writer.write(time.monotonic_ns() - 2_000_000_000, np.zeros(1))
        assert 2.0 <= reader.age_s() < 60.0
        writer.write(time.monotonic_ns() + 100_000_000_000, np.zeros(1))
        assert reader.age_s() < 0


def test_the_layout_is_the_documented_one(path: Path) -> None:
    with TimedRingWriter(path, 2, slots=3) as writer:
        for time_ns in (7, 8, 9, 10):
            writer.write(time_ns, np.array([time_ns, -0.5]))
        content = path.read_bytes()
    assert len(content) == 64 + 3 * 32
    assert struct.unpack_from("<8sIIIIQ", content) == (b"ACTSRING", 1, 3, 2, 0, 4)
    assert struct.unpack_from("<Qqdd", content, 64) == (4, 10, 10.0, -0.5)
    assert struct.unpack_from("<Qqdd", content, 64 + 32) == (2, 8, 8.0, -0.5)


def test_a_reader_changes_over_when_the_writer_starts_anew(path: Path) -> None:
    writer = TimedRingWriter(path, 2)
    writer.write(100, np.array([1.0, 2.0]))
    reader = TimedRingReader(path, 2)
    assert reader.newest() is not None
    writer.close()
    assert not path.exists()
    held = reader.newest()
    assert held is not None
    assert held[0] == 100, "without a file the reader keeps what it has"
    with TimedRingWriter(path, 2) as again:
        again.write(200, np.array([3.0, 4.0]))
        newest = reader.newest()
        assert newest is not None
        assert newest[0] == 200
        assert reader.sample(150) is not None


def test_a_writer_removes_only_its_own_file(path: Path) -> None:
    old = TimedRingWriter(path, 2)
    new = TimedRingWriter(path, 2)
    old.close()
    assert path.exists()
    new.close()
    assert not path.exists()
    assert list(path.parent.iterdir()) == []


def make_file(path: Path) -> None:
    path.write_bytes(b"notes of somebody")


def make_link(path: Path) -> None:
    make_file(path.with_name("target"))
    path.symlink_to("target")


@pytest.mark.parametrize("make", [make_file, make_link, Path.touch, Path.mkdir, os.mkfifo])
def test_what_is_no_ring_is_not_replaced(path: Path, make: Callable[[Path], None]) -> None:
    make(path)
    before = path.lstat()
    with pytest.raises(SettingsError, match=r"test\.ring is .* and is no ring.*name another file"):
        TimedRingWriter(path, 3)
    assert os.path.samestat(path.lstat(), before)
    assert path.lstat().st_size == before.st_size


def test_a_new_ring_of_another_width_is_refused(path: Path) -> None:
    old = TimedRingWriter(path, 2)
    reader = TimedRingReader(path, 2)
    old.close()
    with TimedRingWriter(path, 5), pytest.raises(ActsError, match="holds 5 values a slot, 2 are expected"):
        reader.newest()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "no shared ring there"),
        (b"ACTSRING", "too short"),
        (b"GARBAGE!" + bytes(200), "not a shared ring of version 1"),
        (struct.pack("<8sIIII", b"ACTSRING", 2, 4, 3, 0).ljust(500, b"\0"), "not a shared ring of version 1"),
        (struct.pack("<8sIIII", b"ACTSRING", 1, 4, 9, 0).ljust(500, b"\0"), "holds 9 values a slot, 3 are expected"),
        (struct.pack("<8sIIII", b"ACTSRING", 1, 0, 3, 0).ljust(500, b"\0"), "shorter than its header says"),
        (struct.pack("<8sIIII", b"ACTSRING", 1, 4000, 3, 0).ljust(500, b"\0"), "shorter than its header says"),
    ],
)
def test_a_file_that_is_no_ring_is_refused(path: Path, content: bytes, message: str) -> None:
    path.write_bytes(content)
    with pytest.raises(ActsError, match=message):
        TimedRingReader(path, 3)


def test_a_missing_file_is_refused(path: Path) -> None:
    with pytest.raises(ActsError, match="start the process that writes it first"):
        TimedRingReader(path, 3)


@settings(max_examples=40, deadline=None)
@given(st.binary(max_size=300))
def test_random_bytes_are_refused(tmp_path_factory: pytest.TempPathFactory, content: bytes) -> None:
    path = tmp_path_factory.mktemp("ring") / "test.ring"
    path.write_bytes(content)
    with pytest.raises(ActsError):
        TimedRingReader(path, 3)


def test_a_writer_refuses_what_a_reader_could_not_use(path: Path) -> None:
    with TimedRingWriter(path, 3) as writer:
        writer.write(10, np.zeros(3))
        with pytest.raises(ActsError, match="times must grow"):
            writer.write(10, np.zeros(3))
        with pytest.raises(ActsError, match=r"a slot holds \(3,\)"):
            writer.write(11, np.zeros(1))
    with pytest.raises(ActsError, match="its folder must exist"):
        TimedRingWriter(path / "missing" / "test.ring", 3)
    with pytest.raises(ActsError, match="2 slots and 1 value"):
        TimedRingWriter(path, 3, slots=1)


def test_a_ring_that_cannot_be_made_leaves_nothing_behind(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path.mkdir()
    with pytest.raises(ActsError, match="directory"):
        TimedRingWriter(path, 3)

    def full(descriptor: int, offset: int, length: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "posix_fallocate", full)
    with pytest.raises(ActsError, match=r"No space left on device.*room for 5184 bytes"):
        TimedRingWriter(path.with_name("other.ring"), 3, slots=128)
    assert list(path.parent.iterdir()) == [path]


def test_a_stuck_writer_is_reported(path: Path) -> None:
    with TimedRingWriter(path, 1) as writer:
        writer.write(1, np.zeros(1))
        reader = TimedRingReader(path, 1)
        writer._lock[0] += np.uint64(1)
        with pytest.raises(ActsError, match="never came to rest"):
            reader.newest()
        with pytest.raises(ActsError, match="never came to rest"):
            reader.sample(1)


WRITER = """
import sys
from pathlib import Path
import numpy as np
from acts_sim.shared.timed_ring import TimedRingWriter

# Far faster than any real writer, through a short ring, so that readers meet torn and overwritten slots.
with TimedRingWriter(Path(sys.argv[1]), 256, slots=16) as writer:
    print("ready", flush=True)
    for number in range(1, 150_001):
        writer.write(number * 1000, np.full(256, float(number)))
    print("written", flush=True)
    sys.stdin.readline()
"""


def test_a_reader_never_sees_a_torn_slot_of_another_process(path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", WRITER, str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        reader = TimedRingReader(path, 256)
        deadline_s = time.monotonic() + 30
        reads = 0
        last_ns = 0
        while reader.written < 150_000:
            assert time.monotonic() < deadline_s, f"{reader.written} of 150000 slots were written"
            newest = reader.newest()
            if newest is None:
                continue
            time_ns, values = newest
            assert values.min() == values.max() == time_ns / 1000
            assert time_ns >= last_ns
            last_ns = time_ns
            sampled = reader.sample(time_ns - 1500)
            assert sampled is not None
            assert sampled.min() == sampled.max()
            assert sampled[0] >= time_ns / 1000 - 2, "the wanted slot or, when overtaken, the oldest that is left"
            reads += 1
        assert reads > 0
        process.communicate("end\n", timeout=20)
        assert process.returncode == 0
        assert not path.exists()
    finally:
        process.kill()
        process.wait()
