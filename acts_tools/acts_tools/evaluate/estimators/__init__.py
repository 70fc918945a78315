# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The evaluated methods, with one interface, and their dictionaries."""
