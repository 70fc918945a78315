# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts pub`: publish messages that somebody has typed."""
