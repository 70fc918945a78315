# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A hand that holds by touch: its description, its motors, its reflexes, and the loop that runs them.

Each is a subpackage; its `__init__.py` says what comes in and goes out.
"""
