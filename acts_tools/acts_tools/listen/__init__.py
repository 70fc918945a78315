# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts listen`: measure loss and delay of topics on this machine."""
