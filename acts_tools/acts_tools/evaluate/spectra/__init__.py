# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate spectra`: motors that vibrate on the simulated skin, without board and wires."""
