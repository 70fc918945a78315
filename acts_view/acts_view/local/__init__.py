# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A board or a recording shown without a graph: driver's reader, reconstruction and page in one process."""
