# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts bench skins`: several skins on one machine, from their boards to a subscriber of their contacts."""
