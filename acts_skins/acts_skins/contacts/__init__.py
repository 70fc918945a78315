# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contacts of all skins in one frame and one message."""
