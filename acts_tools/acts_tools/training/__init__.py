# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Parts of `acts train`: sources of frames, and checkpoints."""
