# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate outlines`: soft objects that meet the simulated skin, without board and wires."""
