# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The sampling schemes of the firmware and of Python say the same of themselves."""

import pytest

from acts_core.errors import SettingsError
from acts_core.sampling import OWN_SETTINGS, SCHEME_NUMBERS, SCHEMES, OwnSetting, Share
from acts_tools.firmware.board_sampler import firmware_takes, scheme_table

pytestmark = pytest.mark.slow


def said_by_firmware() -> dict[tuple[str, ...], list[OwnSetting]]:
    """The own settings of each scheme, by its name, number, description and whether it measures all."""
    lines = iter([line.split("\t") for line in scheme_table().splitlines()])
    found = {}
    for *scheme, own in lines:
        rows = [next(lines) for _ in range(int(own))]
        found[tuple(scheme)] = [
            OwnSetting(
                row[1],
                row[2],
                int(row[3]),
                int(row[4]),
                int(row[5]),
                number=int(row[0]),
                share=Share(row[6], row[7], float(row[8])) if row[6] else None,
                below=row[9],
            )
            for row in rows
        ]
    return found


def test_names_numbers_and_settings() -> None:
    ours = {
        (name, str(number), SCHEMES[name].description, str(int(SCHEMES[name].measures_all))): list(
            SCHEMES[name].own_settings
        )
        for name, number in SCHEME_NUMBERS.items()
    }
    assert said_by_firmware() == ours


def test_numbers_are_given_once() -> None:
    assert len(set(SCHEME_NUMBERS.values())) == len(SCHEME_NUMBERS)
    numbers = sorted(own.number for own in OWN_SETTINGS if own.number is not None)
    assert numbers == [7, 8, *range(14, 14 + len(numbers) - 2)]


@pytest.mark.parametrize("name", sorted(SCHEME_NUMBERS))
def test_limits_of_m(name: str) -> None:
    for rows, cols in ((32, 32), (15, 7), (64, 3)):
        for m in range(1, rows * cols + 1, 7 if rows == 32 else 1):
            try:
                SCHEMES[name].check_m(rows, cols, m)
                ours = True
            except SettingsError:
                ours = False
            assert firmware_takes(SCHEME_NUMBERS[name], rows, cols, m) == ours, (rows, cols, m)
