# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate impacts`, `ricochet` and `edges`: what strikes the simulated skin, without board and wires."""
