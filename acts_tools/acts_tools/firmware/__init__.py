# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The firmware's own code in commands: libraries that acts_firmware builds for the host."""
