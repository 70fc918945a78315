"""Which atom next: the correlation of residuals with a dictionary in explicit vectors, for use in numba functions.

Most of the time of a recovery goes into this. Written as loops, numba's compiler keeps the sums in memory, guards every
loop against overlapping arrays and reduces every block to a scalar, which for the few measured pixels of a patch costs
several times the multiply-adds. Here sums stay in registers, and lane by lane the largest one is kept with the column
it belongs to; only at the end are the lanes compared. LLVM lowers the vectors to what the processor has, from SSE2 to
AVX-512 and NEON. Nothing is checked: problems, pixels and counts must be in range.

`best_columns` computes all correlations. `best_by_bounds` finds the same column, but leaves out groups of columns that
cannot have it, which pays where few pixels were measured.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from acts_recon.fastomp_ir import (
    FLOAT,
    FLOATS,
    INT,
    INTS,
    LANES,
    as_vectors,
    each,
    each_bit,
    function,
    is_array,
    load,
    part,
    slot,
    spread,
)

VECTORS = 5
"""Vectors of a block, as many sums as are in flight at once; with AVX2 they take 10 of 16 registers."""

BLOCK = LANES * VECTORS
"""Columns whose correlations are computed together: their 64 pixels fill two thirds of a usual first cache."""

GROUPS = 64
"""Groups of `LANES` columns whose bounds are compared together: the bits of a register."""

_NONE = 2**31 - 1
_SLACK = 1e-4
"""Far more than what rounding does to a bound and to a correlation, relative to the bound."""


@intrinsic  # type: ignore[untyped-decorator]
def best_columns(
    typing_context: Any,
    blocks: Any,
    pixels: Any,
    residuals: Any,
    counts: Any,
    problems: Any,
    n: Any,
    lanes: Any,
    best: Any,
) -> Any:
    """For each of several problems the column whose correlation with the residual is largest in magnitude.

    A block of the dictionary is used for all problems before the next: it comes from the second cache once.

    Parameters
    ----------
    blocks : np.ndarray [shape=(n_blocks, n_pixels, BLOCK), dtype=float32]
        See `acts_recon.fastomp_model.in_blocks`.
    pixels : np.ndarray [shape=(n_problems, width), dtype=uint32]
        Rows that were measured.
    residuals : np.ndarray [shape=(n_problems, width), dtype=float32]
        What is left to explain there.
    counts : np.ndarray [shape=(n_problems,), dtype=int32]
        How many there are.
    problems : np.ndarray [shape=(at least n,), dtype=int32]
        Which problems to look at: rows of the other arrays.
    n : int
    lanes : np.ndarray [shape=(n_problems, 3, LANES), dtype=float32]
        Overwritten: the best of every lane, its magnitude and (as an int32) its column.
    best : np.ndarray [shape=(n_problems,), dtype=int32]
        Set to the column, the first of equally good ones; to -1 when all correlations are 0 (or none is a number).
    """
    if not (is_array(blocks, types.float32, 3) and is_array(lanes, types.float32, 3)):
        return None
    if not _are_problems(pixels, residuals, counts, problems, best):
        return None
    return types.void(blocks, pixels, residuals, counts, problems, types.int64, lanes, best), _best_columns


@intrinsic  # type: ignore[untyped-decorator]
def best_by_bounds(
    typing_context: Any,
    groups: Any,
    numbers: Any,
    bounds: Any,
    pixels: Any,
    residuals: Any,
    counts: Any,
    problems: Any,
    n: Any,
    lanes: Any,
    best: Any,
) -> Any:
    """What `best_columns` finds, with fewer correlations.

    No correlation of a group of similar columns is larger than the sum of its residuals' magnitudes, each times the
    largest magnitude that any column of the group has at this pixel. The group with the largest such bound is computed
    first; of the others, those whose bound is not below its best correlation.

    Parameters
    ----------
    groups : np.ndarray [shape=(n_groups, n_pixels, LANES), dtype=float32]
        A multiple of `GROUPS` of them; see `acts_recon.fastomp_model.Grouped`.
    numbers : np.ndarray [shape=(n_groups, LANES), dtype=int32]
        Which column of the dictionary each of a group is.
    bounds : np.ndarray [shape=(n_groups / GROUPS, n_pixels, GROUPS), dtype=float32]
        The largest magnitude in a group.
    pixels, residuals, counts, problems, n, best
        As of `best_columns`.
    """
    if not (
        is_array(groups, types.float32, 3) and is_array(numbers, types.int32, 2) and is_array(bounds, types.float32, 3)
    ):
        return None
    if not _are_problems(pixels, residuals, counts, problems, best):
        return None
    kinds = (groups, numbers, bounds, pixels, residuals, counts, problems, types.int64, lanes, best)
    return types.void(*kinds), _best_by_bounds


def _are_problems(pixels: Any, residuals: Any, counts: Any, problems: Any, best: Any) -> bool:
    return (
        is_array(pixels, types.uint32, 2)
        and is_array(residuals, types.float32, 2)
        and all(is_array(array, types.int32, 1) for array in (counts, problems, best))
    )


def _arrays(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> list[Any]:
    return [
        context.make_array(kind)(context, builder, value)
        for kind, value in zip(signature.args, arguments, strict=True)
        if isinstance(kind, types.Array)
    ]


class _Problem:
    """A problem of those that are to be looked at, and a walk over its pixels."""

    def __init__(
        self, builder: ir.IRBuilder, pixels: Any, residuals: Any, counts: Any, problems: Any, k: ir.Value
    ) -> None:
        self.builder = builder
        self.size = k.type
        self.number = builder.sext(builder.load(builder.gep(problems.data, [k])), self.size)
        row = builder.mul(self.number, cgutils.unpack_tuple(builder, pixels.shape)[1])
        self.pixels, self.residual = (builder.gep(array.data, [row]) for array in (pixels, residuals))
        self.count = builder.sext(builder.load(builder.gep(counts.data, [self.number])), self.size)

    def correlate(
        self, block: ir.Value, vectors: int, weigh: Callable[[ir.Value], ir.Value] = lambda residual: residual
    ) -> list[ir.Value]:
        """Correlations with a block of columns that has so many vectors for every pixel."""
        builder, size = self.builder, self.size
        fused = function(builder, "fmuladd", 3)
        sums = [slot(builder, ir.Constant(FLOATS, [0.0] * LANES)) for _ in range(vectors)]
        with each(builder, self.count) as place:
            pixel = builder.zext(builder.load(builder.gep(self.pixels, [place])), size)
            weight = spread(builder, weigh(builder.load(builder.gep(self.residual, [place]))))
            row = as_vectors(builder, builder.gep(block, [builder.mul(pixel, ir.Constant(size, vectors * LANES))]))
            for vector, total in enumerate(sums):
                builder.store(builder.call(fused, [weight, load(builder, row, vector), builder.load(total)]), total)
        return [builder.load(total) for total in sums]


def _best_columns(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
    blocks, pixels, residuals, counts, problems, lanes, best = _arrays(context, builder, signature, arguments)
    n = arguments[5]
    n_blocks, n_pixels, _ = cgutils.unpack_tuple(builder, blocks.shape)
    size = n.type

    def problem_of(k: ir.Value) -> _Problem:
        return _Problem(builder, pixels, residuals, counts, problems, k)

    _forget(builder, n, problem_of, lanes)
    with each(builder, n_blocks) as number:
        block = builder.gep(blocks.data, [builder.mul(number, builder.mul(n_pixels, ir.Constant(size, BLOCK)))])
        first = spread(builder, builder.trunc(builder.mul(number, ir.Constant(size, BLOCK)), INT), INTS)
        with each(builder, n) as k:
            problem = problem_of(k)
            sums = problem.correlate(block, VECTORS)
            top, column = _lanes_of(builder, lanes, problem)
            highest, where = load(builder, top), load(builder, column)
            for vector, total in enumerate(sums):
                magnitude = builder.call(function(builder, "fabs", 1), [total])
                places = ir.Constant(INTS, [vector * LANES + lane for lane in range(LANES)])
                higher = builder.fcmp_ordered(">", magnitude, highest)
                highest = builder.select(higher, magnitude, highest)
                where = builder.select(higher, builder.add(first, places), where)
            builder.store(highest, top, align=4)
            builder.store(where, column, align=4)
    _decide(builder, n, problem_of, lanes, best)
    return context.get_dummy_value()


def _best_by_bounds(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
    groups, numbers, bounds, pixels, residuals, counts, problems, lanes, best = _arrays(
        context, builder, signature, arguments
    )
    n = arguments[7]
    size = n.type
    n_chunks, n_pixels, _ = cgutils.unpack_tuple(builder, bounds.shape)
    vectors = GROUPS // LANES
    absolute = builder.module.declare_intrinsic("llvm.fabs", [FLOAT])

    bits = ir.IntType(GROUPS)

    def problem_of(k: ir.Value) -> _Problem:
        return _Problem(builder, pixels, residuals, counts, problems, k)

    def look_at(problem: _Problem, group: ir.Value, value: ir.Value, column: ir.Value) -> tuple[ir.Value, ir.Value]:
        """The better of a group's correlations and of what was found so far, lane by lane."""
        start = builder.gep(groups.data, [builder.mul(group, builder.mul(n_pixels, ir.Constant(size, LANES)))])
        (total,) = problem.correlate(start, 1)
        magnitude = builder.call(function(builder, "fabs", 1), [total])
        number = load(builder, as_vectors(builder, numbers.data, INTS), group)
        return _better(builder, value, column, magnitude, number)

    def bits_of(problem: _Problem) -> ir.Value:
        row = builder.gep(_lanes_of(builder, lanes, problem)[0], [ir.Constant(size, 2)])
        return builder.bitcast(row, bits.as_pointer())

    _forget(builder, n, problem_of, lanes)
    with each(builder, n_chunks) as chunk:
        first_group = builder.mul(chunk, ir.Constant(size, GROUPS))
        bound = builder.gep(bounds.data, [builder.mul(first_group, n_pixels)])
        # First find out for all problems which groups to look at, then look: while the processor waits for the one
        # number that decides, it goes on with the next problems, and it need not guess how many groups there are.
        with each(builder, n) as k:
            problem = problem_of(k)
            limits = problem.correlate(bound, vectors, lambda residual: builder.call(absolute, [residual]))
            value, place = limits[0], ir.Constant(INTS, list(range(LANES)))
            for vector in range(1, vectors):
                places = ir.Constant(INTS, [vector * LANES + lane for lane in range(LANES)])
                value, place = _better(builder, value, place, limits[vector], places)
            promising = builder.zext(_best_lane(builder, value, place, none=0)[1], size)
            places = _lanes_of(builder, lanes, problem)
            known = [load(builder, place) for place in places]
            better = look_at(problem, builder.add(first_group, promising), *known)
            for value, place in zip(better, places, strict=True):
                builder.store(value, place, align=4)
            found = _best_lane(builder, *better)[0]
            needed = spread(builder, builder.fmul(found, ir.Constant(FLOAT, 1 - _SLACK)))
            possible = [builder.fcmp_unordered(">=", limit, needed) for limit in limits]
            while len(possible) > 1:
                possible = [_joined(builder, *pair) for pair in zip(possible[::2], possible[1::2], strict=True)]
            others = builder.not_(builder.shl(ir.Constant(bits, 1), promising))
            builder.store(builder.and_(builder.bitcast(possible[0], bits), others), bits_of(problem), align=4)
        with each(builder, n) as k:
            problem = problem_of(k)
            places = _lanes_of(builder, lanes, problem)
            so_far = [slot(builder, load(builder, place)) for place in places]
            with each_bit(builder, builder.load(bits_of(problem), align=4)) as group:
                better = look_at(problem, builder.add(first_group, group), *(builder.load(some) for some in so_far))
                for value, some in zip(better, so_far, strict=True):
                    builder.store(value, some)
            for some, place in zip(so_far, places, strict=True):
                builder.store(builder.load(some), place, align=4)
    _decide(builder, n, problem_of, lanes, best)
    return context.get_dummy_value()


