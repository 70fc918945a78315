# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Text commands that act on hand and object while the world runs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from acts_core.errors import SettingsError
from acts_sim.dynamixel import MOTOR_FAULTS, do_to_motor
from acts_sim.hand.tip import BLUNT_RADIUS_M, LARGEST_RADIUS_M, SHARP_RADIUS_M
from acts_sim.hand.world import HandWorld

_MM = 1e-3
_MS = 1e-3
_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}

# Largest allowed values, by unit.
_MOST_MM = 200.0
_MOST_DEG = 180.0
_MOST_N = 100.0
_MOST_S = 600.0


def carry_out(world: HandWorld, line: str, besides: Sequence[str] = ()) -> None:
    """Execute a command.

    Parameters
    ----------
    world : HandWorld
    line : str
        A word of `COMMANDS` and its arguments.
    besides : sequence of str
        What else the caller knows, for the error.

    Raises
    ------
    SettingsError
        For a word or an argument that is not allowed; the command then has no effect.
    """
    words = line.split()
    if not words or words[0] not in _KNOWN:
        raise SettingsError(f"{line.strip()!r}: unknown; known are {', '.join((*COMMANDS, *besides))}")
    usage, least, act = _KNOWN[words[0]]
    most = len(usage.split()) - 1
    if not least <= len(words) - 1 <= most:
        raise SettingsError(f"{line.strip()!r}: wrong number of arguments; usage: {usage}, with {least} or more")
    act(world, words[1:])


def _number(words: list[str], at: int, default: float, largest: float, smallest: float | None = None) -> float:
    if at >= len(words):
        return default
    low = -largest if smallest is None else smallest
    try:
        value = float(words[at])
    except ValueError:
        value = math.nan
    if not low <= value <= largest:
        raise SettingsError(f"{words[at]!r}: allowed is a number from {low:g} to {largest:g}")
    return value


def _vector(words: list[str], at: int, largest: float) -> np.ndarray:
    return np.array([_number(words, at + k, 0.0, largest) for k in range(3)])


def _needs_object(world: HandWorld) -> None:
    if not world.has_object:
        raise SettingsError("there is no object in this world")


def _needs_object_in_hand(world: HandWorld, word: str) -> None:
    _needs_object(world)
    if world.is_lost:
        raise SettingsError(f"{word}: the object has fallen out of the hand; put it back first")


def _let_go(world: HandWorld, _words: list[str]) -> None:
    _needs_object_in_hand(world, "let_go")
    world.holder.let_go()


def _hold(world: HandWorld, _words: list[str]) -> None:
    _needs_object_in_hand(world, "hold")
    world.hold()


def _put(world: HandWorld, words: list[str]) -> None:
    _needs_object(world)
    x, y = (_number(words, k, 0.0, _MOST_MM) for k in range(2))
    height = _number(words, 2, 0.0, _MOST_MM, 0.0)
    world.put(x * _MM, y * _MM, height * _MM, held=world.holder.keeps)


def _move(world: HandWorld, words: list[str]) -> None:
    _needs_object_in_hand(world, "move")
    way, turn = _vector(words, 0, _MOST_MM) * _MM, np.radians(_vector(words, 3, _MOST_DEG))
    duration_s = _number(words, 6, 1.0, _MOST_S, 0.01)
    if not world.holder.keeps:
        raise SettingsError("move: nothing holds the object; hold first")
    world.holder.move(way, turn, duration_s)


def _pull(world: HandWorld, words: list[str]) -> None:
    _needs_object(world)
    world.disturbances.pull(_vector(words, 0, _MOST_N), _number(words, 3, 50.0, _MOST_S / _MS, 0.0) * _MS)


def _load(world: HandWorld, words: list[str]) -> None:
    _needs_object(world)
    world.disturbances.pull_down(_number(words, 0, 0.0, 100.0), _number(words, 1, 50.0, _MOST_S / _MS, 0.0) * _MS)


def _shake(world: HandWorld, words: list[str]) -> None:
    if words[0] not in _AXES:
        raise SettingsError(f"{words[0]!r}: allowed is one of {', '.join(_AXES)}")
    amplitude, frequency = _number(words, 1, 0.0, 100.0, 0.0), _number(words, 2, 1.0, 50.0, 0.01)
    duration_s = _number(words, 3, 1.0, _MOST_S, 0.0)
    world.disturbances.shake(np.array(_AXES[words[0]]), amplitude * _MM, frequency, duration_s)


def _poke(world: HandWorld, words: list[str]) -> None:
    names = [patch.name for patch in world.layout.patches]
    if words[0] not in names:
        raise SettingsError(f"{words[0]!r}: allowed is one of {', '.join(names)}")
    (patch,) = (one for one in world.layout.patches if one.name == words[0])
    known = {"sharp": SHARP_RADIUS_M, "blunt": BLUNT_RADIUS_M}
    radius_m = known.get(words[1]) or _number(words, 1, 0.0, LARGEST_RADIUS_M / _MM, 0.2) * _MM
    speed, travel = _number(words, 2, 50.0, 500.0, 0.1), _number(words, 3, 10.0, 50.0, 0.0)
    row = _number(words, 4, (patch.rows - 1) / 2, patch.rows - 1, 0.0)
    col = _number(words, 5, (patch.cols - 1) / 2, patch.cols - 1, 0.0)
    start = _number(words, 6, 5.0, _MOST_MM, 0.0)
    world.tip.poke(patch.name, radius_m, speed * _MM, travel * _MM, start * _MM, row, col)


def _withdraw(world: HandWorld, _words: list[str]) -> None:
    world.tip.withdraw()


def _motor_fault(word: str) -> Callable[[HandWorld, list[str]], None]:
    return lambda world, words: do_to_motor(world.bus, world, word, words[0])


_KNOWN: dict[str, tuple[str, int, Callable[[HandWorld, list[str]], None]]] = {
    "let_go": ("let_go", 0, _let_go),
    "hold": ("hold", 0, _hold),
    "put": ("put X_MM Y_MM HEIGHT_MM", 2, _put),
    "move": ("move X_MM Y_MM Z_MM RX_DEG RY_DEG RZ_DEG SECONDS", 3, _move),
    "pull": ("pull FX_N FY_N FZ_N RAMP_MS", 3, _pull),
    "load": ("load TIMES_WEIGHT RAMP_MS", 1, _load),
    "shake": ("shake AXIS MM HZ SECONDS", 4, _shake),
    "poke": ("poke PATCH sharp|blunt|RADIUS_MM SPEED_MM_S TRAVEL_MM ROW COL START_MM", 2, _poke),
    "withdraw": ("withdraw", 0, _withdraw),
    **{word: (f"{word} ID", 1, _motor_fault(word)) for word in MOTOR_FAULTS},
}

COMMANDS = tuple(usage for usage, _, _ in _KNOWN.values())
"""Commands of `carry_out` with their arguments, of which the last ones are optional."""
