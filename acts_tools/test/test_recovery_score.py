"""Quality of the shipped dictionary: thresholds lie 10 to 50 % above what was measured (docs/reconstruction.md)."""

from pathlib import Path

import numpy as np
import pytest

from acts_core.frames_file import load_frames
from acts_core.sampling import SamplingConfig
from acts_recon.dictionary import Dictionary, load_dictionary
from acts_sim.objects import OBJECTS
from acts_tools.recovery_score import RecoveryScore, main, score_recovery
from acts_tools.train import model_frames

ROOT = Path(__file__).resolve().parents[2]
SHIPPED = ROOT / "config" / "dictionaries" / "patch8_k1000.npz"
GRASPS = ROOT.parent / "shared" / "data" / "sdh_weiss" / "grasps_canvas.npz"


@pytest.fixture(scope="module")
def shipped() -> Dictionary:
    return load_dictionary(SHIPPED, patch_size=8)


def dct_dictionary() -> Dictionary:
    """An overcomplete cosine dictionary, 31 x 31 atoms, as a baseline."""
    position, frequency = np.arange(8)[:, None], np.arange(31)[None, :]
    basis = np.cos(np.pi * (position + 0.5) * frequency / 31)
    basis[:, 1:] -= basis[:, 1:].mean(axis=0)
    basis /= np.linalg.norm(basis, axis=0)
    return Dictionary(np.kron(basis, basis), 8)


def sampling(m: int) -> SamplingConfig:
    return SamplingConfig(scheme="adaptive", m=m, threshold_counts=50)


def test_the_shipped_dictionary_says_where_it_is_from_and_is_small(shipped: Dictionary) -> None:
    assert shipped.atoms.shape == (64, 1000)
    np.testing.assert_allclose(np.linalg.norm(shipped.atoms, axis=0), 1, rtol=1e-5)
    assert shipped.settings["sparsity"] == 13
    assert "contact model" in shipped.provenance
    assert SHIPPED.stat().st_size <= 400_000


@pytest.mark.parametrize(("m", "relative_error", "cop_error"), [(56, 0.62, 2.2), (128, 0.165, 0.5), (256, 0.045, 0.13)])
def test_quality_on_the_contact_model(shipped: Dictionary, m: int, relative_error: float, cop_error: float) -> None:
    frames = model_frames(list(OBJECTS.values()), 120, seed=11)
    live = np.ones((32, 32), dtype=bool)
    score = score_recovery(frames, live, shipped, sampling(m))
    assert score.frames >= 110
    assert score.relative_error < relative_error
    assert score.cop_error_taxels < cop_error
    cosine = score_recovery(frames, live, dct_dictionary(), sampling(m))
    assert score.relative_error < 0.95 * cosine.relative_error


@pytest.mark.parametrize(("m", "relative_error", "cop_error"), [(56, 0.58, 6.3), (128, 0.215, 3.1), (256, 0.045, 0.23)])
def test_quality_on_real_grasps(shipped: Dictionary, m: int, relative_error: float, cop_error: float) -> None:
    if not GRASPS.exists():
        pytest.skip(f"the shared recordings are not here ({GRASPS})")
    recorded = load_frames(GRASPS)
    score = score_recovery(recorded.peak_frames(), recorded.live, shipped, sampling(m))
    assert score.frames == 425
    assert score.relative_error < relative_error
    assert score.cop_error_taxels < cop_error


def test_everything_measured_is_no_error(shipped: Dictionary) -> None:
    frames = model_frames(list(OBJECTS.values()), 5, seed=2)
    score = score_recovery(frames, np.ones((32, 32), dtype=bool), shipped, SamplingConfig(scheme="raster", m=1024))
    assert score == RecoveryScore(5, 0.0, 0.0, 0.0, score.frame_us)


def test_the_table_is_printed_and_errors_are_told(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    frames = tmp_path / "f.npz"
    np.savez(frames, frames=model_frames(list(OBJECTS.values()), 4, seed=2))
    assert main(["--frames", str(frames), "--dictionary", str(SHIPPED), "-m", "128"]) == 0
    assert "patch8_k1000.npz" in capsys.readouterr().out
    assert main(["--frames", str(frames), "--dictionary", f"{SHIPPED}:atoms", "-m", "128", "--twin"]) == 0
    assert "NumPy" in capsys.readouterr().out
    assert main(["--frames", str(frames), "--dictionary", f"{SHIPPED}:nothing"]) == 1
    assert "no array 'nothing'" in capsys.readouterr().err
    assert main(["--frames", str(tmp_path / "none.npz")]) == 1
    assert "error: " in capsys.readouterr().err
