# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Readers of public recordings in their original formats."""
