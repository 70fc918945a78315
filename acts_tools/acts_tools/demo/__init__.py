# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts demo`: demonstrations of the whole chain in simulation, one folder each."""