def _lanes_of(builder: ir.IRBuilder, lanes: Any, problem: _Problem) -> tuple[ir.Value, ir.Value]:
    """Where the best magnitudes of a problem's lanes are kept, and their columns."""
    rows, width = cgutils.unpack_tuple(builder, lanes.shape)[1:]
    start = builder.gep(lanes.data, [builder.mul(problem.number, builder.mul(rows, width))])
    return as_vectors(builder, start), as_vectors(builder, builder.gep(start, [width]), INTS)


def _forget(builder: ir.IRBuilder, n: ir.Value, problem_of: Callable[[ir.Value], _Problem], lanes: Any) -> None:
    """Nothing has been found yet."""
    with each(builder, n) as k:
        top, column = _lanes_of(builder, lanes, problem_of(k))
        builder.store(ir.Constant(FLOATS, [0.0] * LANES), top, align=4)
        builder.store(ir.Constant(INTS, [_NONE] * LANES), column, align=4)


def _decide(
    builder: ir.IRBuilder, n: ir.Value, problem_of: Callable[[ir.Value], _Problem], lanes: Any, best: Any
) -> None:
    """Compare the lanes of every problem."""
    with each(builder, n) as k:
        problem = problem_of(k)
        top, column = _lanes_of(builder, lanes, problem)
        found = _best_lane(builder, load(builder, top), load(builder, column))[1]
        builder.store(found, builder.gep(best.data, [problem.number]))


