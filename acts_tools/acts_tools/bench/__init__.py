# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts bench`: performance of the sensing. Every measurement is a module, listed in `acts_tools.bench.registry`."""
