# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate recovery`: the report on recordings whose answer is known."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pressed_frames import press

from acts_core.array import ArrayGeometry
from acts_core.sampling import SamplingConfig
from acts_recon.sparse import Dictionary, load_dictionary, shipped_dictionary_path
from acts_tools.cli import main
from acts_tools.evaluate.images import calibration
from acts_tools.evaluate.images.recovery import Recording, Task, evaluate
from acts_tools.evaluate.images.scores import FRAME_SCORES, score_image
from acts_tools.evaluate.images.truth import contact_starts

pytestmark = pytest.mark.slow

PRESSED = [(r, c) for r in (10, 11, 12) for c in (20, 21)]
LIVE = np.ones((32, 32), dtype=bool)


def still(n: int, taxels: list[tuple[int, int]], counts: int = 400) -> NDArray[np.uint16]:
    frames = np.zeros((n, 32, 32), dtype=np.uint16)
    for row, col in taxels:
        frames[:, row, col] = counts
    return frames


@pytest.fixture(scope="module")
def dictionary() -> Dictionary:
    return load_dictionary(shipped_dictionary_path())


def scored(dictionary: Dictionary, frames: NDArray[np.uint16], method: str = "last", **task: Any) -> dict[str, Any]:
    sampling = task.pop("sampling", SamplingConfig(scheme="tracking", threshold_counts=15))
    return evaluate([Recording(frames, 1000.0, LIVE)], Task(sampling, method, **task), dictionary)


def command(tmp_path: Path, frames: NDArray[np.uint16], *options: str, code: int = 0, **arrays: Any) -> list[dict]:
    np.savez(tmp_path / "frames.npz", frames=frames, **{"rate_hz": 1000.0, **arrays})
    out = tmp_path / "out.json"
    words = ["evaluate", "recovery", "--frames", str(tmp_path / "frames.npz"), "--json", str(out), *options]
    assert main(words) == code
    return json.loads(out.read_text())["results"]


def test_a_press_that_is_seen_whole_is_recovered_without_error(tmp_path: Path) -> None:
    frames = np.concatenate([still(50, []), still(100, PRESSED)])
    (result,) = command(tmp_path, frames, "--method", "last")
    assert (result["scheme"], result["m"], result["method"]) == ("tracking", 55, "last")
    assert result["relative_error"] == 0
    assert result["support_accuracy"] == 1
    assert result["cop_error_taxels"] == {"mean": 0, "median": 0, "p95": 0}
    assert result["invented_rate"] == 0
    assert result["frames"] == pytest.approx(80, abs=2)
    assert result["onset"]["frames"] == pytest.approx(20, abs=2)
    assert 0 <= result["notice_ms"]["p50"] <= result["notice_ms"]["p99"] <= 10
    assert 0 < result["frame_us"]["median"] <= result["frame_us"]["p99"]
    assert result["untouched"]["frames"] == pytest.approx(49, abs=2)


def test_every_scheme_m_and_method_has_its_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    schemes, ms, methods = ["adaptive", "random", "raster"], ["42", "64"], ["zero", "paper"]
    words = ["--scheme", *schemes, "--m", *ms, "--method", *methods, "--seed", "3"]
    results = command(tmp_path, still(30, PRESSED), *words, start=[0, 10], length=[10, 20])
    expected = [(s, 1024 if s == "raster" else int(m), k) for s in schemes for m in ms for k in methods]
    assert [(r["scheme"], r["m"], r["method"]) for r in results] == expected
    out = capsys.readouterr()
    assert len(out.out.splitlines()) == 1 + len(expected)
    # No progress where stderr is no terminal.
    assert out.err == ""


