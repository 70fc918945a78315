"""For every test: a loaded machine is slow, which is no failure; signals do what they do in a terminal; recordings."""

import os
import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile("acts", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("acts")

# In the background, or under nohup, these are ignored, and the processes that tests send them to would inherit that.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

RECORDINGS = Path(os.environ.get("ACTS_RECORDINGS") or Path(__file__).resolve().parents[1] / "shared" / "data")


@pytest.fixture(scope="session")
def recording_path() -> Callable[[str], Path]:
    """Where a published recording is; the test that asks for one is skipped where it is not."""

    def path_of(name: str) -> Path:
        path = RECORDINGS / name
        if not path.is_file():
            pytest.skip(f"{path} is absent: no recording is part of the project (docs/development.md, Recordings)")
        return path

    return path_of
