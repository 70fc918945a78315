# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What commands that run until something ends them share: signals as a flag, a node or a launch for a block, a
status line."""
