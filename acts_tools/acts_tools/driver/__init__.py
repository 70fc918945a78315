# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts driver`: control a running driver, and read its status."""
