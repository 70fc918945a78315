# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Numbers of figures that another state of the code has computed are not kept."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path

import pytest

from acts_tools.cli import main
from acts_tools.figures import digest, run


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A package that stands for all of ours, with a module, data and no library of the firmware."""
    folder = tmp_path / "computes_figures"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "dictionary.npz").write_bytes(b"atoms")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(digest, "PACKAGES", (folder.name,))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    importlib.invalidate_caches()
    yield folder
    digest.code_digest.cache_clear()


def _digest() -> str:
    digest.code_digest.cache_clear()
    return digest.code_digest()


@pytest.mark.parametrize("name", ["__init__.py", "sub/new.py", "dictionary.npz", "../lib/libacts_sampler.so"])
def test_a_change_of_what_computes_changes_the_digest(package: Path, name: str) -> None:
    before = _digest()
    assert _digest() == before
    (package / "__pycache__").mkdir()
    (package / "__pycache__" / "new.pyc").write_bytes(b"compiled")
    assert _digest() == before
    (package / name).parent.mkdir(exist_ok=True)
    (package / name).write_bytes(b"changed = True")
    assert _digest() != before


def test_the_digest_covers_our_packages_the_dictionary_and_the_firmware() -> None:
    names = [name for name, _ in digest._files()]
    for name in (
        "acts_core/sampling/sampler.py",
        "acts_recon/sparse/dictionaries/patch8_k1000.npz",
        "acts_sim/pressing/__init__.py",
        "acts_control/__init__.py",
        "acts_tools/figures/run.py",
        *digest.LIBRARIES,
    ):
        assert name in names
    assert "acts_tools/figures/drawing/page.py" not in names


def test_a_figure_of_other_code_is_measured_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["figures", "S9", "--fast", "--out", str(tmp_path)]
    told = []
    for code in ("one", "one", "other"):
        monkeypatch.setattr(run, "code_digest", lambda code=code: code)
        assert main(words) == 0
        told.append("as measured before" in capsys.readouterr().out)
    assert told == [False, True, False]
