# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures on control by touch: letters that a ball traces, and the reflexes of a hand."""
