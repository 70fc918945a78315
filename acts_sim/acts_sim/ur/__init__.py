"""A simulated UR5e as programs meet it: dashboard, RTDE and script, for the unmodified ur_rtde.

In come commands over TCP; out come the robot's state, and its joints in a ring.
"""
