# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Evaluation of slip detection, on recordings of full frames and on sampled frames."""
