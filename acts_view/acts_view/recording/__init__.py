# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recording for pages: a bag of bounded size that pages begin and end, filled from topics or from a board."""
