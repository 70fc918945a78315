# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Names and numbers on the wire that cannot be are refused at the start, with those that can."""

import pytest

from acts_core.errors import SettingsError
from acts_core.sampling import SCHEME_NUMBERS, SCHEMES, OwnSetting, SamplingScheme, Share
from acts_core.sampling.registry import check_names, check_numbers, check_words


def scheme_of(number: int | None, own_number: int | None = None) -> type[SamplingScheme]:
    step = OwnSetting("mine_step", "a step", 1, 1, 9, number=own_number)
    settings = () if own_number is None else (step,)
    return type("Mine", (SamplingScheme,), {"name": "mine", "number": number, "own_settings": settings})


def test_what_is_there_and_a_scheme_of_python_alone_are_taken() -> None:
    check_numbers([*SCHEMES.values(), scheme_of(None, own_number=7)])
    check_numbers([*SCHEMES.values(), scheme_of(max(SCHEME_NUMBERS.values()) + 1)])


def test_a_scheme_with_anothers_number_is_refused_with_the_next_free_one() -> None:
    free = max(SCHEME_NUMBERS.values()) + 1
    with pytest.raises(SettingsError, match=rf"number = 3 of scheme '\w+': '\w+' has it; the next free one is {free}"):
        check_numbers([*SCHEMES.values(), scheme_of(3)])


@pytest.mark.parametrize("number", [0, -1, 256])
def test_a_number_that_does_not_fit_in_its_byte_is_refused(number: int) -> None:
    check_numbers([*SCHEMES.values(), scheme_of(255)])
    with pytest.raises(SettingsError, match=rf"number = {number} of scheme 'mine': allowed is 1 to 255, one byte"):
        check_numbers([*SCHEMES.values(), scheme_of(number)])


@pytest.mark.parametrize("number", [7, 99])
def test_an_own_setting_with_anothers_number_or_behind_a_gap_is_refused(number: int) -> None:
    with pytest.raises(SettingsError, match=rf"'mine_step': {number}.*allowed is each of \[7, 8, 14"):
        check_numbers([*SCHEMES.values(), scheme_of(200, own_number=number)])


@pytest.mark.parametrize(
    ("own", "owner"),
    [
        (OwnSetting("seed", "a seed", 1, 1, 9), "every scheme"),
        (OwnSetting("fixed_row", "a row", 1, 1, 9), "scheme 'fixed'"),
        (OwnSetting("mine_quota", "taxels", 1, 1, 9, share=Share("search_share", "a share", 0.5)), "scheme 'tracking'"),
    ],
)
def test_an_own_setting_that_would_replace_anothers_is_refused(own: OwnSetting, owner: str) -> None:
    mine = type("Mine", (SamplingScheme,), {"name": "mine", "own_settings": (own,)})
    with pytest.raises(
        SettingsError, match=rf"'{own.parameter}' of scheme 'mine': {owner} has one of that name; begin"
    ):
        check_names([*SCHEMES.values(), mine])


@pytest.mark.parametrize("missing", ["name", "description"])
def test_a_scheme_that_does_not_say_what_it_is_called_or_does_is_refused(missing: str) -> None:
    words = {"name": "mine", "description": "frames of mine", "__module__": "mine"}
    del words[missing]
    with pytest.raises(SettingsError, match=rf"scheme mine\.Mine: it has no {missing}; give the class one"):
        check_words(type("Mine", (SamplingScheme,), words))
