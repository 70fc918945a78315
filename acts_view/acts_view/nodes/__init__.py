# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `view` and the topics of a skin that it takes."""