@pytest.mark.parametrize("method", ["acts", "paper", "last"])
def test_of_taxels_that_a_frame_measures_several_times_the_last_samples_count(
    method: str, dictionary: Dictionary
) -> None:
    """As in the node. The frames of 20 samples are of the two taxels once, at their ends."""
    frames = np.zeros((200, 32, 32), dtype=np.uint16)
    frames[:, 10, 20] = frames[:, 10, 21] = np.linspace(200, 800, 200)
    fixed: dict[str, Any] = {"scheme": "fixed", "fixed_row": 10, "fixed_col": 20}
    many = scored(dictionary, frames, method, sampling=SamplingConfig(**fixed, fixed_taxels=2, m=20))
    assert many["m"] == 20
    assert many["frames"] > 100
    once = scored(dictionary, frames, method, sampling=SamplingConfig(**fixed, fixed_taxels=0, m=2))
    assert many["relative_error"] == pytest.approx(once["relative_error"], abs=0.02)


def test_reports_name_a_method_by_one_of_its_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results = command(tmp_path, still(5, PRESSED), "--m", "64", "--method", "fusion", "per_frame", "acts")
    assert [result["method"] for result in results] == ["acts", "paper", "acts"]
    assert results[0]["relative_error"] == results[2]["relative_error"]
    with pytest.raises(SystemExit):
        main(["evaluate", "recovery", "--presses", "1", "--method", "magic"])
    refusal = capsys.readouterr().err
    assert all(name in refusal for name in ("acts", "paper", "fusion", "per_frame"))


def test_broken_taxels_read_nothing_and_those_that_are_told_are_estimated(tmp_path: Path) -> None:
    frames = np.repeat(press(10.3, 12.2, 2.0, 700)[None], 200, axis=0)
    sound, broken, told = (
        command(tmp_path, frames, *words)[0]
        for words in ([], ["--broken-taxels", "row=10"], ["--broken-taxels", "row=10", "--dead-taxels", "row=10"])
    )
    assert sound["relative_error"] < 0.01
    assert broken["relative_error"] > 0.3
    assert told["relative_error"] < 0.1
    assert told["cop_error_taxels"]["mean"] < 0.03 < broken["cop_error_taxels"]["mean"]


