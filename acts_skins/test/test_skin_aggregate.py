# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The tree of the skins' diagnostics."""

from __future__ import annotations

from acts_skins.overview.aggregate import ERROR, OK, STALE, WARN, Aggregate, Status


def told(aggregate: Aggregate, now_s: float) -> dict[str, Status]:
    return {status.name: status for status in aggregate.step(now_s)}


def all_well(aggregate: Aggregate, now_s: float, *skins: str) -> None:
    for skin in skins:
        for node in ("driver", "reconstruction"):
            aggregate.take(Status(f"{skin}/{node}", OK, "1000 frames/s"), now_s)


def test_where_all_is_well_the_whole_is() -> None:
    aggregate = Aggregate(["left", "right"])
    all_well(aggregate, 0.0, "left", "right")
    statuses = told(aggregate, 1.0)
    assert list(statuses) == [
        "/Skins",
        "/Skins/left",
        "/Skins/left/driver",
        "/Skins/left/reconstruction",
        "/Skins/right",
        "/Skins/right/driver",
        "/Skins/right/reconstruction",
    ]
    assert (statuses["/Skins"].level, statuses["/Skins"].message) == (OK, "2 skins, all well")
    assert statuses["/Skins"].values == {"left": "OK", "right": "OK"}


def test_the_worst_counts_and_names_its_skin() -> None:
    aggregate = Aggregate(["left", "right"])
    all_well(aggregate, 0.0, "left", "right")
    aggregate.take(Status("left/driver", WARN, "3 frames lost"), 0.5)
    statuses = told(aggregate, 1.0)
    assert (statuses["/Skins"].level, statuses["/Skins"].message) == (WARN, "left: driver: 3 frames lost")
    aggregate.take(Status("right/driver", ERROR, "the port is gone"), 0.5)
    whole = told(aggregate, 1.0)["/Skins"]
    assert (whole.level, whole.message) == (
        ERROR,
        "left: driver: 3 frames lost; right: driver: the port is gone",
    )


def test_a_skin_that_falls_silent_is_stale_and_an_error_of_the_whole() -> None:
    aggregate = Aggregate(["left", "right"], stale_after_s=3.0)
    all_well(aggregate, 0.0, "left")
    all_well(aggregate, 5.0, "right")
    statuses = told(aggregate, 5.0)
    assert statuses["/Skins/left"].level == STALE
    assert statuses["/Skins/left/driver"].message == "nothing heard of it for 5 s"
    assert statuses["/Skins"].level == ERROR
    assert "left: driver: nothing heard" in statuses["/Skins"].message
    assert told(aggregate, 20.0)["/Skins"].level == STALE


def test_what_has_never_spoken_is_stale() -> None:
    statuses = told(Aggregate(["left"]), 0.0)
    assert (statuses["/Skins"].level, statuses["/Skins/left/driver"].message) == (STALE, "nothing heard of it yet")


def test_others_than_the_skins_are_left_out_and_the_merging_node_is_not() -> None:
    aggregate = Aggregate(["left"], prefix="robot/")
    for name in (
        "left/driver",
        "robot/arm/driver",
        "robot/left/driver",
        "robot/skin_contacts",
        "robot/left/ball_world",
    ):
        aggregate.take(Status(name, WARN, "x"), 0.0)
    assert list(told(aggregate, 0.0)) == [
        "/Skins",
        "/Skins/left",
        "/Skins/left/driver",
        "/Skins/left/reconstruction",
        "/Skins/left/ball_world",
        "/Skins/skin_contacts",
    ]


def test_a_level_that_does_not_exist_is_taken_for_the_worst() -> None:
    aggregate = Aggregate(["left"])
    aggregate.take(Status("left/driver", 200, "x"), 0.0)
    assert told(aggregate, 0.0)["/Skins/left/driver"].level == STALE


def test_made_up_nodes_keep_none_out_that_every_skin_has() -> None:
    """A skin that was started after them was told to be stale for good."""
    aggregate = Aggregate(["left"])
    for number in range(5000):
        aggregate.take(Status(f"left/node_{number}", 0, "well"), 0.0)
    for name in ("left/driver", "left/reconstruction", "skin_contacts"):
        aggregate.take(Status(name, OK, "here"), 0.0)
    statuses = told(aggregate, 1.0)
    assert (statuses["/Skins"].level, statuses["/Skins/left"].message) == (OK, "all well")
    assert statuses["/Skins/skin_contacts"].message == "here"


def test_made_up_nodes_do_not_pile_up() -> None:
    aggregate = Aggregate(["left"])
    aggregate.take(Status("left/driver", 0, "well"), 0.0)
    for number in range(5000):
        aggregate.take(Status(f"left/node_{number}", 0, "well"), 0.0)
    aggregate.take(Status("left/driver", 2, "gone"), 0.5)
    told = aggregate.step(1.0)
    assert len(told) < 300
    assert any((status.name, status.message) == ("/Skins/left/driver", "gone") for status in told)
