# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate wearables`: events on worn skins, and worn skins that nothing touches, without board and wires."""
