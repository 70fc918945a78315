"""A simulated UR5e controller: a process of its own that the unmodified ``ur_rtde`` client connects to.

`rtde` and `variables` hold the packets, `session` what one client of the RTDE port asks for, `script` and `dashboard`
the two text ports, `joints` how the arm moves, `program` and `commands` the control script the client uploads,
`controller` the robot's state, `server` the sockets, `main` the command line. Only `server` and `main` know the clock.
"""
