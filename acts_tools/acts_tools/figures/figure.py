# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""One figure: how it is measured, and which published curves belong to it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from acts_tools.figures.published import PublishedData
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import Curve, Panel, with_curves


@dataclass(frozen=True)
class Figure:
    """A figure of the paper.

    Attributes
    ----------
    name : str
        Its number in the paper, as "4E".
    title : str
    measure : callable
        ``measure(run)``: its panels, without published curves.
    published : callable or None
        ``published(data, panels)``: published curves by the title of their panel; None for none.
    published_panels : callable or None
        ``published_panels(data, panels)``: the panels, and among them those that only show what was published; None for
        none.
    columns : int
        Panels in a row of the picture.
    panel_inch : tuple of float
        Width and height of a panel [inch].
    how : callable or None
        ``how(run)``: of what and how much it is measured, where ``--fast`` measures less; None for nothing to say.
    notes : tuple of str
        What else a reader of the picture must know, a sentence each.
    """

    name: str
    title: str
    measure: Callable[[Run], list[Panel]]
    published: Callable[[PublishedData, Sequence[Panel]], dict[str, list[Curve]]] | None = None
    published_panels: Callable[[PublishedData, Sequence[Panel]], list[Panel]] | None = None
    columns: int = 3
    panel_inch: tuple[float, float] = (3.4, 2.9)
    how: Callable[[Run], str] | None = None
    notes: tuple[str, ...] = ()

    @property
    def file_name(self) -> str:
        """Name of its files without an ending."""
        return f"fig_{self.name.lower().replace('-', '_')}"

    @property
    def has_published(self) -> bool:
        """Whether something was published that is drawn beside."""
        return self.published is not None or self.published_panels is not None

    def notes_of(self, run: Run) -> list[str]:
        """What a reader of the picture that this run makes must know, a sentence each."""
        return [*([] if self.how is None else [self.how(run)]), *self.notes]

    def with_published(self, data: PublishedData, panels: Sequence[Panel]) -> list[Panel]:
        """The measured panels, and what was published.

        Raises
        ------
        RecordingError
            When `data` has no such curves.
        """
        whole = with_curves(panels, {} if self.published is None else self.published(data, panels))
        return whole if self.published_panels is None else self.published_panels(data, whole)
