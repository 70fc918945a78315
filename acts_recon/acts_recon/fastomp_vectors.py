"""The innermost loops of FastOMP in explicit vectors, for use in numba functions.

Nearly all time of a recovery goes into `best_column`. Written as loops, numba's compiler keeps the sums in memory,
guards every loop against overlapping arrays and reduces every block to a scalar, which for the few measured pixels of
a patch costs several times the multiply-adds. Here the sums of a block stay in registers, and so do the largest one of
every lane and the block it came from; only after the last block are the lanes compared. `dot` and `subtract` are for
rows so short that a loop would spend its time before and after its vectorised part. LLVM lowers the vectors to what the
processor has, from SSE2 to AVX-512 and NEON. Nothing is checked: rows, pixels and lengths must be in range.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

LANES = 16
"""Elements of a vector: one register of AVX-512, two of AVX2, four of SSE and NEON."""

VECTORS = 4
"""Vectors of a block, as many sums as are in flight at once."""

BLOCK = LANES * VECTORS
"""Columns whose correlations are computed together: their 64 pixels fill half of a usual first cache."""

_FLOAT = ir.FloatType()
_INT = ir.IntType(32)
_SUMS = ir.VectorType(_FLOAT, LANES)
_PLACES = ir.VectorType(_INT, LANES)


@intrinsic  # type: ignore[untyped-decorator]
def best_column(typing_context: Any, blocks: Any, pixels: Any, residual: Any, m: Any) -> Any:
    """The column whose correlation with the residual is largest in magnitude.

    Parameters
    ----------
    blocks : np.ndarray [shape=(n_blocks, n_pixels, BLOCK), dtype=float32]
        See `acts_recon.fastomp_kernels.in_blocks`.
    pixels : np.ndarray [shape=(at least m,), dtype=int64]
        Rows that were measured.
    residual : np.ndarray [shape=(at least m,), dtype=float32]
        What is left to explain there.
    m : int
        How many there are.

    Returns
    -------
    int
        Column (int64), the first of equally good ones; -1 when all correlations are 0 (or none is a number).
    """
    if not (_is(blocks, types.float32, 3) and _is(pixels, types.int64, 1) and _is(residual, types.float32, 1)):
        return None
    return types.int64(blocks, pixels, residual, types.int64), _best_column


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
    if not all(_is(array, types.float32, array.ndim) for array in (x, y)):
        return None
    return types.float32(x, types.int64, y, types.int64, types.int64), _dot


@intrinsic  # type: ignore[untyped-decorator]
def subtract(typing_context: Any, x: Any, x_row: Any, share: Any, y: Any, y_row: Any, n: Any) -> Any:
    """``x[x_row] -= share * y[y_row]`` in the first `n` elements; parameters as of `dot`."""
    if not all(_is(array, types.float32, array.ndim) for array in (x, y)):
        return None
    return types.void(x, types.int64, types.float32, y, types.int64, types.int64), _subtract


def padded(n: int) -> int:
    """The smallest multiple of `LANES` that is not below `n`."""
    return -(-n // LANES) * LANES


def _is(kind: Any, dtype: Any, ndim: int) -> bool:
    return isinstance(kind, types.Array) and (kind.dtype, kind.ndim, kind.layout) == (dtype, ndim, "C")


def _dot(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
    x = _row(context, builder, signature.args[0], *arguments[:2])
    y = _row(context, builder, signature.args[2], *arguments[2:4])
    total = _slot(builder, ir.Constant(_SUMS, [0.0] * LANES))
    fused = _vector_function(builder, "fmuladd", 3)
    with _each_vector(builder, arguments[4]) as loop:
        products = [builder.load(builder.gep(row, [loop.index]), align=4) for row in (x, y)]
        builder.store(builder.call(fused, [*products, builder.load(total)]), total)
    value, width = builder.load(total), LANES
    while width > 1:
        width //= 2
        value = builder.fadd(*(_part(builder, value, first, width) for first in (0, width)))
    return builder.extract_element(value, ir.Constant(_INT, 0))


def _subtract(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
    x = _row(context, builder, signature.args[0], *arguments[:2])
    share = _spread(builder, builder.fneg(arguments[2]), _SUMS)
    y = _row(context, builder, signature.args[3], *arguments[3:5])
    fused = _vector_function(builder, "fmuladd", 3)
    with _each_vector(builder, arguments[5]) as loop:
        place = builder.gep(x, [loop.index])
        other = builder.load(builder.gep(y, [loop.index]), align=4)
        builder.store(builder.call(fused, [share, other, builder.load(place, align=4)]), place, align=4)
    return context.get_dummy_value()


def _best_column(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
    blocks, pixels, residual = (
        context.make_array(kind)(context, builder, value)
        for kind, value in zip(signature.args[:3], arguments[:3], strict=True)
    )
    n_blocks, n_pixels, _ = cgutils.unpack_tuple(builder, blocks.shape)
    size = n_blocks.type
    # Tops and places live in stack slots that LLVM turns into registers.
    tops = [_slot(builder, ir.Constant(_SUMS, [0.0] * LANES)) for _ in range(VECTORS)]
    places = [_slot(builder, ir.Constant(_PLACES, [-1] * LANES)) for _ in range(VECTORS)]
    absolute = _vector_function(builder, "fabs", 1)
    fused = _vector_function(builder, "fmuladd", 3)
    with cgutils.for_range(builder, n_blocks) as outer:
        sums = [_slot(builder, ir.Constant(_SUMS, [0.0] * LANES)) for _ in range(VECTORS)]
        first_row = builder.mul(outer.index, n_pixels)
        with cgutils.for_range(builder, arguments[3]) as inner:
            pixel = builder.load(builder.gep(pixels.data, [inner.index]))
            weight = _spread(builder, builder.load(builder.gep(residual.data, [inner.index])), _SUMS)
            row = builder.mul(builder.add(first_row, pixel), ir.Constant(size, BLOCK))
            start = builder.bitcast(builder.gep(blocks.data, [row]), _SUMS.as_pointer())
            for vector, slot in enumerate(sums):
                place = builder.gep(start, [ir.Constant(size, vector)])
                values = builder.load(place, align=4)
                builder.store(builder.call(fused, [weight, values, builder.load(slot)]), slot)
        block = _spread(builder, builder.trunc(outer.index, _INT), _PLACES)
        for slot, top, place in zip(sums, tops, places, strict=True):
            magnitude = builder.call(absolute, [builder.load(slot)])
            better = builder.fcmp_ordered(">", magnitude, builder.load(top))
            builder.store(builder.select(better, magnitude, builder.load(top)), top)
            builder.store(builder.select(better, block, builder.load(place)), place)
    return _best_lane(builder, tops, places)


def _best_lane(builder: ir.IRBuilder, tops: list[ir.Value], places: list[ir.Value]) -> ir.Value:
    """The best column of all lanes, halving vectors of magnitudes and columns until one element is left."""
    values, columns = [], []
    for vector, (top, place) in enumerate(zip(tops, places, strict=True)):
        block = builder.load(place)
        lane = ir.Constant(_PLACES, [vector * LANES + lane for lane in range(LANES)])
        column = builder.add(builder.mul(block, ir.Constant(_PLACES, [BLOCK] * LANES)), lane)
        # A lane that was never above 0 loses against every other, and alone means that there is no best one.
        never = builder.icmp_signed("<", block, ir.Constant(_PLACES, [0] * LANES))
        columns.append(builder.select(never, ir.Constant(_PLACES, [2**31 - 1] * LANES), column))
        values.append(builder.load(top))
    while len(values) > 1:
        pairs = [
            _better(builder, *some) for some in zip(values[::2], columns[::2], values[1::2], columns[1::2], strict=True)
        ]
        values, columns = [pair[0] for pair in pairs], [pair[1] for pair in pairs]
    value, column = values[0], columns[0]
    width = LANES
    while width > 1:
        width //= 2
        value, column = _better(
            builder,
            *(_part(builder, some, 0, width) for some in (value, column)),
            *(_part(builder, some, width, width) for some in (value, column)),
        )
    found = builder.extract_element(column, ir.Constant(_INT, 0))
    none = builder.icmp_signed("==", found, ir.Constant(_INT, 2**31 - 1))
    return builder.sext(builder.select(none, ir.Constant(_INT, -1), found), ir.IntType(64))


def _better(
    builder: ir.IRBuilder, value: ir.Value, column: ir.Value, other_value: ir.Value, other_column: ir.Value
) -> tuple[ir.Value, ir.Value]:
    """Lane by lane the larger value with its column; of equal ones the smaller column."""
    larger = builder.fcmp_ordered(">", other_value, value)
    earlier = builder.icmp_signed("<", other_column, column)
    equal = builder.fcmp_ordered("==", other_value, value)
    take = builder.or_(larger, builder.and_(equal, earlier))
    return builder.select(take, other_value, value), builder.select(take, other_column, column)


def _row(context: Any, builder: ir.IRBuilder, kind: Any, array: ir.Value, row: ir.Value) -> ir.Value:
    """Where a row begins, as a pointer to vectors."""
    view = context.make_array(kind)(context, builder, array)
    length = cgutils.unpack_tuple(builder, view.shape)[-1]
    return builder.bitcast(builder.gep(view.data, [builder.mul(row, length)]), _SUMS.as_pointer())


def _each_vector(builder: ir.IRBuilder, n: ir.Value) -> Any:
    return cgutils.for_range(builder, builder.sdiv(n, ir.Constant(n.type, LANES)))


def _part(builder: ir.IRBuilder, vector: ir.Value, first: int, width: int) -> ir.Value:
    lanes = ir.Constant(ir.VectorType(_INT, width), list(range(first, first + width)))
    return builder.shuffle_vector(vector, vector, lanes)


def _vector_function(builder: ir.IRBuilder, name: str, arguments: int) -> ir.Function:
    """LLVM's own function of this name for the vectors of sums."""
    kind = ir.FunctionType(_SUMS, [_SUMS] * arguments)
    return builder.module.declare_intrinsic(f"llvm.{name}.v{LANES}f32", (), kind)


def _slot(builder: ir.IRBuilder, value: ir.Constant) -> ir.Value:
    slot = cgutils.alloca_once(builder, value.type)
    builder.store(value, slot)
    return slot


def _spread(builder: ir.IRBuilder, scalar: ir.Value, kind: ir.VectorType) -> ir.Value:
    """A vector with the same value in every lane."""
    lane = builder.insert_element(ir.Constant(kind, ir.Undefined), scalar, ir.Constant(_INT, 0))
    return builder.shuffle_vector(
        lane, ir.Constant(kind, ir.Undefined), ir.Constant(ir.VectorType(_INT, LANES), [0] * LANES)
    )
