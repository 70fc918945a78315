"""The executables of this package, see setup.py. Nothing else is imported here: signals come first."""

from acts_ros.executables.program import Program

ball_world = Program("acts_sim.ball.ball_world_node")
dynamixel_bus = Program("acts_sim.dynamixel.main")
hand_world = Program("acts_sim.hand.process.main")
ur_controller = Program("acts_sim.ur.main")
