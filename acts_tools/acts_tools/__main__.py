"""`python3 -m acts_tools` runs the acts command."""

import sys

from acts_tools.cli import main

sys.exit(main())
