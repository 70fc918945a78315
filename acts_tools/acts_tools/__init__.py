# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The `acts` command: launch files, bags, training, measurements and demonstrations. See `acts --help`."""

__version__ = "0.1.0"

INTERRUPTED = 130
"""Exit code of the command after Ctrl-C, SIGTERM or SIGHUP."""
