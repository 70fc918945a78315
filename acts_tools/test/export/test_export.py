# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Touch of a bag as tables: what belongs together, and what each format holds."""

from __future__ import annotations

import csv
import json
import sys
from array import array
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point
from numpy.typing import NDArray
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Header

from acts_core.errors import RecordingError
from acts_core.files import export_recording, load_frames
from acts_driver.replay import ReplayOptions
from acts_driver.replay import open_recording as open_samples
from acts_msgs.msg import Baseline, Contact, Contacts, TactileSamples, TrackedContact
from acts_recon.settings import ReconstructionSettings
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.writing import BagWriter
from acts_tools.cli import main
from acts_tools.export.recording import Row, open_recording
from acts_tools.export.topics import Choice

BEGIN_MS = 1_700_000_000_000
SIDE = 32


def header(time_ms: int) -> Header:
    seconds, rest = divmod(BEGIN_MS + time_ms, 1000)
    return Header(stamp=Time(sec=seconds, nanosec=rest * 1_000_000))


def pressed(number: int) -> NDArray[np.uint16]:
    """A press that moves to the right."""
    row, col = np.indices((SIDE, SIDE))
    return np.rint(800 * np.exp(-((row - 10) ** 2 + (col - 8 - number) ** 2) / 9)).astype(np.uint16)


def image(time_ms: int, counts: NDArray[np.uint16]) -> Image:
    rows, cols = counts.shape
    data = array("B", counts.astype("<u2").tobytes())
    return Image(header=header(time_ms), height=rows, width=cols, encoding="mono16", step=2 * cols, data=data)


def samples(time_ms: int, counts: NDArray[np.uint16]) -> TactileSamples:
    return TactileSamples(
        header=header(time_ms),
        sequence=time_ms,
        scheme=TactileSamples.SCHEME_RASTER,
        rows=counts.shape[0],
        cols=counts.shape[1],
        indices=array("H", np.arange(counts.size, dtype=np.uint16).tobytes()),
        counts=array("H", counts.tobytes()),
    )


def joints(time_ms: int, **positions: float) -> JointState:
    return JointState(header=header(time_ms), name=list(positions), position=array("d", positions.values()))


def contact(time_ms: int, force_n: float) -> Contact:
    return Contact(header=header(time_ms), in_contact=True, centre_of_pressure=Point(x=0.01), force=force_n)


def contacts(time_ms: int, *numbers: int) -> Contacts:
    return Contacts(header=header(time_ms), contacts=[TrackedContact(number=n, force=float(n)) for n in numbers])


def write_bag(path: Path, *messages: tuple[str, Any]) -> Path:
    bag, definitions, handles = BagWriter(path), Definitions(), dict[str, Any]()
    for topic, message in messages:
        if topic not in handles:
            name = f"{type(message).__module__.split('.')[0]}/msg/{type(message).__name__}"
            handles[topic] = bag.add_topic(topic, name, *definitions.describe(name), [])
        bag.write(handles[topic], serialize_message(message))
    bag.close()
    return path


def rows_of(bag: Path, **choice: Any) -> tuple[list[Row], int]:
    with open_recording(bag, Choice(**choice)) as recording:
        return list(recording.rows()), recording.early + recording.backward


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """Images, contacts and joints of two publishers, of which the second is heard at 25 ms."""
    return write_bag(
        tmp_path / "touch",
        ("/joint_states", joints(5, knee=0.5)),
        *(("/plate/image_raw", image(10 * n, pressed(n))) for n in range(6)),
        *(("/plate/contact", contact(10 * n, float(n))) for n in range(6)),
        *(("/plate/contacts", contacts(10 * n, *range(1, n))) for n in range(6)),
        ("/joint_states", joints(25, hip=2.5)),
        ("/joint_states", joints(38, knee=0.75)),
    )


