# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`kernel`: numba's `njit` with a cache on disk that notices changes of all that a kernel is made of.

Numba's own cache looks at the file of a function alone. What the function calls, and the constants it reads, are
compiled into it, so that after a change of another file it goes on with the old ones. Here a kernel is cached in a
folder named by the content of its file and of all files of ours that it imports, directly or not::

    @kernel
    def total(values): ...

    @kernel(fastmath={"nsz"})
    def quick_total(values): ...
"""

from __future__ import annotations

import hashlib
import importlib
import importlib.util
import os
import re
import shutil
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar, cast, overload

import numpy as np
from numpy.typing import NDArray

R = TypeVar("R")
Scalar = TypeVar("Scalar", bound=np.generic)

_IMPORT = re.compile(
    r"^[ \t]*(?:from[ \t]+(acts_[\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n]*)|import[ \t]+(acts_[\w.]+))", re.MULTILINE
)
_CACHES = "kernels"
_told_uncached = False


def _import_numba() -> ModuleType:
    """Import numba without two packages that it only looks for, and whose import is a fourth of its own."""
    # Where the value is None, Python takes a module for absent.
    absent = dict.fromkeys({"coverage", "scipy"} - sys.modules.keys())
    sys.modules.update(absent)  # type: ignore[arg-type]
    try:
        return importlib.import_module("numba")
    finally:
        for name in absent:
            del sys.modules[name]


numba = _import_numba()


@overload
def kernel(function: Callable[..., R], /) -> Callable[..., R]: ...


@overload
def kernel(**options: Any) -> Callable[[Callable[..., R]], Callable[..., R]]: ...


def kernel(
    function: Callable[..., R] | None = None, /, **options: Any
) -> Callable[..., R] | Callable[[Callable[..., R]], Callable[..., R]]:
    """Compile a function at its first call, without Python objects, and without the interpreter's lock held.

    Parameters
    ----------
    function : callable, optional
        What is decorated; left out where there are options.
    **options
        More of `numba.njit`. ``cache`` and ``nogil`` are on.

    Returns
    -------
    callable
        Type checkers know what it returns, not what it takes: numba converts arguments where it can. With
        ``NUMBA_DISABLE_JIT=1`` the function itself.
    """
    if function is None:
        return lambda decorated: _compiled(decorated, options)
    return _compiled(function, options)


def as_compiled(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """An array as kernels were compiled for at the start: C-contiguous, and one that can be written.

    For a slice, another order in memory, or an array that is read-only, numba would compile a kernel once more, which
    takes up to a minute. It takes the bytes of another byte order as they are: types are for the caller to check.

    Parameters
    ----------
    array : np.ndarray

    Returns
    -------
    np.ndarray
        The same where it is of this kind, else a copy.
    """
    return array if array.flags.carray else np.array(array, order="C")


def skip_extras() -> None:
    """Keep numba from what it does at the first call of any kernel and our programs do not need; for their start.

    It imports scipy's linear algebra, only to know that it is there, and reads what all installed packages say of
    themselves, to find extensions of its own: together a sixth of a node's start. Afterwards a kernel with a product of
    matrices in it cannot be compiled.
    """
    from numba.core import entrypoints
    from numba.np import linalg

    entrypoints.init_all = lambda: None

    def refuse() -> None:
        raise ImportError("this program has kernels without products of matrices only: acts_core.kernels.skip_extras")

    linalg.ensure_blas = refuse


def _compiled(function: Callable[..., R], options: dict[str, Any]) -> Callable[..., R]:
    if numba.config.DISABLE_JIT:
        # To look for an error by a debugger: numba compiles nothing, and has nothing to be kept.
        return function
    before = numba.config.CACHE_DIR
    # Read while a function is decorated, and at no other time.
    folder = cache_folder(function)
    numba.config.CACHE_DIR = str(folder)
    try:
        compiled = numba.njit(cache=True, nogil=True, **options)(function)
    except RuntimeError as error:
        # It finds no folder at all that can be written.
        _tell_uncached(folder, error)
        compiled = numba.njit(nogil=True, **options)(function)
    else:
        _go_on_where_it_cannot_be_kept(compiled, folder)
    finally:
        numba.config.CACHE_DIR = before
    _compile_for_types_alone(compiled)
    return cast(Callable[..., R], compiled)


def _go_on_where_it_cannot_be_kept(compiled: Any, folder: Path) -> None:
    """Let a kernel run that was compiled and cannot be written, on a full disk: numba raises an error there."""
    save = compiled._cache.save_overload

    def save_where_there_is_room(*arguments: Any) -> None:
        try:
            save(*arguments)
        except OSError as error:
            _tell_uncached(folder, error)

    compiled._cache.save_overload = save_where_there_is_room


def _tell_uncached(folder: Path, error: Exception) -> None:
    """Warn, once in a process."""
    global _told_uncached
    if not _told_uncached:
        _told_uncached = True
        warnings.warn(
            f"compiled code cannot be kept in {folder.parent} ({error}): each start takes up to a minute; make room, "
            "or set NUMBA_CACHE_DIR to a folder that can be written",
            RuntimeWarning,
            stacklevel=2,
        )


def _compile_for_types_alone(compiled: Any) -> None:
    """Let a kernel that is called by others not be compiled once more for each constant that they pass.

    Nor for the constant that a variable of theirs starts with: numba does so before it knows the variable's type, and
    throws it away. What is passed is inlined all the same.
    """
    template_of = compiled.get_call_template
    unliteral = numba.types.unliteral

    def template_of_types(args: tuple[Any, ...], kws: dict[str, Any]) -> Any:
        return template_of(tuple(map(unliteral, args)), {name: unliteral(kind) for name, kind in kws.items()})

    compiled.get_call_template = template_of_types


def cache_folder(function: Callable[..., Any]) -> Path:
    """Where a kernel is cached: beside its file, or in the user's cache where that cannot be written.

    The environment variable NUMBA_CACHE_DIR has its usual meaning. Folders of former contents are removed. What cannot
    be written is compiled at each start.
    """
    name, file = function.__module__, function.__code__.co_filename
    folder = _root(Path(file).parent) / f"{name}-{fingerprint(file)}"
    if not folder.is_dir():
        # Another process may have made ours meanwhile.
        for former in set(folder.parent.glob(f"{name}-*")) - {folder}:
            shutil.rmtree(former, ignore_errors=True)
    return folder


@lru_cache(None)
def _root(package: Path) -> Path:
    root = os.environ.get("NUMBA_CACHE_DIR", "")
    beside = package / "__pycache__"
    if not root:
        try:
            beside.mkdir(exist_ok=True)
            tempfile.TemporaryFile(dir=beside).close()
            root = str(beside)
        except OSError:
            root = os.environ.get("XDG_CACHE_HOME", "") or str(Path.home() / ".cache")
    return Path(root) / _CACHES / hashlib.sha256(bytes(package)).hexdigest()[:12]


def fingerprint(file: str) -> str:
    """Hash of a file and of all files of ours that it imports, and they.

    Parameters
    ----------
    file : str
        Path of a Python file.
    """
    known: set[str] = set()
    waiting = [file]
    while waiting:
        path = waiting.pop()
        if path not in known:
            known.add(path)
            waiting += _source(path)[1]
    digests = sorted(_source(path)[0] for path in known)
    return hashlib.sha256(b"".join(digests)).hexdigest()[:16]


@lru_cache(None)
def _source(path: str) -> tuple[bytes, tuple[str, ...]]:
    """Hash of a file, and the files of ours that it imports."""
    content = Path(path).read_bytes()
    files = {_file_of(name) for name in _imported(content.decode())}
    return hashlib.sha256(content).digest(), tuple(sorted(files - {""}))


def _imported(text: str) -> Iterator[str]:
    """Names that may be modules of ours. Found as text: parsing takes a quarter of a second of every start."""
    for module, names, whole in _IMPORT.findall(text):
        yield module or whole
        # Either names within the module, or modules within the package.
        yield from (f"{module}.{name}" for name in re.findall(r"\w+", names))


@lru_cache(None)
def _file_of(name: str) -> str:
    """Path of a module of ours; empty for others, and for what is no module. Nothing is imported to find it."""
    package, *rest = name.split(".")
    spec = importlib.util.find_spec(package)
    if spec is None or spec.origin is None:
        return ""
    place = Path(spec.origin).parent.joinpath(*rest)
    found = (path for path in (place.with_suffix(".py"), place / "__init__.py") if path.is_file())
    return str(next(found, ""))
