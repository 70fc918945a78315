# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The executables of this package, see setup.py. Imports nothing else, so that signal handlers come first."""

from acts_ros.executables.program import Program

skin_contacts = Program("acts_skins.contacts.main")
skin_overview = Program("acts_skins.overview.main")
skins = Program("acts_skins.skins")
tactile = Program("acts_skins.tactile")
