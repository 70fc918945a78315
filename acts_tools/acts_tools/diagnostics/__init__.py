# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts diagnostics`: print the diagnostics of the running nodes."""