def test_each_frame_has_what_was_newest_when_it_was_measured(bag: Path) -> None:
    rows, left_out = rows_of(bag)
    assert [row.time_s for row in rows] == pytest.approx([0.0, 0.01, 0.02])
    assert left_out == 3, "frames from before all joints had been told"
    assert [row.stamp_ns // 1_000_000 - BEGIN_MS for row in rows] == [30, 40, 50]
    assert all(np.array_equal(row.image, pressed(n)) for n, row in enumerate(rows, start=3))
    assert [row.contact[3] for row in rows if row.contact is not None] == [3.0, 4.0, 5.0]
    assert [row.contacts[:, 0].tolist() for row in rows if row.contacts is not None] == [
        [1, 2],
        [1, 2, 3],
        [1, 2, 3, 4],
    ]
    assert [row.joints.tolist() for row in rows if row.joints is not None] == [[0.5, 2.5], [0.75, 2.5], [0.75, 2.5]]
    assert [row.joints_age_s for row in rows] == pytest.approx([0.005, 0.002, 0.012])


def test_rows_at_a_rate_repeat_the_newest_frame_and_say_how_old_it_is(bag: Path) -> None:
    rows, left_out = rows_of(bag, rate_hz=250.0)
    assert left_out == 2, "frames from before all joints had been told, but for the newest"
    assert [row.stamp_ns // 1_000_000 - BEGIN_MS for row in rows] == [25, 29, 33, 37, 41, 45, 49]
    assert [row.image_age_s for row in rows] == pytest.approx([0.005, 0.009, 0.003, 0.007, 0.001, 0.005, 0.009])
    assert [int(row.image[10].argmax()) - 8 for row in rows] == [2, 2, 3, 3, 4, 4, 4]


def test_a_long_pause_is_not_filled(tmp_path: Path) -> None:
    path = write_bag(
        tmp_path / "b", ("/plate/image_raw", image(0, pressed(0))), ("/plate/image_raw", image(99_000, pressed(1)))
    )
    with pytest.raises(RecordingError, match=r"no frame of /plate for 99 s.*--rate 0"):
        rows_of(path, rate_hz=10.0)
    assert len(rows_of(path)[0]) == 2


def test_a_long_pause_before_all_topics_have_come_is_not_to_be_filled(tmp_path: Path) -> None:
    """As where the skin was tried before the robot was switched on."""
    frames = [("/plate/image_raw", image(time_ms, pressed(1))) for time_ms in (0, 20, 100_000, 100_020, 100_040)]
    bag = write_bag(tmp_path / "bag", *frames[:2], ("/joint_states", joints(100_005, knuckle=1.0)), *frames[2:])
    rows, _ = rows_of(bag, rate_hz=100.0)
    assert [round(row.image_age_s, 3) for row in rows] == [0.005, 0.015, 0.005, 0.015]
    bag = write_bag(tmp_path / "other", *frames[:2], ("/joint_states", joints(10_000, knuckle=1.0)), *frames[2:])
    with pytest.raises(RecordingError, match="has no frame of /plate for 90 s; rows are repeated for at most 60 s"):
        rows_of(bag, rate_hz=100.0)


def test_frames_that_go_back_in_time_are_left_out(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "b", *(("/plate/image_raw", image(t, pressed(0))) for t in (10, 20, 20, 5, 30)))
    rows, left_out = rows_of(path)
    assert len(rows) == 3
    assert left_out == 2


@pytest.mark.parametrize("before", [0, 2])
def test_images_and_contacts_are_recovered_from_samples_as_the_node_does(before: int, tmp_path: Path) -> None:
    """Also where the recorder heard the baseline, which is latched, after the first samples."""
    noise = np.full(SIDE * SIDE, 30.0, dtype=np.float32)
    baseline = Baseline(
        header=header(-100),
        rows=SIDE,
        cols=SIDE,
        baseline=array("f", noise),
        noise=array("f", noise),
        valid=[True] * noise.size,
    )
    messages: list[tuple[str, Any]] = [("/plate/samples", samples(n, pressed(n) + np.uint16(30))) for n in range(3)]
    messages.insert(before, ("/plate/baseline", baseline))
    path = write_bag(tmp_path / "b", *messages)
    rows, _ = rows_of(path)
    recovery = ReconstructionSettings().recovery()
    for number, row in enumerate(rows):
        end_s = (BEGIN_MS + number) * 1e-3
        found = recovery.step(np.arange(SIDE * SIDE, dtype=np.uint16), pressed(number).ravel(), end_s, 0.0)
        assert np.array_equal(row.image, np.rint(recovery.image))
        assert row.contact is not None
        assert row.contact[3] == pytest.approx(found.force_n)
        assert row.contacts is not None
        assert row.contacts[:, 0].tolist() == [1.0]


def test_samples_from_before_the_baseline_was_determined_stay_as_they_are(tmp_path: Path) -> None:
    size = SIDE * SIDE
    baseline = Baseline(
        header=header(15),
        rows=SIDE,
        cols=SIDE,
        baseline=array("f", [30.0] * size),
        noise=array("f", [0.0] * size),
        valid=[True] * size,
    )
    path = write_bag(
        tmp_path / "b",
        *(("/plate/samples", samples(t, np.full((SIDE, SIDE), 30, np.uint16))) for t in (10, 20)),
        ("/plate/baseline", baseline),
        ("/plate/samples", samples(30, np.full((SIDE, SIDE), 30, np.uint16))),
    )
    rows, _ = rows_of(path)
    assert [int(row.image.max()) for row in rows] == [30, 0, 0]


def test_csv(bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["export", str(bag), "--to", "csv", "-o", str(out)]) == 0
    said = capsys.readouterr()
    assert "3 rows of /plate, 2 joint columns\n" in said.out
    assert "3 frames left out, from before all else in the bag had come once" in said.err
    with (out / "frames.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [int(row["stamp_ns"]) for row in rows] == [(BEGIN_MS + t) * 1_000_000 for t in (30, 40, 50)]
    assert [float(row["contact.force_n"]) for row in rows] == [3.0, 4.0, 5.0]
    assert [float(row["knee.position"]) for row in rows] == [0.5, 0.75, 0.75]
    assert int(rows[0]["taxel_10_11"]) == pressed(3)[10, 11] == 800
    with (out / "contacts.csv").open() as file:
        assert [(row["row"], row["number"]) for row in csv.DictReader(file)][:3] == [("0", "1"), ("0", "2"), ("1", "1")]


def test_npz(bag: Path, tmp_path: Path) -> None:
    out = tmp_path / "touch.npz"
    assert main(["export", str(bag), "--to", "npz", "-o", str(out)]) == 0
    with np.load(out) as arrays:
        assert np.array_equal(arrays["image"], [pressed(n) for n in (3, 4, 5)])
        assert arrays["hip.position"].tolist() == [2.5, 2.5, 2.5]
        assert arrays["contacts.number"].tolist() == [1, 2, 1, 2, 3, 1, 2, 3, 4]
        assert arrays["contacts.row"].tolist() == [0, 0, 1, 1, 1, 2, 2, 2, 2]


def test_parquet(bag: Path, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="./acts run python3 -m pip install pyarrow")
    out = tmp_path / "out"
    assert main(["export", str(bag), "--to", "parquet", "-o", str(out)]) == 0
    frames = parquet.read_table(out / "frames.parquet")
    size = {key.decode(): int(value) for key, value in frames.schema.field("image").metadata.items()}
    images = np.array(frames["image"].to_pylist()).reshape(-1, size["rows"], size["cols"])
    assert np.array_equal(images, [pressed(n) for n in (3, 4, 5)])
    assert frames["contact.force_n"].to_pylist() == [3.0, 4.0, 5.0]
    assert parquet.read_table(out / "contacts.parquet")["number"].to_pylist() == [1, 2, 1, 2, 3, 1, 2, 3, 4]


@pytest.mark.parametrize("kind", ["parquet", "lerobot"])
def test_without_pyarrow_it_is_said_how_to_install_it(
    kind: str, bag: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    assert main(["export", str(bag), "--to", kind, "-o", str(tmp_path / "out")]) == 1
    assert "pip install pyarrow" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--skin", "foot"], "has no skin /foot; it has /plate"),
        (["--joints", "/arm"], "no joint states on /arm; it has /joint_states"),
        (["--rate", "-1"], "--rate -1: for npz allowed is 0, or 0.001 to 10000"),
        (["--rate", "1e-300"], "--rate 1e-300: for npz allowed is 0, or 0.001 to"),
        (["--rate", "nan"], "--rate nan"),
        (["second"], "2 bags: of several only a LeRobot dataset"),
    ],
)
def test_what_cannot_be_exported_is_refused(
    options: list[str], message: str, bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", str(bag), *options, "--to", "npz", "-o", str(tmp_path / "out.npz")]) == 1
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out.npz").exists()


@pytest.mark.parametrize("name", ["out", "out.NPZ", "new/out.csv"])
def test_an_npz_file_has_a_name_by_which_it_is_read_again(
    name: str, bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = sorted(tmp_path.iterdir())
    assert main(["export", str(bag), "--to", "npz", "-o", str(tmp_path / name)]) == 1
    assert f"{name}': no name of an npz file; allowed are names that end in .npz" in capsys.readouterr().err
    assert sorted(tmp_path.iterdir()) == before


def test_what_was_exported_at_a_rate_can_be_evaluated(bag: Path, tmp_path: Path) -> None:
    out = tmp_path / "touch.npz"
    assert main(["export", str(bag), "--to", "npz", "--rate", "100", "-o", str(out)]) == 0
    recorded = load_frames(out)
    assert recorded.rate_hz == 100.0
    assert np.array_equal(recorded.frames, [pressed(n) for n in (2, 3, 4)])
    assert len(list(open_samples(ReplayOptions(out)).frames())) > 0


def test_what_was_exported_at_a_rate_can_be_pressed_into_a_virtual_board(bag: Path, tmp_path: Path) -> None:
    out = tmp_path / "touch.npz"
    assert main(["export", str(bag), "--to", "npz", "--rate", "100", "-o", str(out)]) == 0
    assert export_recording(out, tmp_path / "touch.npy").rate_hz == 100.0
    assert np.array_equal(np.load(tmp_path / "touch.npy"), [pressed(n) for n in (2, 3, 4)])


def test_what_was_exported_without_a_rate_says_how_to_be_of_use(
    bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "touch.npz"
    assert main(["export", str(bag), "--to", "npz", "-o", str(out)]) == 0
    assert main(["evaluate", "recovery", "--frames", str(out)]) == 1
    told = capsys.readouterr().err
    assert "has no rate_hz" in told
    assert "export the bag again with --rate 100" in told
    with pytest.raises(RecordingError, match="export the bag again with --rate 100"):
        open_samples(ReplayOptions(out))


def test_nothing_is_overwritten_and_several_skins_ask_for_a_choice(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_bag(tmp_path / "b", *((f"/{name}/image_raw", image(1, pressed(0))) for name in ("foot", "plate")))
    assert main(["export", str(path), "--to", "npz", "-o", str(path)]) == 1
    assert "exists already" in capsys.readouterr().err
    assert main(["export", str(path), "--to", "npz", "-o", str(tmp_path / "n.npz")]) == 1
    assert "skins /foot, /plate: choose one with --skin" in capsys.readouterr().err
    assert main(["export", str(path), "--to", "npz", "-o", str(tmp_path / "n.npz"), "--skin", "foot"]) == 0


def test_lerobot_rate_is_a_whole_number(bag: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", str(bag), "--to", "lerobot", "--rate", "0.5"]) == 1
    assert "a whole number from 1" in capsys.readouterr().err


def test_lerobot_dataset_is_as_its_description_says(bag: Path, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="./acts run python3 -m pip install pyarrow")
    import pyarrow as pa

    out = tmp_path / "out"
    words = ["export", str(bag), str(bag), "--to", "lerobot", "--rate", "100", "--task", "press", "-o", str(out)]
    assert main(words) == 0
    info = json.loads((out / "meta/info.json").read_text())
    assert (info["codebase_version"], info["fps"]) == ("v3.0", 100)
    assert (info["total_episodes"], info["total_frames"]) == (2, 6)
    features = info["features"]
    assert {"observation.images.plate", "observation.tactile.plate", "observation.state"} <= set(features)
    assert features["observation.state"]["names"] == ["knee.position", "hip.position"]
    statistics = json.loads((out / "meta/stats.json").read_text())
    episodes = parquet.read_table(out / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    for number, episode in enumerate(episodes):
        place = {"chunk_index": episode["data/chunk_index"], "file_index": episode["data/file_index"]}
        table = parquet.read_table(out / info["data_path"].format(**place))
        assert table.column_names == list(features)
        for name, feature in features.items():
            column, kind = table[name], table.schema.field(name).type
            # What lerobot's tools can write again: pictures, and rows of numbers.
            assert feature["dtype"] == "image" or len(feature["shape"]) == 1
            assert (
                feature["names"] is None or feature["dtype"] == "image" or len(feature["names"]) == feature["shape"][0]
            )
            if feature["dtype"] == "image":
                assert kind == pa.struct([("bytes", pa.binary()), ("path", pa.string())])
            else:
                values = np.array(column.to_pylist())
                assert values.shape[1:] == tuple(feature["shape"]) or feature["shape"] == [1]
                while pa.types.is_list(kind) or pa.types.is_fixed_size_list(kind):
                    kind = kind.value_type
                assert kind == pa.from_numpy_dtype(np.dtype(feature["dtype"]))
                assert np.shape(statistics[name]["mean"]) == tuple(feature["shape"])
                assert np.shape(episode[f"stats/{name}/q99"]) == tuple(feature["shape"])
        assert (episode["episode_index"], episode["tasks"], episode["length"]) == (number, ["press"], table.num_rows)
        assert table["index"].to_pylist() == list(range(episode["dataset_from_index"], episode["dataset_to_index"]))
        assert np.allclose(table["timestamp"].to_pylist(), np.arange(3) / 100)
    tasks = parquet.read_table(out / "meta/tasks.parquet")
    assert tasks.to_pylist() == [{"task_index": 0, "task": "press"}]
    assert json.loads(tasks.schema.metadata[b"pandas"])["index_columns"] == ["task"]


def test_lerobot_pictures_and_counts_are_those_of_the_skin(bag: Path, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="./acts run python3 -m pip install pyarrow")
    import io

    from PIL import Image as PngImage

    out = tmp_path / "out"
    assert main(["export", str(bag), "--to", "lerobot", "--rate", "100", "-o", str(out)]) == 0
    table = parquet.read_table(out / "data/chunk-000/file-000.parquet")
    assert np.array_equal(np.reshape(table["observation.tactile.plate"][0].as_py(), (SIDE, SIDE)), pressed(2))
    assert np.reshape(table["observation.contacts.plate"][0].as_py(), (16, 9))[:3, 0].tolist() == [1.0, 0.0, 0.0]
    picture = np.array(PngImage.open(io.BytesIO(table["observation.images.plate"][0].as_py()["bytes"])))
    assert picture.shape == (SIDE, SIDE, 3)
    assert np.array_equal(picture[..., 0], np.rint(pressed(2) * (255 / 1023)))


def test_lerobot_episodes_must_have_the_same_columns(
    bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("pyarrow", reason="./acts run python3 -m pip install pyarrow")
    other = write_bag(tmp_path / "other", *(("/plate/image_raw", image(t, pressed(0))) for t in (0, 100)))
    assert main(["export", str(bag), str(other), "--to", "lerobot", "-o", str(tmp_path / "out")]) == 1
    assert "has other columns than the recordings before" in capsys.readouterr().err
