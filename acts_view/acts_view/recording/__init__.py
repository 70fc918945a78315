# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recording for pages: a bag of bounded size, begun and ended by them, whatever fills it."""
