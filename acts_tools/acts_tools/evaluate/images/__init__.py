# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Evaluation of recovery: recordings are sampled like a board, recovered by a method, and scored frame by frame."""
