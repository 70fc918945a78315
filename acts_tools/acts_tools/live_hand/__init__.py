"""A simulated hand that runs as its launch file starts it: told what to do, watched, recorded."""
