# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`python3 -m acts_tools` runs the acts command."""

import sys

from acts_tools.cli import main

sys.exit(main())
