# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is said where the tables cannot be written, and where the user cannot be told of them."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from test_export import image, pressed, write_bag

from acts_tools.cli import main
from acts_tools.export import writing
from acts_tools.export.recording import Recording


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    return write_bag(tmp_path / "touch", *(("/plate/image_raw", image(10 * n, pressed(n))) for n in range(6)))


@pytest.mark.parametrize(
    ("stream", "told"), [("/dev/full", "error: No space left on device: make room and try again\n"), ("pipe", "")]
)
def test_an_output_that_the_user_cannot_be_told_of_is_not_said_to_be_unwritable(
    stream: str,
    told: str,
    bag: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    if stream == "pipe":
        reader, writer = os.pipe()
        os.close(reader)
    else:
        writer = os.open(stream, os.O_WRONLY)
    # Of a file of Python's the end would write what is left once more.
    with monkeypatch.context() as patch, suppress(OSError), os.fdopen(writer, "w", buffering=1) as nowhere:
        patch.setattr(sys, "stdout", nowhere)
        assert main(["export", str(bag), "--to", "csv", "-o", str(tmp_path / "out")]) == 1
    assert capfd.readouterr().err == told
    assert list(tmp_path.iterdir()) == [bag]


def test_what_cannot_be_written_is_named(
    bag: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setitem(writing._TABLES, "csv", fail)
    assert main(["export", str(bag), "--to", "csv", "-o", str(tmp_path / "out")]) == 1
    assert f"error: '{tmp_path / 'out'}' cannot be written: No space left on device\n" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [bag]


@pytest.mark.parametrize("kind", ["csv", "npz"])
def test_a_link_to_nowhere_is_refused_before_any_work(
    kind: str, bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    link = tmp_path / "out.npz"
    link.symlink_to("nowhere")
    assert main(["export", str(bag), "--to", kind, "-o", str(link)]) == 1
    said = capsys.readouterr()
    assert f"'{link}' exists already and is not overwritten" in said.err
    assert said.out == ""
    assert link.is_symlink()


@pytest.mark.parametrize("kind", ["npz", "csv"])
def test_what_is_made_of_the_same_name_meanwhile_is_not_overwritten(
    kind: str, bag: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "out.npz"
    write = writing._TABLES[kind]

    def write_beside_another(recording: Recording, path: Path) -> int:
        output.write_text("of another program")
        return write(recording, path)

    monkeypatch.setitem(writing._TABLES, kind, write_beside_another)
    assert main(["export", str(bag), "--to", kind, "-o", str(output)]) == 1
    assert f"error: '{output}' exists already and is not overwritten" in capsys.readouterr().err
    assert output.read_text() == "of another program"
    assert sorted(tmp_path.iterdir()) == [output, bag]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_nothing_is_left_of_an_export_that_is_ended(number: signal.Signals, bag: Path, tmp_path: Path) -> None:
    program = f"""
import os, signal, sys
from acts_tools.cli import main
from acts_tools.export import writing

def write_in_part(recording, folder):
    folder.mkdir(parents=True)
    (folder / "frames.csv").write_text("stamp_ns")
    os.kill(os.getpid(), {int(number)})

# As in a terminal, whatever runs the tests.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGTERM, signal.SIG_DFL)
signal.signal(signal.SIGHUP, signal.SIG_DFL)
writing._TABLES["csv"] = write_in_part
sys.exit(main(["export", {str(bag)!r}, "--to", "csv", "-o", {str(tmp_path / "new" / "out")!r}]))
"""
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60.0, check=False)
    assert (ended.returncode, ended.stderr) == (130, "")
    assert list(tmp_path.iterdir()) == [bag]


@pytest.mark.parametrize("kind", ["csv", "npz", "parquet", "lerobot"])
def test_names_in_another_encoding_than_utf_8_are_taken(kind: str, tmp_path: Path) -> None:
    if kind in ("parquet", "lerobot"):
        pytest.importorskip("pyarrow", reason="./acts run python3 -m pip install pyarrow")
    # The second image is left out, so that there is something to note of the bag.
    path = write_bag(tmp_path / "gr\udcfcn", *(("/plate/image_raw", image(n, pressed(n))) for n in (10, 10, 20)))
    out = tmp_path / "\udcfc.npz"
    words = [sys.executable, "-m", "acts_tools", "export", str(path), "--to", kind, "-o", str(out)]
    note = "1 frame left out, not newer than one before: was a clock set?"
    assert note.encode() in subprocess.run(words, capture_output=True, timeout=60.0, check=True).stderr
    if kind == "npz":
        with np.load(out) as arrays:
            assert arrays["notes"].tolist() == [note]
    else:
        assert (out / "notes.txt").read_bytes() == b"gr\xfcn: " + note.encode() + b"\n"


def test_a_task_in_another_encoding_is_refused_before_any_work(
    bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["export", str(bag), "--to", "lerobot", "-o", str(tmp_path / "out"), "--task", "gr\udcfcn"]
    assert main(words) == 1
    assert "--task 'gr\\udcfcn': needed is UTF-8" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [bag]
