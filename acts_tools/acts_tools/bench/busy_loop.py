"""A process that computes without end: what else a machine may be doing."""

from __future__ import annotations


def main() -> None:
    """Never returns; a signal ends the process."""
    while True:
        pass


if __name__ == "__main__":
    main()
