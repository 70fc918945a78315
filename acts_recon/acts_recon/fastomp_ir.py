"""Pieces of LLVM code that the vectors of FastOMP are built of (`fastomp_vectors`, `fastomp_choice`)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils

LANES = 16
"""Elements of a vector: one register of AVX-512, two of AVX2, four of SSE and NEON."""

FLOAT = ir.FloatType()
INT = ir.IntType(32)
FLOATS = ir.VectorType(FLOAT, LANES)
INTS = ir.VectorType(INT, LANES)


def is_array(kind: Any, dtype: Any, ndim: int) -> bool:
    """Whether a type of numba is that of a C-contiguous array of this kind."""
    return isinstance(kind, types.Array) and (kind.dtype, kind.ndim, kind.layout) == (dtype, ndim, "C")


def row_of(context: Any, builder: ir.IRBuilder, kind: Any, array: ir.Value, row: ir.Value) -> ir.Value:
    """Where a row of an array begins, as a pointer to vectors; rows of all dimensions but the last are counted on."""
    view = context.make_array(kind)(context, builder, array)
    length = cgutils.unpack_tuple(builder, view.shape)[-1]
    return as_vectors(builder, builder.gep(view.data, [builder.mul(row, length)]))


def as_vectors(builder: ir.IRBuilder, pointer: ir.Value, kind: ir.VectorType = FLOATS) -> ir.Value:
    """A pointer to elements as one to vectors."""
    return builder.bitcast(pointer, kind.as_pointer())


def load(builder: ir.IRBuilder, vectors: ir.Value, place: ir.Value | int = 0) -> ir.Value:
    """The vector at a place; it need not begin where a vector would in memory."""
    if isinstance(place, int):
        place = ir.Constant(INT, place)
    return builder.load(builder.gep(vectors, [place]), align=4)


def spread(builder: ir.IRBuilder, scalar: ir.Value, kind: ir.VectorType = FLOATS) -> ir.Value:
    """A vector with the same value in every lane."""
    nothing = ir.Constant(kind, ir.Undefined)
    lane = builder.insert_element(nothing, scalar, ir.Constant(INT, 0))
    return builder.shuffle_vector(lane, nothing, ir.Constant(ir.VectorType(INT, kind.count), [0] * kind.count))


def part(builder: ir.IRBuilder, vector: ir.Value, first: int, width: int) -> ir.Value:
    """Some neighbouring lanes of a vector."""
    lanes = ir.Constant(ir.VectorType(INT, width), list(range(first, first + width)))
    return builder.shuffle_vector(vector, vector, lanes)


def function(builder: ir.IRBuilder, name: str, arguments: int, kind: ir.VectorType = FLOATS) -> ir.Function:
    """LLVM's own function of this name for vectors of floats."""
    call = ir.FunctionType(kind, [kind] * arguments)
    return builder.module.declare_intrinsic(f"llvm.{name}.v{kind.count}f32", (), call)


def slot(builder: ir.IRBuilder, value: ir.Value) -> ir.Value:
    """A place on the stack with this value, which LLVM turns into a register."""
    place = cgutils.alloca_once(builder, value.type)
    builder.store(value, place)
    return place


@contextmanager
def each(builder: ir.IRBuilder, n: ir.Value) -> Iterator[ir.Value]:
    """A loop from 0 to `n` that LLVM must not unroll: most have few turns, all of them outside of the unrolled part."""
    before = builder.block
    body, after = builder.append_basic_block("each"), builder.append_basic_block("after")
    builder.cbranch(builder.icmp_signed(">", n, ir.Constant(n.type, 0)), body, after)
    builder.position_at_end(body)
    index = builder.phi(n.type)
    index.add_incoming(ir.Constant(n.type, 0), before)
    yield index
    following = builder.add(index, ir.Constant(n.type, 1))
    index.add_incoming(following, builder.block)
    again = builder.cbranch(builder.icmp_signed("<", following, n), body, after)
    # What is said of a loop hangs on a node that names itself first.
    rolled = builder.module.add_metadata([ir.MetaDataString(builder.module, "llvm.loop.unroll.disable")])
    name = ir.values.MDValue(builder.module, [rolled], str(len(builder.module.metadata)))
    name.operands = (name, rolled)
    again.set_metadata("llvm.loop", name)
    builder.position_at_end(after)


@contextmanager
def each_bit(builder: ir.IRBuilder, bits: ir.Value) -> Iterator[ir.Value]:
    """A loop over the numbers of the bits that are set, from the lowest on."""
    zero = ir.Constant(bits.type, 0)
    before = builder.block
    body, after = builder.append_basic_block("each_bit"), builder.append_basic_block("after")
    builder.cbranch(builder.icmp_unsigned("!=", bits, zero), body, after)
    builder.position_at_end(body)
    left = builder.phi(bits.type)
    left.add_incoming(bits, before)
    yield builder.cttz(left, ir.Constant(ir.IntType(1), 1))
    fewer = builder.and_(left, builder.sub(left, ir.Constant(bits.type, 1)))
    left.add_incoming(fewer, builder.block)
    builder.cbranch(builder.icmp_unsigned("!=", fewer, zero), body, after)
    builder.position_at_end(after)
