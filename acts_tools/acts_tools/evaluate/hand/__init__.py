# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The reflexes of the simulated hand, scenario by scenario."""
