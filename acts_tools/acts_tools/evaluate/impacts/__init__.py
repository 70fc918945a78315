# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate impacts` and `acts evaluate ricochet`: balls on the simulated skin, without board and wires."""
