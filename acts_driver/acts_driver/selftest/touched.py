# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The skin under a rolling hand: lines that never respond, lines that respond as one, taxels that do not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.words import counted
from acts_driver.selftest.findings import Finding, Level, Thresholds, listed, taxels_listed
from acts_driver.selftest.record import FrameRecord
from acts_driver.selftest.same_lines import address_bits, groups_of, same_pairs
from acts_driver.selftest.untouched import Untouched, high_taxels, judge_high

_SATURATED = 0.97 * COUNT_MAX
_FIRST_ADDRESS_PIN = 33


@dataclass(frozen=True, eq=False)
class Touched:
    """How each taxel responds.

    Attributes
    ----------
    response_counts : np.ndarray [shape=(rows, cols), dtype=float64]
        The third largest rise over the baseline; 0 for none.
    responds : np.ndarray [shape=(rows, cols), dtype=bool]
        Whether that is a response.
    same_rows, same_cols : list of tuple of int
        Lines that respond as one.
    broken_bits : tuple of int
        Bits of the multiplexer's address that explain columns that respond as one.
    """

    response_counts: NDArray[np.float64]
    responds: NDArray[np.bool_]
    same_rows: list[tuple[int, ...]]
    same_cols: list[tuple[int, ...]]
    broken_bits: tuple[int, ...]


def measure_touched(record: FrameRecord, skin: Untouched, thresholds: Thresholds) -> Touched:
    """Responses of the taxels from frames in which the whole skin was pressed."""
    pictures = record.sweeps()
    shape = (record.rows, record.cols)
    if len(pictures) < 3:
        return Touched(np.zeros(shape), np.zeros(shape, dtype=bool), [], [], ())
    raised = np.nan_to_num(pictures - np.nan_to_num(skin.baseline_counts)).astype(np.float32)
    # Not the largest: one spike is no response.
    response = np.maximum(np.partition(raised, -3, axis=0)[-3], 0.0).astype(np.float64)
    limit = np.maximum(thresholds.response_counts, thresholds.response_sigmas * np.nan_to_num(skin.noise_counts))
    usable = np.where((pictures > _SATURATED) | (skin.baseline_counts > thresholds.high_counts), np.nan, raised)
    limit_counts = float(np.median(limit))
    takes = _scan_share(record)
    rows = same_pairs(usable, limit_counts, thresholds, takes_share=takes)
    cols = same_pairs(usable.transpose(0, 2, 1), limit_counts, thresholds, takes_share=takes / record.rows)
    bits, cols = address_bits(cols, record.cols, response.max(axis=0) > limit_counts)
    return Touched(response, response > limit, groups_of(rows), groups_of(cols), bits)


def judge_touched(touch: Touched, skin: Untouched, thresholds: Thresholds) -> list[Finding]:
    """What of this is a fault."""
    high = high_taxels(skin, thresholds)
    if touch.responds.mean() < thresholds.line_silent:
        silent = Finding(
            Level.FAIL,
            "touch",
            f"only {int(touch.responds.sum())} of {touch.responds.size} taxels responded",
            "roll a hand over the whole skin while it asks for it; if you did, nothing of the skin is connected",
        )
        return [silent, judge_high(skin, thresholds)] if high else [silent]
    stuck = tuple(taxel for taxel in high if not touch.responds[taxel])
    loaded = tuple(taxel for taxel in high if touch.responds[taxel])
    rows, cols = touch.responds.shape
    # A line whose only taxel is stuck is not open: it reads something.
    open_rows, unpressed_rows = _silent(touch.responds.mean(axis=1), {row for row, _ in stuck if cols == 1}, thresholds)
    open_cols, unpressed_cols = _silent(touch.responds.mean(axis=0), {col for _, col in stuck if rows == 1}, thresholds)
    sound = np.ones(touch.responds.shape, dtype=bool)
    sound[list(open_rows)] = False
    sound[:, list(open_cols)] = False
    for taxel in stuck:
        sound[taxel] = False
    dead, weak = _quiet(touch, sound, thresholds)
    for taxel in dead:
        sound[taxel] = False
    return [
        *_lines("rows", "row", open_rows, touch.same_rows),
        *_lines("columns", "column", open_cols, touch.same_cols),
        _address(touch.broken_bits),
        _stuck(stuck, loaded, skin),
        *_taxels(dead, weak),
        _coverage(touch.responds[sound], unpressed_rows, unpressed_cols, thresholds),
    ]


def _scan_share(record: FrameRecord) -> float:
    """Which share of the time from one picture to the next lies between its first row and its last."""
    size = record.rows * record.cols
    full = [frame for frame in record.frames if len(frame.indices) == size]
    if len(full) < len(record.frames) or len(full) < 2:
        return 0.0
    period_us = (record.arrivals_ns[-1] - record.arrivals_ns[0]) / 1000 / (len(full) - 1)
    return float(min(np.median([frame.duration_us for frame in full]) / max(period_us, 1e-9), 1.0))


