# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The bytes between board and host. `docs/wire_protocol.md` describes them.

In come bytes of a stream, out come frames and messages of the board; commands to the board go the other way. Decoders
accept any bytes: they reject and count what is invalid, and continue.
"""

from acts_core.wire.board_messages import BoardImage, BoardMessage, BoardObject
from acts_core.wire.board_models import BoardModel, object_library, patch_dictionary
from acts_core.wire.board_settings import LEDS, OUTPUTS, BoardSettings
from acts_core.wire.commands import (
    MAP_PIECE_MAX,
    UPLOAD_PIECE_MAX,
    BoardState,
    Reply,
    ReplyStatus,
    UnknownReply,
    encode_configure,
    encode_map_data,
    encode_map_end,
    encode_query,
    encode_upload_begin,
    encode_upload_data,
    encode_upload_end,
)
from acts_core.wire.delimited import DelimitedDecoder
from acts_core.wire.raster_ascii import RasterDecoder
from acts_core.wire.residuals import confidence_of
from acts_core.wire.samples import StreamDecoder, encode_frame

__all__ = [
    "LEDS",
    "MAP_PIECE_MAX",
    "OUTPUTS",
    "UPLOAD_PIECE_MAX",
    "BoardImage",
    "BoardMessage",
    "BoardModel",
    "BoardObject",
    "BoardSettings",
    "BoardState",
    "DelimitedDecoder",
    "RasterDecoder",
    "Reply",
    "ReplyStatus",
    "StreamDecoder",
    "UnknownReply",
    "confidence_of",
    "encode_configure",
    "encode_frame",
    "encode_map_data",
    "encode_map_end",
    "encode_query",
    "encode_upload_begin",
    "encode_upload_data",
    "encode_upload_end",
    "object_library",
    "patch_dictionary",
]
