# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts train`: learn a dictionary. Its sources of frames, its choice of patches, and checkpoints."""