def _silent(
    shares: NDArray[np.float64], left_out: set[int], thresholds: Thresholds
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Lines that never respond, with lines beside them that do: open. And those of which that cannot be said.

    In come the share of each line's taxels that respond, and the lines that are not judged.
    """
    judged = [line for line in range(len(shares)) if line not in left_out]
    alive = shares[judged]
    silent = alive <= thresholds.line_silent
    open_lines: list[int] = []
    unpressed: list[int] = []
    line = 0
    while line < len(alive):
        end = line
        while end < len(alive) and silent[end]:
            end += 1
        if end > line:
            beside = [alive[i] for i in (line - 1, end) if 0 <= i < len(alive)]
            is_open = beside and min(beside) >= thresholds.line_alive and end - line <= len(alive) // 2
            (open_lines if is_open else unpressed).extend(judged[line:end])
        line = max(end, line + 1)
    return tuple(open_lines), tuple(unpressed)


def _lines(plural: str, singular: str, broken: tuple[int, ...], same: list[tuple[int, ...]]) -> list[Finding]:
    is_rows = plural == "rows"
    if broken:
        first = Finding(
            Level.FAIL,
            f"open {plural}",
            f"{singular if len(broken) == 1 else plural} {listed(broken)} never responded, the lines beside did",
            f"check the connection of the {singular} from the skin to its pin, and press there again",
            rows=broken if is_rows else (),
            cols=() if is_rows else broken,
        )
    else:
        first = Finding(Level.PASS, f"open {plural}", "none")
    if same:
        words = "; ".join(" and ".join(map(str, group)) for group in same)
        members = tuple(sorted(line for group in same for line in group))
        second = Finding(
            Level.FAIL,
            f"shorted {plural}",
            f"{plural} {words} respond as one",
            "look for a bridge between their pins, at the connector and on the skin",
            rows=members if is_rows else (),
            cols=() if is_rows else members,
        )
    else:
        second = Finding(Level.PASS, f"shorted {plural}", "none")
    return [first, second]


def _address(bits: tuple[int, ...]) -> Finding:
    if not bits:
        return Finding(Level.PASS, "multiplexer", "every column is itself")
    words = " and ".join(f"{bit} (pin {_FIRST_ADDRESS_PIN + bit})" for bit in bits)
    line, which = (f"bit {words} does", "that line") if len(bits) == 1 else (f"bits {words} do", "those lines")
    apart = " and ".join(str(1 << bit) for bit in bits)
    return Finding(
        Level.FAIL,
        "multiplexer",
        f"address {line} not switch: columns {apart} apart respond as one",
        f"check {which} from the board to the multiplexer",
    )


def _stuck(stuck: tuple[tuple[int, int], ...], loaded: tuple[tuple[int, int], ...], skin: Untouched) -> Finding:
    if stuck:
        readings = ", ".join(f"{skin.baseline_counts[taxel]:.0f}" for taxel in stuck[:8])
        return Finding(
            Level.FAIL,
            "stuck taxels",
            f"{taxels_listed(stuck)} {'reads' if len(stuck) == 1 else 'read'} {readings} counts, pressed or not",
            "a short through the skin there: calibrate, so that they read 0, or replace the skin",
            taxels=stuck,
        )
    if loaded:
        return Finding(
            Level.WARN,
            "stuck taxels",
            f"none, but {counted(len(loaded), 'taxel reads', 'taxels read')} high untouched: {taxels_listed(loaded)}",
            "take away what presses them, or calibrate",
            taxels=loaded,
        )
    return Finding(Level.PASS, "stuck taxels", "none")


def _quiet(
    touch: Touched, sound: NDArray[np.bool_], thresholds: Thresholds
) -> tuple[tuple[tuple[int, int], ...], tuple[tuple[int, int], ...]]:
    """Sound-looking taxels that stay silent, or nearly, while those around them respond well."""
    dead, weak = [], []
    for row, col in np.argwhere(sound):
        top, left = max(row - 1, 0), max(col - 1, 0)
        area = (slice(top, row + 2), slice(left, col + 2))
        trusted = sound[area].copy()
        trusted[row - top, col - left] = False
        around = touch.response_counts[area][trusted]
        if len(around) < 3:
            continue
        usual = float(np.median(around))
        own = float(touch.response_counts[row, col])
        if usual < 3 * thresholds.response_counts:
            continue
        if not touch.responds[row, col]:
            dead.append((int(row), int(col)))
        elif own < thresholds.weak_share * usual:
            weak.append((int(row), int(col)))
    return tuple(dead), tuple(weak)


def _taxels(dead: tuple[tuple[int, int], ...], weak: tuple[tuple[int, int], ...]) -> list[Finding]:
    findings = []
    if dead:
        findings.append(
            Finding(
                Level.FAIL,
                "dead taxels",
                f"{taxels_listed(dead)} never responded, the taxels around did",
                "press there again; if they stay silent, the skin is worn there",
                taxels=dead,
            )
        )
    else:
        findings.append(Finding(Level.PASS, "dead taxels", "none"))
    if weak:
        findings.append(
            Finding(
                Level.WARN,
                "weak taxels",
                f"{taxels_listed(weak)} {'responds' if len(weak) == 1 else 'respond'} far less than those around",
                "press there again",
                taxels=weak,
            )
        )
    return findings


def _coverage(
    responds: NDArray[np.bool_], rows: tuple[int, ...], cols: tuple[int, ...], thresholds: Thresholds
) -> Finding:
    """How much was judged; in come whether each sound taxel responded, and lines of which nothing can be said."""
    share = float(responds.mean()) if responds.size else 0.0
    unpressed = [f"{word} {listed(lines)}" for word, lines in (("rows", rows), ("columns", cols)) if lines]
    if share >= thresholds.covered_share and not unpressed:
        return Finding(Level.PASS, "coverage", f"{100 * share:.0f} % of the sound taxels were pressed")
    words = f", none in {' and '.join(unpressed)}" if unpressed else ""
    return Finding(
        Level.WARN,
        "coverage",
        f"only {100 * share:.0f} % of the sound taxels were pressed{words}",
        "what was not pressed was not judged: repeat it and roll over the whole skin, edges included",
    )
