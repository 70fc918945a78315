# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What all ACTS nodes share: parameters, quality of service, executors, diagnostics, processes."""
