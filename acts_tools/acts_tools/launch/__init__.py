"""A small interpreter of the XML launch subset that ROS 2 packages use, for machines without `ros2 launch`.

`parser` turns a file into the actions of `model`, `evaluate` turns those and the arguments into processes to start,
`processes` runs them, and `command` is what `acts launch` calls. The subset is described in docs/launch.md.
"""
