# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A process whose kernels are in the cache compiles nothing: not at its start, and not for its first frames."""

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow

# Everything from bytes of the board to the contact, and what listeners add to it.
HOT_PATH = """
import sys
from acts_core.kernels import skip_extras
import numba
import numpy as np
from numba.core import event

recording = event.install_recorder("numba:compile")
recorder = recording.__enter__()

from acts_core.array import ArrayGeometry
from acts_core.frames import SampleFrame, Scheme
from acts_core.wire import StreamDecoder, encode_frame
from acts_driver.baseline.baseline_tracker import BaselineTracker
from acts_driver.stream import FrameStream
from acts_recon.images.baseline import BaselineSubtraction
from acts_recon.contacts.blob_tracker import BlobTracker
from acts_recon.images.image import mono16, rgb8
from acts_recon.settings import ReconstructionSettings

skip_extras()
decoder, stream, baseline = StreamDecoder(), FrameStream(32, 32), BaselineTracker(32, 32)
subtraction, recovery = BaselineSubtraction(1024), ReconstructionSettings().recovery()
contacts = BlobTracker(ArrayGeometry(), recovery.response)
made = len(recorder.buffer)
counts = np.full(55, 300, dtype=np.uint16)
for number in range(30):
    indices = ((np.arange(55) * 7 + number * 13) % 1024).astype(np.uint16)
    frame = SampleFrame(number, number * 1000, 900, Scheme.TRACKING, 32, 32, 0, indices, counts)
    accepted = stream.accept(decoder.feed(encode_frame(frame)), 10**18 + number * 1_000_000)
    baseline.observe(accepted)
    for one, stamp_ns in accepted:
        if number == 15:
            subtraction.set(np.full(1024, 2, dtype=np.float32), np.ones(1024, dtype=np.bool_))
        less = subtraction.apply(one.indices, one.counts)
        recovery.step(one.indices, less, stamp_ns * 1e-9, 9e-4)
        contacts.step(recovery.image, stamp_ns * 1e-9, recovery.sigma)
        mono16(recovery.image), rgb8(recovery.image, scale=10, full_scale_counts=1023.0), recovery.confidence()
assert stream.statistics.frames == 30
at_frames = len(recorder.buffer) - made
numba.njit(lambda: 1)()
assert len(recorder.buffer) > made + at_frames, "compiling is not seen"
heavy = {"coverage", "scipy"} & set(sys.modules)
assert not heavy, f"{heavy} would be a quarter of a node's start"
print("compiled at the start:", made, "and for frames:", at_frames)
"""


def run_hot_path() -> str:
    finished = subprocess.run(
        [sys.executable, "-c", HOT_PATH], capture_output=True, text=True, timeout=300, env=dict(os.environ)
    )
    assert finished.returncode == 0, finished.stderr
    return finished.stdout.strip()


def test_a_warm_start_compiles_nothing() -> None:
    # The first may have to.
    run_hot_path()
    assert run_hot_path() == "compiled at the start: 0 and for frames: 0"
