# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a driver that has died leaves to the next one of its launch."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import numpy as np
import pytest

from acts_core.errors import ActsError, SettingsError
from acts_driver.baseline import Baseline, BaselineSource, KeptBaseline
from acts_driver.baseline.kept_baseline import LONGEST_GAP_S

ROWS, COLS = 6, 5
NAME = "/plate/driver auto"

# A process as of a driver: what it does to its baseline, then it waits to be killed.
DRIVER = """
import sys
from pathlib import Path
import numpy as np
from acts_driver.baseline import Baseline, BaselineSource, KeptBaseline

folder, name, *todo = sys.argv[1:]
kept = KeptBaseline(name, Path(folder))
left = kept.take_over(6, 5)
for counts in todo:
    baseline = np.full((6, 5), float(counts), np.float32)
    kept.keep(Baseline(baseline, baseline / 10, baseline > 0, BaselineSource.TARE, 5, 7))
print("none" if left is None else f"{left.counts[0, 0]:g} {left.source.name}", flush=True)
sys.stdin.read()
"""


@contextmanager
def driver(folder: Path, name: str = NAME, *counts: float, by: tuple[str, ...] = ()) -> Iterator[str]:
    """A process that keeps these, one after the other, and is killed at the end; what it has taken over."""
    command = [*by, sys.executable, "-c", DRIVER, str(folder), name, *map(str, counts)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        yield process.stdout.readline().strip()
        process.kill()


def left_by(folder: Path, name: str = NAME) -> str:
    with driver(folder, name) as left:
        return left


def set_back(folder: Path, seconds: float) -> None:
    """As if the files were from then."""
    for path in folder.iterdir():
        then = time.time() - seconds
        os.utime(path, (then, then))


def test_the_next_driver_has_what_the_one_that_was_killed_had_last(tmp_path: Path) -> None:
    with driver(tmp_path, NAME, 11, 12) as left:
        assert left == "none"
    assert left_by(tmp_path) == "12 TARE"
    # It has not kept another one, and is dead as well.
    assert left_by(tmp_path) == "12 TARE"


def test_all_of_it_is_kept(tmp_path: Path) -> None:
    counts = np.random.default_rng(1).uniform(0, 40, (ROWS, COLS)).astype(np.float32)
    baseline = Baseline(counts, counts / np.float32(20), counts < 30, BaselineSource.CALIBRATION, 5, 2**64 - 1)
    with closing(KeptBaseline(NAME, tmp_path)) as kept:
        kept.keep(baseline)
    with closing(KeptBaseline(NAME, tmp_path)) as kept:
        again = kept.take_over(ROWS, COLS)
    assert again is not None
    assert (again.counts == baseline.counts).all()
    assert (again.noise_counts == baseline.noise_counts).all()
    assert (again.valid == baseline.valid).all()
    assert (again.source, again.time_ns, again.board_id) == (BaselineSource.CALIBRATION, 5, 2**64 - 1)


def test_what_is_forgotten_leaves_nothing(tmp_path: Path) -> None:
    with closing(KeptBaseline(NAME, tmp_path)) as kept:
        kept.forget()
        kept.keep(Baseline.none(ROWS, COLS))
        kept.forget()
        assert kept.take_over(ROWS, COLS) is None
    assert list(tmp_path.iterdir()) == []


def test_a_driver_of_another_name_or_of_another_launch_takes_nothing_over(tmp_path: Path) -> None:
    with driver(tmp_path, NAME, 12):
        pass
    assert left_by(tmp_path, "/arm/driver auto") == "none"
    # The shell is the parent of this one, and not replaced by it.
    with driver(tmp_path, NAME, by=("sh", "-c", '"$@"; exit', "sh")) as left:
        assert left == "none"
    assert left_by(tmp_path) == "12 TARE"


def test_what_was_left_long_ago_is_not_taken_over_and_removed(tmp_path: Path) -> None:
    with driver(tmp_path, NAME, 12):
        pass
    set_back(tmp_path, LONGEST_GAP_S - 10)
    assert left_by(tmp_path) == "12 TARE"
    set_back(tmp_path, LONGEST_GAP_S + 10)
    assert left_by(tmp_path) == "none"
    assert not list(tmp_path.glob("*.npz"))


def test_a_calibration_that_was_written_since_goes_before(tmp_path: Path) -> None:
    file = tmp_path / "skin.npz"
    with closing(KeptBaseline(NAME, tmp_path / "kept")) as kept:
        kept.keep(Baseline.none(ROWS, COLS))
        assert kept.take_over(ROWS, COLS, file) is not None
        Baseline.none(ROWS, COLS).save(file)
        set_back(tmp_path, 10)
        assert kept.take_over(ROWS, COLS, file) is not None
        later_s = time.time() + 10
        os.utime(file, (later_s, later_s))
        assert kept.take_over(ROWS, COLS, file) is None


def test_a_driver_that_runs_for_long_is_none_of_long_ago(tmp_path: Path) -> None:
    with closing(KeptBaseline(NAME, tmp_path)) as kept:
        kept.keep(Baseline.none(ROWS, COLS))
        set_back(tmp_path, 10 * LONGEST_GAP_S)
        kept.refresh()
    with closing(KeptBaseline(NAME, tmp_path)) as kept:
        assert kept.take_over(ROWS, COLS) is not None


def test_what_drivers_left_that_died_with_their_launch_is_removed_by_another_one(tmp_path: Path) -> None:
    with closing(KeptBaseline("/one/driver auto", tmp_path)) as alive:
        alive.keep(Baseline.none(ROWS, COLS))
        of_the_living = set(tmp_path.iterdir())
        with driver(tmp_path, "/two/driver auto", 12), driver(tmp_path, "/three/driver auto"):
            pass
        (dead,) = set(tmp_path.glob("*.npz")) - of_the_living
        # One that an error has ended, which gave up its lock.
        with closing(KeptBaseline("/four/driver auto", tmp_path)) as failed:
            failed.keep(Baseline.none(ROWS, COLS))
        dead.with_name(f".{dead.name}.1.2.new").write_bytes(b"half of one")
        # That of the living, too, as where it stood still for so long.
        set_back(tmp_path, LONGEST_GAP_S + 10)
        KeptBaseline(NAME, tmp_path).close()
        assert set(tmp_path.iterdir()) == of_the_living


def test_a_file_that_is_damaged_or_of_another_array_is_refused(tmp_path: Path) -> None:
    with closing(KeptBaseline(NAME, tmp_path)) as kept:
        kept.keep(Baseline.none(ROWS, COLS))
        with pytest.raises(SettingsError, match="6 x 5 taxels, the array has 5 x 6"):
            kept.take_over(COLS, ROWS)
        (path,) = tmp_path.glob("*.npz")
        whole = path.read_bytes()
        path.write_bytes(whole[: len(whole) // 2])
        with pytest.raises(SettingsError, match="again"):
            kept.take_over(ROWS, COLS)


def test_what_a_driver_that_runs_keeps_is_refused_to_another(tmp_path: Path) -> None:
    with (
        closing(KeptBaseline(NAME, tmp_path)),
        pytest.raises(ActsError, match=r"in use by process .*, or a driver that takes over from this one begins"),
    ):
        KeptBaseline(NAME, tmp_path)


def test_a_folder_of_anybody_is_refused(tmp_path: Path) -> None:
    tmp_path.chmod(0o777)
    with pytest.raises(ActsError, match=r"anybody may write to the folder .* begins without its baseline"):
        KeptBaseline(NAME, tmp_path)
