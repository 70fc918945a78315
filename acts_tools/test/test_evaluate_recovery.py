"""`acts evaluate recovery`: the report on recordings whose answer is known."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_tools.cli import main


def still(n: int, taxels: list[tuple[int, int]], counts: int = 400) -> NDArray[np.uint16]:
    frames = np.zeros((n, 32, 32), dtype=np.uint16)
    for row, col in taxels:
        frames[:, row, col] = counts
    return frames


def evaluate(tmp_path: Path, frames: NDArray[np.uint16], *options: str, **arrays: object) -> list[dict]:
    np.savez(tmp_path / "frames.npz", frames=frames, **{"rate_hz": 1000.0, **arrays})
    out = tmp_path / "out.json"
    words = ["evaluate", "recovery", "--frames", str(tmp_path / "frames.npz"), "--json", str(out), *options]
    assert main(words) == 0
    return json.loads(out.read_text())["results"]


def test_a_press_that_is_seen_whole_is_recovered_without_error(tmp_path: Path) -> None:
    pressed = [(r, c) for r in (10, 11, 12) for c in (20, 21)]
    frames = np.concatenate([still(50, []), still(100, pressed)])
    (result,) = evaluate(tmp_path, frames, "--method", "last")
    assert (result["scheme"], result["m"], result["method"]) == ("tracking", 55, "last")
    assert result["relative_error"] == 0
    assert result["support_accuracy"] == 1
    assert result["cop_error_taxels"] == {"mean": 0, "median": 0, "p95": 0}
    assert result["invented_rate"] == 0
    assert result["frames"] == pytest.approx(80, abs=2)
    assert result["onset"]["frames"] == pytest.approx(20, abs=2)
    assert 0 <= result["notice_ms"]["p50"] <= result["notice_ms"]["p99"] <= 10
    assert 0 < result["frame_us"]["median"] <= result["frame_us"]["p99"]


@pytest.mark.parametrize("arrays", [{"rate_hz": np.nan}, {"live": np.ones((3, 3))}, {"start": [0], "length": [9]}])
def test_bad_files_are_refused(tmp_path: Path, arrays: dict, capsys: pytest.CaptureFixture[str]) -> None:
    np.savez(tmp_path / "bad.npz", frames=still(5, []), **{"rate_hz": 10.0, **arrays})
    assert main(["evaluate", "recovery", "--frames", str(tmp_path / "bad.npz")]) == 1
    assert "error: " in capsys.readouterr().err


def test_a_file_without_a_rate_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    np.savez(tmp_path / "bad.npz", frames=still(5, []))
    assert main(["evaluate", "recovery", "--frames", str(tmp_path / "bad.npz")]) == 1
    assert "rate_hz" in capsys.readouterr().err
