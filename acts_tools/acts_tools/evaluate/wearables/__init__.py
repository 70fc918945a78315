# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate wearables`: what happens to worn skins, and skins to which nothing does, without board and wires."""
