"""Short rows of numbers in explicit vectors, for use in numba functions.

The rows of FastOMP have as many elements as a patch has measured pixels. A loop over so few would spend its time before
and after its vectorised part; here rows are filled up to whole vectors instead. Nothing is checked: rows and lengths
must be in range.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from acts_recon.fastomp_ir import FLOAT, FLOATS, INT, LANES, each, function, is_array, part, row_of, slot, spread

_SIDE = 8


@intrinsic  # type: ignore[untyped-decorator]
def dot(typing_context: Any, x: Any, x_row: Any, y: Any, y_row: Any, n: Any) -> Any:
    """Inner product of the first `n` elements of two rows.

    Parameters
    ----------
    x, y : np.ndarray [shape=(rows, at least n) or (at least n,), dtype=float32]
        A single row counts as row 0.
    x_row, y_row : int
    n : int
        A multiple of `LANES`: what is shorter is filled up with zeros.
    """
    if not all(is_array(array, types.float32, array.ndim) for array in (x, y)):
        return None
    return types.float32(x, types.int64, y, types.int64, types.int64), _dot


@intrinsic  # type: ignore[untyped-decorator]
def subtract(typing_context: Any, x: Any, out: Any, row: Any, share: Any, other: Any, n: Any) -> Any:
    """``x[out] = x[row] - share * x[other]`` in the first `n` elements; parameters as of `dot`."""
    if not is_array(x, types.float32, x.ndim):
        return None
    return types.void(x, types.int64, types.int64, types.float32, types.int64, types.int64), _subtract


@intrinsic  # type: ignore[untyped-decorator]
def clear(typing_context: Any, x: Any, x_row: Any, n: Any) -> Any:
    """``x[x_row] = 0`` in the first `n` elements; parameters as of `dot`."""
    if not is_array(x, types.float32, x.ndim):
        return None
    return types.void(x, types.int64, types.int64), _clear


@intrinsic  # type: ignore[untyped-decorator]
def add_square(
    typing_context: Any, image: Any, first: Any, stride: Any, share: Any, atoms: Any, atom: Any, side: Any
) -> Any:
    """Add ``share * atoms[atom]``, rows of a square one after the other, to a square of an image.

    Parameters
    ----------
    image : np.ndarray [shape=(size,), dtype=float32]
    first, stride : int
        Where the square begins in the image, and how far its rows are apart.
    share : float32
    atoms : np.ndarray [shape=(n_atoms, side * side), dtype=float32]
    atom, side : int
    """
    if not (is_array(image, types.float32, 1) and is_array(atoms, types.float32, 2)):
        return None
    index = types.int64
    return types.void(image, index, index, types.float32, atoms, index, index), _add_square


def padded(n: int) -> int:
    """The smallest multiple of `LANES` that is not below `n`."""
    return -(-n // LANES) * LANES


def _dot(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
    x = row_of(context, builder, signature.args[0], *arguments[:2])
    y = row_of(context, builder, signature.args[2], *arguments[2:4])
    total = slot(builder, ir.Constant(FLOATS, [0.0] * LANES))
    fused = function(builder, "fmuladd", 3)
    with _each_vector(builder, arguments[4]) as place:
        products = [builder.load(builder.gep(row, [place]), align=4) for row in (x, y)]
        builder.store(builder.call(fused, [*products, builder.load(total)]), total)
    value, width = builder.load(total), LANES
    while width > 1:
        width //= 2
        value = builder.fadd(*(part(builder, value, first, width) for first in (0, width)))
    return builder.extract_element(value, ir.Constant(INT, 0))


def _subtract(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
    x, out, row, share, other, n = arguments
    to, old, taken = (row_of(context, builder, signature.args[0], x, which) for which in (out, row, other))
    share = spread(builder, builder.fneg(share), FLOATS)
    fused = function(builder, "fmuladd", 3)
    with _each_vector(builder, n) as place:
        values = [builder.load(builder.gep(data, [place]), align=4) for data in (taken, old)]
        builder.store(builder.call(fused, [share, *values]), builder.gep(to, [place]), align=4)
    return context.get_dummy_value()


def _clear(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
    x = row_of(context, builder, signature.args[0], *arguments[:2])
    with _each_vector(builder, arguments[2]) as place:
        builder.store(ir.Constant(FLOATS, [0.0] * LANES), builder.gep(x, [place]), align=4)
    return context.get_dummy_value()


def _add_square(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
    image, atoms = (
        context.make_array(signature.args[place])(context, builder, arguments[place]).data for place in (0, 4)
    )
    _, first, stride, share, _, atom, side = arguments
    size = side.type
    start = builder.mul(atom, builder.mul(side, side))
    # Eight at a time, the side of a usual patch; what is left over one by one.
    whole = builder.and_(side, ir.Constant(size, -_SIDE))
    for kind, begin, end, step in (
        (ir.VectorType(FLOAT, _SIDE), ir.Constant(size, 0), whole, _SIDE),
        (ir.VectorType(FLOAT, 1), whole, side, 1),
    ):
        shares = spread(builder, share, kind)
        fused = function(builder, "fmuladd", 3, kind)
        with each(builder, side) as line:
            to = builder.add(first, builder.mul(line, stride))
            source = builder.add(start, builder.mul(line, side))
            with cgutils.for_range_slice(builder, begin, end, ir.Constant(size, step), size) as (column, _):
                place, other = (
                    builder.bitcast(builder.gep(data, [builder.add(base, column)]), kind.as_pointer())
                    for data, base in ((image, to), (atoms, source))
                )
                values = [shares, builder.load(other, align=4), builder.load(place, align=4)]
                builder.store(builder.call(fused, values), place, align=4)
    return context.get_dummy_value()


def _each_vector(builder: ir.IRBuilder, n: ir.Value) -> Any:
    return each(builder, builder.sdiv(n, ir.Constant(n.type, LANES)))
