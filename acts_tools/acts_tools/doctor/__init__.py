# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts doctor`: check whether this machine is ready for 1 kHz and real time, and print commands that correct it."""
