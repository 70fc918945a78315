# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts call`: services of running nodes."""
