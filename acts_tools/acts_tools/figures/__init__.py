# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts figures`: every figure of the paper, with its published curves, its method here, and ours.

A figure is a `Figure`: a function that measures, and one that picks the published curves to draw beside. It stands in
a module with others of its subject, and `registry` names it.
"""
