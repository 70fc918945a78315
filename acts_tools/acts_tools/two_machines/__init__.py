# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Two simulated machines: network namespaces, and a cable between them that can be slow, lossy or cut."""
