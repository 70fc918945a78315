"""The simulated plate with its ball, between the robot's joints and the board's taxels.

In come joint angles; out come the counts of every taxel and the ball's true place. The physics knows no process.
"""
