# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The sampling schemes, one a module: a subclass of `SamplingScheme` each, found by being here.

In come settings, the skin's map and a function that measures a taxel; out come the taxels of each frame and their
counts. The registry one folder up names them all; nothing is exported here.
"""
