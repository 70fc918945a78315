# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Evaluation of classification: the paper's and ours on the same presses."""
