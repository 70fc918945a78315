# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Export a bag as tables of frames, contacts and joints at common times, in formats for machine learning."""
