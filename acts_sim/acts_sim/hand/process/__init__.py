"""The process `hand_world`: the simulated hand in real time, behind a serial port, a ring and a socket."""
