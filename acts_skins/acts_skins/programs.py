"""The executables of this package, see setup.py. Nothing else is imported here: signals come first."""

from acts_ros.program import Program

tactile = Program("acts_skins.tactile")
