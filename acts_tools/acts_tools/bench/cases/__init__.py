# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The measurements of `acts bench`, one module each, listed in `acts_tools.bench.registry`."""
