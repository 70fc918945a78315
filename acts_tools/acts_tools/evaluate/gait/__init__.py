# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate gait`: steps on recorded insoles against the force curve's own, and on simulated ones."""
