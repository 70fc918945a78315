# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate gait`: steps on recorded insoles, against a count in the force curve, and on simulated ones."""