def _best_lane(builder: ir.IRBuilder, value: ir.Value, column: ir.Value, none: int = -1) -> tuple[ir.Value, ir.Value]:
    """The best value of all lanes and its column (`none` if it is 0): vectors are halved until one element is left."""
    width = LANES
    while width > 1:
        width //= 2
        value, column = _better(
            builder,
            *(part(builder, some, 0, width) for some in (value, column)),
            *(part(builder, some, width, width) for some in (value, column)),
        )
    value, column = (builder.extract_element(some, ir.Constant(INT, 0)) for some in (value, column))
    some = builder.fcmp_ordered(">", value, ir.Constant(value.type, 0.0))
    return value, builder.select(some, column, ir.Constant(INT, none))


def _better(
    builder: ir.IRBuilder, value: ir.Value, column: ir.Value, other_value: ir.Value, other_column: ir.Value
) -> tuple[ir.Value, ir.Value]:
    """Lane by lane the larger value with its column; of equal ones the smaller column."""
    larger = builder.fcmp_ordered(">", other_value, value)
    equal = builder.fcmp_ordered("==", other_value, value)
    # Whatever the next comparison waits for depends on values alone.
    earlier = builder.select(builder.icmp_signed("<", other_column, column), other_column, column)
    column = builder.select(larger, other_column, builder.select(equal, earlier, column))
    return builder.select(larger, other_value, value), column


def _joined(builder: ir.IRBuilder, first: ir.Value, second: ir.Value) -> ir.Value:
    """The lanes of two vectors one after the other."""
    count = 2 * first.type.count
    return builder.shuffle_vector(first, second, ir.Constant(ir.VectorType(INT, count), list(range(count))))
