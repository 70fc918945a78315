"""Where the dictionary that comes with ACTS is."""

from __future__ import annotations

from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory

from acts_core.errors import DictionaryError

SHIPPED_NAME = "patch8_k1000.npz"


def shipped_dictionary_path() -> Path:
    """Path of the shipped dictionary in the installed package ``acts_config``.

    Raises
    ------
    DictionaryError
        When that package is not in the environment.
    """
    try:
        share = get_package_share_directory("acts_config")
    except PackageNotFoundError:
        raise DictionaryError(
            "the package acts_config, which holds the shipped dictionary, is not installed here: "
            "source the workspace's setup, or give the path of a dictionary file"
        ) from None
    return Path(share) / "dictionaries" / SHIPPED_NAME
