"""The executables of this package, see setup.py. Nothing else is imported here: signals come first."""

from acts_ros.program import Program

skins = Program("acts_skins.skins")
tactile = Program("acts_skins.tactile")
