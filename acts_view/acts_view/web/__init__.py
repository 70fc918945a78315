"""The page and its socket: who may connect, what each client has got, messages and files. Knows no ROS."""
