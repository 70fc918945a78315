"""A simulated LEAP hand: joints in MuJoCo, a skin of 1024 taxels, an object in its grasp, motors on a bus."""
