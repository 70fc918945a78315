# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Control by touch: a robot balances a ball on a plate, and a hand holds objects.

In come contacts; out come commands to a robot (`ball`, `robots`) or to the motors of a hand (`hand`), within limits.
"""
