# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures on images and objects: recovery over the taxels measured, dictionaries, and classification."""
