# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Tones in the samples of one contact, which are neither evenly spaced nor of the same taxels in every frame.

What vibrates on a contact changes the pressure everywhere at once, by a share that is a plane over the contact: a body
on a foam goes up and down, and rocks. So at each frequency f the force on taxel i is taken for::

    force_i(t) = mean_i + g_i (a + b x_i + c y_i) cos(2 pi f t) + g_i (a' + b' x_i + c' y_i) sin(2 pi f t)

where g_i is the mean force on it. That is linear least squares, so it holds for samples at any time (Lomb and Scargle's
periodogram is the case of one taxel), and all samples of a contact look for one frequency together. Tones are found
one after the other, the strongest first, and taken off; and with each of them its overtones that are too fast to be
told. How strong they are is then asked of each taxel by itself, without the plane, and summed up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_recon.spectra.spectrum import Peak

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Samples are put on a grid of this many points a step, and its spectrum is this much finer than the window resolves.
_POINTS_A_STEP = 8
_FINER = 4
# That noise alone is taken for a tone, in one window.
_FALSE_ALARM = 1e-4
_MEDIAN_WIDTH = 65
# Tones that are slower than those asked for are found and taken off, too.
_FURTHER_TONES = 6
# So many times its frequency: what vibrates is not a sine, and neither is what taxels make of it.
_OVERTONES = (2, 3)
_REFINING_STEPS = 3
_LEAST_SAMPLES = 8
# Of the samples of the taxel that has most: those with less are told from the plane.
_LEAST_SHARE = 0.1
# Of the strongest: what is weaker than 2 % of it may come of the taxels' response.
_LEAST_POWER = 0.02**2
_SPREAD = 0.05  # of the taxels' sensitivities


@dataclass(frozen=True)
class _Tone:
    """Frequency; complex amplitude of each taxel's force; the force of each sample; how much of all it explains."""

    frequency_hz: float
    frequency_sd_hz: float
    of_taxel: Complex
    force_n: Array
    power: float


class Tones:
    """The samples of one contact, and the tones in them.

    Parameters
    ----------
    time_s : np.ndarray [shape=(n,), dtype=float64]
        On any clock.
    slot : np.ndarray [shape=(n,), dtype=intp]
        Which of the contact's taxels, from 0.
    force_n : np.ndarray [shape=(n,), dtype=float64]
        What it read.
    noise_n : np.ndarray [shape=(taxels,), dtype=float64]
        Standard deviation of a reading of each taxel; above 0.
    x_m, y_m : np.ndarray [shape=(taxels,), dtype=float64]
        Where they lie.
    step_s : float
        From one sample of a taxel to its next, at least: a frame, or a part of one.
    """

    def __init__(
        self,
        time_s: Array,
        slot: NDArray[np.intp],
        force_n: Array,
        noise_n: Array,
        x_m: Array,
        y_m: Array,
        step_s: float,
    ) -> None:
        first_s, last_s = float(time_s.min()), float(time_s.max())
        self._since = time_s - (first_s + last_s) / 2
        self._span_s = max(last_s - first_s, step_s)
        self._slot, self._taxels = slot, noise_n.size
        self._step_s = step_s
        # Hann's window: what is strong does not hide what is weak beside it.
        hann = np.cos(np.pi * self._since / (self._span_s + step_s)) ** 2
        self._hann = hann
        self._weight = hann / noise_n[slot] ** 2
        self._whole = np.maximum(self._of_taxels(hann), 1e-12)
        self.mean_n: Array = self._of_taxels(hann * force_n) / self._whole
        self._change = force_n - self.mean_n[slot]
        number = self._of_taxels(np.ones_like(hann))
        self._is_seen = number >= max(_LEAST_SAMPLES, _LEAST_SHARE * float(number.max()))
        self._noise_n = noise_n
        self._modes = self._plane(x_m, y_m)
        self._grid()

    def _of_taxels(self, values: Array) -> Array:
        """Sums of what each sample has, by taxel."""
        sums: Array = np.bincount(self._slot, weights=values, minlength=self._taxels).astype(np.float64)
        return sums

    def _plane(self, x_m: Array, y_m: Array) -> Array:
        """How much of each taxel's force belongs to heaving and rocking, orthonormal; shape (taxels, 1 to 3)."""
        mean = np.maximum(self.mean_n, 0.0)
        total = max(float(mean.sum()), 1e-12)
        dx, dy = x_m - float(mean @ x_m) / total, y_m - float(mean @ y_m) / total
        reach_m = max(math.sqrt(float(mean @ (dx**2 + dy**2)) / total), 1e-9)
        root = np.sqrt(self._whole) / self._noise_n
        columns = root[:, None] * mean[:, None] * np.column_stack((np.ones_like(mean), dx / reach_m, dy / reach_m))
        modes: list[Array] = []
        for column in columns.T:
            rest = column - sum((float(mode @ column) * mode for mode in modes), np.zeros_like(column))
            size = float(np.linalg.norm(rest))
            if size > 1e-3 * float(np.linalg.norm(columns[:, 0])) > 0:
                modes.append(rest / size)
        return np.column_stack(modes) / root[:, None] if modes else np.zeros((mean.size, 0))

    def _grid(self) -> None:
        from scipy.fft import next_fast_len

        self._point_s = self._step_s / _POINTS_A_STEP
        self._point = np.rint((self._since - self._since.min()) / self._point_s).astype(np.intp)
        number = self._points(np.ones_like(self._since))
        # Of samples at an even pace most points have none.
        self._filled = np.flatnonzero(number)
        self._point_time_s = (self._points(self._since) / np.maximum(number, 1.0))[self._filled]
        modes = self._modes.T
        weighted = [[self._points(self._weight * one[self._slot] * two[self._slot]) for one in modes] for two in modes]
        self._squares = np.array(weighted)[..., self._filled]
        self._size = int(next_fast_len(_FINER * (int(self._point.max()) + 1), real=True))
        self.step_hz = 1.0 / (self._size * self._point_s)
        self._bins = min(int(0.5 / self._step_s / self.step_hz), self._size // 2) + 1
        self._blurred = np.sinc(self.step_hz * self._point_s * np.arange(self._bins))

    def _points(self, values: Array) -> Array:
        """Sums of what each sample has, by point of the grid."""
        sums: Array = np.bincount(self._point, weights=values).astype(np.float64)
        return sums

    def _spectrum(self, points: Array) -> Complex:
        from scipy.fft import rfft

        return np.asarray(rfft(points, self._size))[: self._bins] / self._blurred

    def amplitude_n(self) -> Array:
        """Amplitude of the whole force at multiples of `step_hz`; np.ndarray [shape=(n,), dtype=float64]."""
        share = np.where(self._is_seen, 1.0 / self._whole, 0.0)
        unseen = float(self.mean_n.sum()) / max(float(self.mean_n[self._is_seen].sum()), 1e-12)
        found: Array = (
            2.0 * unseen * np.abs(self._spectrum(self._points(self._hann * share[self._slot] * self._change)))
        )
        return found

    def peaks(self, lowest_hz: float, most: int) -> tuple[Peak, ...]:
        """The tones from `lowest_hz` on, `most` at most, the largest first."""
        if not self._modes.shape[1]:
            return ()
        rest = self._change.copy()
        found: list[_Tone] = []
        while len(found) < most + _FURTHER_TONES and sum(one.frequency_hz >= lowest_hz for one in found) < most:
            tone = self._next(rest)
            if tone is None or (found and tone.power < _LEAST_POWER * max(one.power for one in found)):
                break
            rest -= tone.force_n
            self._take_off_overtones(tone, rest)
            # A board pauses between frames, so that a tone near a multiple of the frame rate has a mean of its own.
            rest -= (self._of_taxels(self._hann * rest) / self._whole)[self._slot]
            found.append(tone)
        told = [self._peak(one, rest) for one in self._apart(found) if one.frequency_hz >= lowest_hz]
        return tuple(sorted(told, key=lambda one: -one.amplitude_n))

    def _take_off_overtones(self, tone: _Tone, rest: Array) -> None:
        """Take off overtones faster than half the rate: samples at an uneven pace have them at several frequencies."""
        for times in _OVERTONES:
            frequency_hz = times * tone.frequency_hz
            if frequency_hz > 0.5 / self._step_s:
                _, state = self._explained(frequency_hz, self._sums(rest)[:, self._filled])
                rest -= self._force_n(frequency_hz, self._modes @ state)

    def _apart(self, found: list[_Tone]) -> list[_Tone]:
        """Without what lies so near to a stronger tone that it may be a part of it."""
        near_hz = 2.0 / self._span_s
        hz = [one.frequency_hz for one in found]
        return [one for k, one in enumerate(found) if all(abs(one.frequency_hz - other) >= near_hz for other in hz[:k])]

    def _next(self, rest: Array) -> _Tone | None:
        """The strongest tone in what is left; None where that is no more than noise."""
        from scipy.ndimage import median_filter
        from scipy.special import chdtri

        sums = self._sums(rest)
        power = np.zeros(self._bins)
        for one in sums:
            power += np.abs(self._spectrum(one)) ** 2
        first = max(round(1.0 / self._span_s / self.step_hz), 1)
        if power.size <= first + 2:
            return None
        apart = power[::_FINER]
        noise = np.repeat(median_filter(apart, size=min(_MEDIAN_WIDTH, apart.size), mode="reflect"), _FINER)
        # A power of noise is distributed as chi squared.
        freedom = 2 * len(sums)
        least = chdtri(freedom, _FALSE_ALARM / apart.size) / chdtri(freedom, 0.5) * noise[: power.size]
        at = first + int(np.argmax(np.where(power > least, power, 0.0)[first:]))
        return self._tone(at * self.step_hz, sums[:, self._filled], rest) if power[at] > least[at] else None

    def _sums(self, rest: Array) -> Array:
        """How much of each mode is in what is left, by point of the grid; shape (modes, points)."""
        return np.array([self._points(self._weight * mode[self._slot] * rest) for mode in self._modes.T])

    def _tone(self, frequency_hz: float, sums: Array, rest: Array) -> _Tone:
        """The tone near a frequency that explains most, by least squares on the grid's points."""
        near_hz = self.step_hz / 2
        for _ in range(_REFINING_STEPS):
            before, here, after = (
                self._explained(frequency_hz + away_hz, sums)[0] for away_hz in (-near_hz, 0.0, near_hz)
            )
            bend = before - 2 * here + after
            if bend < 0:
                # The top of a parabola.
                frequency_hz += near_hz * min(max((before - after) / (2 * bend), -2.0), 2.0)
            near_hz /= 2
        power, state = self._explained(frequency_hz, sums)
        of_taxel: Complex = self._modes @ state
        force_n = self._force_n(frequency_hz, of_taxel)
        left = rest - force_n
        noise = float(self._weight @ left**2) / float(self._hann.sum())
        # What its force changes by with the frequency. Readings of a small weight count less, and so does their noise.
        square = self._weight * np.abs(of_taxel[self._slot]) ** 2 * (2 * np.pi * self._since) ** 2 / 2
        sd_hz = math.sqrt(noise * float(square @ self._hann)) / max(float(square.sum()), 1e-300)
        return _Tone(frequency_hz, sd_hz, of_taxel, force_n, power)

    def _force_n(self, frequency_hz: float, of_taxel: Complex) -> Array:
        """What each sample has of a tone."""
        force_n: Array = np.real(of_taxel[self._slot] * np.exp(2j * np.pi * frequency_hz * self._since))
        return force_n

    def _explained(self, frequency_hz: float, sums: Array) -> tuple[float, Complex]:
        """How much a tone of this frequency explains, and its complex amplitude in each mode."""
        angle = 2 * np.pi * frequency_hz * self._point_time_s
        cos, sin = np.cos(angle), np.sin(angle)
        crossed = self._squares @ (cos * sin)
        normal = np.block([[self._squares @ cos**2, crossed], [crossed, self._squares @ sin**2]])
        right = np.concatenate((sums @ cos, sums @ sin))
        state = np.linalg.lstsq(normal, right, rcond=1e-9)[0]
        count = len(sums)
        return float(right @ state), state[:count] - 1j * state[count:]

    def _peak(self, tone: _Tone, rest: Array) -> Peak:
        """How strong a tone is: that of each taxel by itself, summed up. `rest` is what no tone explains."""
        wave = self._hann * np.exp(-2j * np.pi * tone.frequency_hz * self._since)
        beside = self._of_taxels(np.real(wave) * rest) + 1j * self._of_taxels(np.imag(wave) * rest)
        # Of those that were hardly measured only what the plane says is known.
        each = tone.of_taxel + np.where(self._is_seen, 2 * beside / self._whole, 0.0)
        noise = self._of_taxels(self._hann * rest**2) / self._whole
        variance = 2 * noise * self._of_taxels(self._hann**2) / self._whole**2
        total = float(np.abs(each.sum()))
        sd_n = math.sqrt(
            float(np.where(self._is_seen, variance, 0.0).sum()) + _SPREAD**2 * float(np.sum(np.abs(each) ** 2))
        )
        return Peak(tone.frequency_hz, tone.frequency_sd_hz, total, sd_n)