def test_frames_of_dead_taxels_alone_are_left_out(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    frames, words = np.full((200, 4, 4), 400, dtype=np.uint16), ["--m", "1", "--scheme", "uniform", "--method", "last"]
    (sound,) = command(tmp_path, frames, *words)
    (broken,) = command(tmp_path, frames, *words, "--dead-taxels", "2,1")
    assert sound["frames"] * 0.9 < broken["frames"] < sound["frames"]
    command(tmp_path, frames, "--m", "1", "--scheme", "fixed", "--dead-taxels", "0,0", code=1)
    assert "in no frame other than dead taxels were measured: let fixed measure others" in capsys.readouterr().err


@pytest.mark.parametrize("option", ["--broken-taxels", "--dead-taxels"])
def test_taxels_outside_of_the_array_are_refused(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    np.savez(tmp_path / "frames.npz", frames=still(5, PRESSED), rate_hz=1000.0)
    assert main(["evaluate", "recovery", "--frames", str(tmp_path / "frames.npz"), option, "col=32"]) == 1
    assert f"{option[2:].replace('-', '_')}: 'col=32' is outside of an array of 32 x 32" in capsys.readouterr().err


def test_options_that_are_given_again_add_to_one_another(tmp_path: Path) -> None:
    words = ["--m", "42", "--method", "zero", "--m", "64", "--method", "last"]
    results = command(tmp_path, still(30, PRESSED), *words)
    expected = [("tracking", 42, "zero"), ("tracking", 42, "last"), ("tracking", 64, "zero"), ("tracking", 64, "last")]
    assert [(r["scheme"], r["m"], r["method"]) for r in results] == expected


def test_a_recording_without_contact_has_no_scores_and_that_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (result,) = command(tmp_path, still(30, []), code=1)
    said = capsys.readouterr().err
    assert "nothing was scored, since no frame ends in a contact" in said
    assert "above --touch-counts 50" in said
    assert result["frames"] == 0
    assert result["relative_error"] is None
    assert result["cop_error_taxels"] == {"mean": None, "median": None, "p95": None}
    assert result["notice_ms"] == {"p50": None, "p99": None}


def test_one_image_against_its_truth() -> None:
    truth, image = np.zeros((2, 32, 32), dtype=np.float32)
    truth[4, 4] = 300
    truth[8, 8] = 40
    image[4, 6] = 300
    out = np.zeros(FRAME_SCORES)
    live = LIVE.copy()
    live[31] = False
    assert score_image(image.ravel(), truth.ravel(), live.ravel(), 32, 50.0, out)
    n = 31 * 32
    centre = (300 * 4 + 40 * 8) / 340
    error, support, cop, touch_cop, invented = out
    assert error == pytest.approx(np.sqrt(2 * 300**2 + 40**2) / np.sqrt(300**2 + 40**2))
    assert support == pytest.approx((n - 4) / n)
    assert cop == pytest.approx(np.hypot(centre - 4, centre - 6))
    assert touch_cop == 2
    assert invented == pytest.approx(1 / (n - 2))
    image[:] = 0
    assert score_image(image.ravel(), truth.ravel(), live.ravel(), 32, 50.0, out)
    assert np.isnan(out[2])
    assert not score_image(image.ravel(), image.ravel(), live.ravel(), 32, 50.0, out)


def test_a_second_contact_counts_as_new_and_one_that_moves_on_does_not() -> None:
    frames = np.concatenate(
        [still(5, []), still(5, PRESSED), still(5, [(10, 22)]), still(5, [(10, 22), (25, 3)]), still(5, [])]
    )
    frames[5, 10, 20] = 60
    starts = contact_starts(frames, LIVE, 50)
    assert [(round(s.onset, 2), s.end, s.alone) for s in starts] == [(4.13, 9, True), (14.13, 19, False)]
    assert set(starts[1].taxels) == {r * 32 + c for r in (24, 25, 26) for c in (2, 3, 4)}


def test_contacts_are_found_wherever_a_long_recording_is_cut_in_pieces() -> None:
    frames = np.zeros((3 * 4096 + 1, 2, 2), dtype=np.uint16)
    begins = [1, 4095, 4097, 8192, 8194, 3 * 4096]
    for begin in begins:
        frames[begin, 1, 1] = 400
    starts = contact_starts(frames, np.ones((2, 2), dtype=bool), 50)
    assert [start.end for start in starts] == begins


def test_a_contact_that_nobody_sees_is_missed(dictionary: Dictionary) -> None:
    frames = np.concatenate([still(20, []), still(3, [(5, 5)]), still(40, [])])
    # The board measures one and the same taxel in each frame.
    sampling = SamplingConfig(scheme="adaptive", m=1)
    result = scored(dictionary, frames, sampling=sampling, onset_s=0.0)
    assert result["contacts"] == result["contacts_missed"] == 1
    assert result["missed"] == 1
    assert result["cop_error_taxels"]["mean"] is None


def test_a_contact_that_nobody_saw_until_the_recording_ended_is_missed(dictionary: Dictionary) -> None:
    frames = np.concatenate([still(20, []), still(40, [(5, 5)])])
    result = scored(dictionary, frames, sampling=SamplingConfig(scheme="adaptive", m=1))
    assert result["contacts"] == result["contacts_missed"] == 1
    assert result["notice_ms"]["p50"] == pytest.approx(40, abs=1.5)


def test_noise_is_added_to_what_is_measured_and_not_to_the_truth(dictionary: Dictionary) -> None:
    sampling = SamplingConfig(scheme="raster", m=1024)
    clean, noisy = (
        scored(dictionary, still(200, PRESSED), sampling=sampling, noise_counts=n, onset_s=0.0) for n in (0, 3)
    )
    assert clean["relative_error"] == 0
    assert 0.02 < noisy["relative_error"] < 0.1


def test_errors_are_counted_in_sigmas_touched_and_untouched_apart() -> None:
    sums = np.zeros(calibration.SUMS)
    sigma = np.full(1024, 10, dtype=np.float32)
    image, truth = np.zeros((2, 1024), dtype=np.float32)
    truth[:4] = 100
    image[:4] = [100, 95, 115, 130]
    image[4:8] = [0, 10, 20, 21]
    live = np.zeros(1024, dtype=bool)
    live[:8] = True
    for _ in range(2):
        calibration.add_errors(image, sigma, truth, live, 50.0, sums)
    result = calibration.summary(sums)
    assert result is not None
    assert result["touched"] == {
        "ratio": pytest.approx(np.sqrt((0.5**2 + 1.5**2 + 3.0**2) / 4)),
        "within_1": 0.5,
        "within_2": 0.75,
    }
    assert result["untouched"] == {
        "ratio": pytest.approx(np.sqrt((1.0 + 4.0 + 2.1**2) / 4)),
        "within_1": 0.5,
        "within_2": 0.75,
    }
    assert calibration.summary(np.zeros(calibration.SUMS)) is None


def test_contacts_are_counted_in_standard_deviations() -> None:
    geometry = ArrayGeometry()
    known = calibration.Calibration(geometry, LIVE, 50.0, 2.0)
    truth, image = np.zeros((2, 32, 32), dtype=np.float32)
    truth[10:14, 10:14] = 300
    image[10:14, 11:15] = 300
    result = calibration.summary(known.errors(image.ravel(), np.full(1024, 2, np.float32), truth.ravel()))
    assert result is not None
    assert list(result) == list(calibration.ROWS)
    # Moved along the columns by a whole taxel, and else as it should be.
    assert result["x"]["ratio"] > 10
    assert result["x"]["within_2"] == 0
    for name in ("y", "force", "area", "spread"):
        assert result[name] == {"ratio": 0, "within_1": 1, "within_2": 1}
    nothing = calibration.summary(known.errors(0 * image.ravel(), np.full(1024, 2, np.float32), truth.ravel()))
    assert nothing is not None
    assert nothing["x"] == {"ratio": None, "within_1": None, "within_2": None}


def test_contacts_err_by_the_noise_that_is_added_as_much_as_they_say(dictionary: Dictionary) -> None:
    """What exceeds a noise of 2 counts was taken for errors that taxels have in common, as in no node that knows it."""
    frames = still(2000, [(row, col) for row in range(10, 16) for col in range(20, 26)])
    raster = SamplingConfig(scheme="raster", m=1024)
    # All taxels are measured at about one time: their errors are the noise alone.
    known = scored(dictionary, frames, "acts", sampling=raster, sample_us=0.01, noise_counts=8.0)["sigma"]
    for name in ("touched", "x", "y", "force"):
        assert 0.9 < known[name]["ratio"] < 1.1


def test_a_method_that_knows_no_sigma_has_no_calibration(dictionary: Dictionary) -> None:
    frames = still(100, PRESSED)
    assert scored(dictionary, frames, "last")["sigma"] is None
    known = scored(dictionary, frames, "acts")
    assert known["sigma"]["touched"] == {"ratio": 0, "within_1": 1, "within_2": 1}
    assert known["onset"]["sigma"]["touched"]["within_2"] > 0.9
    assert known["sigma"]["untouched"]["ratio"] < 0.01


def test_peaks_are_single_frames_held_still(tmp_path: Path) -> None:
    frames = np.concatenate([still(10, PRESSED, counts) for counts in (100, 900, 200)])
    (result,) = command(
        tmp_path, frames, "--peaks", "--onset-s", "0", "--scheme", "raster", start=[0, 15], length=[15, 15]
    )
    assert result["frames"] == 2
    assert result["relative_error"] == 0


def test_single_frames_are_each_sampled_at_other_random_places(dictionary: Dictionary) -> None:
    frame = still(1, [(r, c) for r in range(8, 20) for c in range(8, 20)])
    task = Task(SamplingConfig(scheme="random", m=64, seed=2**64 - 1), "zero", onset_s=0.0)
    first, again = (evaluate([Recording(frame, 1.0, LIVE)] * 8, task, dictionary) for _ in range(2))
    assert first["frames"] == 8
    assert first["cop_error_taxels"]["median"] < first["cop_error_taxels"]["p95"]
    assert again["cop_error_taxels"] == first["cop_error_taxels"]


def test_the_model_is_pressed_where_there_is_no_file(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--presses", "4", "--scheme", "adaptive", "--m", "128", "--method", "paper"]
    assert main(["evaluate", "recovery", *words]) == 0
    assert capsys.readouterr().out.splitlines()[1].startswith("adaptive   128 paper        4 ")


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"rate_hz": np.nan}, "rate_hz"),
        ({"live": np.ones((3, 3))}, "live"),
        ({"start": [0], "length": [9]}, "start and length"),
        ({"frames": np.full((5, 32, 32), np.nan)}, "without NaN"),
        ({"frames": np.full((5, 32, 32), 2000)}, "1023"),
        ({"frames": np.full((5, 32, 32), 4095)}, "divide counts of 12 bits by 4"),
        ({"frames": np.zeros((5, 32))}, r"\(n, rows, cols\)"),
    ],
)
def test_bad_files_are_refused(tmp_path: Path, arrays: dict, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    np.savez(tmp_path / "bad.npz", **{"frames": still(5, []), "rate_hz": 10.0, **arrays})
    assert main(["evaluate", "recovery", "--frames", str(tmp_path / "bad.npz")]) == 1
    assert message.replace("\\", "") in capsys.readouterr().err


def test_frames_in_volts_are_told_from_counts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    np.savez(tmp_path / "volts.npz", frames=np.full((30, 32, 32), 3.3), rate_hz=1000.0)
    assert main(["evaluate", "recovery", "--frames", str(tmp_path / "volts.npz")]) == 1
    assert "the largest count is 3, and only what is above 50 is a contact" in capsys.readouterr().err


def test_files_without_what_is_needed_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    np.savez(tmp_path / "bad.npz", frames=still(5, []))
    assert main(["evaluate", "recovery", "--frames", str(tmp_path / "bad.npz")]) == 1
    assert "rate_hz" in capsys.readouterr().err
    np.savez(tmp_path / "bad.npz", rate_hz=3)
    assert main(["evaluate", "recovery", "--frames", str(tmp_path / "bad.npz")]) == 1
    assert "frames" in capsys.readouterr().err
    assert main(["evaluate", "recovery", "--frames", str(tmp_path / "none.npz")]) == 1
    assert "cannot be read" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        ["recovery", "--presses", "1", "--scheme", "tracking", "uniform"],
        ["events", "--scheme", "tracking", "uniform"],
        ["objects"],
    ],
    ids=lambda words: words[0],
)
def test_each_m_that_a_scheme_cannot_have_is_refused_before_any_work(
    words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in (
        "recovery_command.model_frames",
        "events_command.event_recordings",
        "objects_command.press_recordings",
    ):
        monkeypatch.setattr(f"acts_tools.evaluate.images.{name}", None)
    assert main(["evaluate", *words, "--m", "63", "64", "99"]) == 1
    refusal = capsys.readouterr().err
    assert re.findall(r"uniform, m = (\d+): .*?; the nearest have (\d+) and (\d+)", refusal) == [
        ("63", "56", "64"),
        ("99", "96", "112"),
    ]
    assert "tracking" not in refusal


@pytest.mark.parametrize(
    ("option", "word"),
    [
        ("--rate-hz", "nan"),
        ("--touch-counts", "2000"),
        ("--touch-counts", "-5"),
        ("--m", "2000"),
        ("--noise-counts", "-1"),
        ("--patch-step", "0"),
    ],
)
def test_settings_out_of_range_are_refused(
    option: str, word: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["evaluate", "recovery", "--presses", "1", option, word]) == 1
    assert option.strip("-").replace("-", "_") in capsys.readouterr().err
    assert main(["evaluate", "recovery", "--presses", "1", "--json", str(tmp_path / "no" / "out.json")]) == 1


def test_more_fixed_taxels_than_the_skin_has_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["evaluate", "recovery", "--presses", "1", "--scheme", "fixed", "--fixed-taxels"]
    assert main([*words, "1025"]) == 1
    assert "fixed_taxels = 1025: allowed is 0 to 1024 of a fixed frame of 32 x 32" in capsys.readouterr().err
    assert main([*words, "1024"]) == 0
